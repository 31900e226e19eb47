// A field of a scene's liquid on a plane: its walls and gamma, kept from frame to frame.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"
#include "core/surface/section.h"
#include "core/walls/boundary.h"

namespace migiwa {

enum class SectionField { density, pressure, speed, gamma, gammaError };
inline constexpr std::array<std::string_view, 5> kSectionFieldNames{"density", "pressure", "speed", "gamma",
                                                                    "gamma_error"};

/// Whether the field is summed up over particles. The others are gamma's own, at the place itself.
constexpr bool isInterpolated(SectionField field) {
  return field != SectionField::gamma && field != SectionField::gammaError;
}
/// The field's value for each particle, as in colorFieldValues(); of gamma and its error density stands for
/// it.
std::vector<float> sectionValues(const FrameView& view, SectionField field);
/// Name, unit and the range of its colours.
ColorFieldInfo sectionFieldInfo(SectionField field, double referenceSpeed, double restDensity);

class SceneSection {
 public:
  /// Prepares the walls. Keeps a reference to the pool. Whatever the scene's handling of walls, gamma is that
  /// of the scene's method. Throws InputError where it does not allow the walls.
  SceneSection(const Scene& scene, ThreadPool& pool);

  /// All of the settings that it depends on.
  struct Method {
    int index, directions, samples;
    KernelType kernel;
    float support;
    bool operator==(const Method&) const = default;
  };
  /// `spacing` of particles (m).
  static Method methodOf(double spacing, const SolverParameters& solver, const BoundaryParameters& boundary);
  const Method& method() const { return method_; }

  /// A field on a plane at `time` (s); positions (m) are relative to Scene::origin, `values` those of
  /// sectionValues(). The error of gamma is that against 16,384 directions, some 50 microseconds a cell near
  /// walls.
  SectionRaster of(const SectionPlane& plane, SectionField field, SectionDivisor divisor,
                   std::span<const Float4> positions, std::span<const float> values, double time);

 private:
  ThreadPool& pool_;
  Method method_;
  float weight_;
  Boundary boundary_;
  PickedGamma gamma_, reference_;
};

}  // namespace migiwa
