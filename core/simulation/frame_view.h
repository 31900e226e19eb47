// What a picture, an export or a panel may see of a simulation: spans over its state at the end of a step,
// and a copy of the same for another thread. All per-particle spans have the same length and order.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/scene/scene.h"
#include "core/simulation/statistics.h"
#include "core/solver/state.h"
#include "core/surface/mesh.h"
#include "core/walls/surface.h"

namespace migiwa {

/// What a gauge has shown so far, thinned for a picture.
struct GaugeTrace {
  std::string name, unit;
  std::vector<GaugeSample> samples;
};

struct FrameInfo {
  double time = 0;          ///< simulated (s)
  long steps = 0;           ///< substeps so far
  float spacing = 0;        ///< particle spacing (m)
  float supportRadius = 0;  ///< (m)
  std::string handling;  ///< how walls are handled, such as "gamma: product", "particles" or "no correction"
  int iterations = 0;    ///< of the last step
  std::vector<IterationError> errors;  ///< of the last step: before the first iteration, then after each
  StageTimes stages;                   ///< of the last frame (s)
  double stepSeconds = 0;              ///< wall time of the last frame's mean substep
  std::uint64_t stateHash = 0;
  std::vector<EnergySample> energy;  ///< over the run so far
  std::vector<GaugeTrace> gauges;    ///< in the order of the scene
};

struct FrameView {
  const FrameInfo& info;
  std::span<const Float4> positions;   ///< (m)
  std::span<const Float4> velocities;  ///< (m/s)
  std::span<const float> density;      ///< rho/rho0 after the last iteration
  std::span<const float> gamma;
  std::span<const float> lambda;  ///< of the last iteration, times the squared support radius (1)
  std::span<const std::uint32_t> neighbours;
  std::span<const float> pressure{};     ///< of the last step (Pa); empty unless Simulation::watchPressure()
  std::span<const std::uint32_t> ids{};  ///< tell particles apart from frame to frame
  /// For pictures of walls that move: all walls as they are now. Null where all stand still, and
  /// where no picture is asked for.
  std::shared_ptr<const WallDrawing> walls{};
  /// The water's surface, for pictures that show it; null: they show particles.
  std::shared_ptr<const SurfaceMesh> water{};
};

/// A copy of a frame view that owns its data.
struct FrameSnapshot {
  FrameInfo info;
  std::vector<Float4> positions, velocities;
  std::vector<float> density, gamma, lambda, pressure;
  std::vector<std::uint32_t> neighbours, ids;
  std::shared_ptr<const WallDrawing> walls;
  std::shared_ptr<const SurfaceMesh> water;

  void assign(const FrameView& view);
  FrameView view() const {
    return {info, positions, velocities, density, gamma, lambda, neighbours, pressure, ids, walls, water};
  }
};

/// Name, unit and fixed range of a colour field, so that colours mean the same in every picture of a scene.
struct ColorFieldInfo {
  std::string label;  ///< with symbol, such as "density ρ/ρ₀"
  std::string unit;   ///< empty for ratios and counts
  double low = 0, high = 1;
};
/// Pressures reach to that of water of `restDensity` (kg/m^3) that stops a jet of the reference speed (m/s).
ColorFieldInfo colorFieldInfo(ColorField field, double referenceSpeed, double restDensity);

/// The field's value for each particle; 0 for pressures that were not watched.
void colorFieldValues(const FrameView& view, ColorField field, std::vector<float>& out);

}  // namespace migiwa
