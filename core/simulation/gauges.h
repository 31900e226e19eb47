// What the gauges of a scene show at one moment, and what its walls are at any points.
#pragma once

#include <optional>
#include <span>

#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/gauge.h"
#include "core/scene/scene.h"
#include "core/walls/boundary.h"

namespace migiwa {

/// The fluid that gauges look at. `pressures` (Pa) may be empty: then there are none to measure.
struct GaugedFluid {
  std::span<const Float4> positions, velocities;  ///< (m, m/s)
  std::span<const float> pressures;
};

/// Gauges of a scene. Definitions, for support radius h, kernel W and spacing a:
///   filled part  a^3 sum_j W(x - x_j) at x, over the gamma of walls in reach where the scene divides by one;
///                at a level surface it is 1/2
///   height       length of the line from `at` on along which the filled part is 1/2 or more: what a wire
///                gauge measures. Without overhang and spray, the height of the surface over `at`
///   pressure     sum_j p_j W / sum_j W + rho0 g.(x - sum_j x_j W / sum_j W), over the particles within the
///                radius of x; the second term is 0 but near walls, where the particles lie on one side. 0
///                where it is negative and where there is no particle
///   centre       d.(c - at), c the centre of mass, d the unit direction
///   front        largest d.(x_j - at) + a/2
///   speed        root mean square over the particles
class GaugeReader {
 public:
  /// Keeps references to the walls; keeps none to the scene.
  GaugeReader(const Scene& scene, const Boundary& boundary);

  bool readsPressure() const;
  bool isPressure(std::size_t k) const { return gauges_[k].kind == GaugeKind::pressure; }
  std::size_t size() const { return gauges_.size(); }
  /// What gauge k shows; null where there is nothing to measure. `gamma` is that of the run; null: none.
  std::optional<double> read(std::size_t k, const GaugedFluid& fluid, const GammaMethod* gamma,
                             KernelType kernel, double supportRadius) const;

 private:
  struct Probe {
    Vec3d at, up;
  };
  Probe probeOf(const Gauge& gauge) const;
  double wetLength(const Probe& line, const GaugedFluid& fluid, const GammaMethod* gamma, KernelType kernel,
                   double support) const;
  std::optional<double> pressureAt(const Vec3d& at, double radius, const GaugedFluid& fluid,
                                   KernelType kernel) const;

  std::vector<Gauge> gauges_;
  const Boundary& boundary_;
  Vec3d gravity_;                 ///< (m/s^2)
  double spacing_, restDensity_;  ///< (m, kg/m^3)
};

// The walls of a scene asked at any points, without a simulation: gamma, its gradient, distances and normals.

/// What a wall is at a point of the scene's file.
struct WallAnswer {
  double gamma = 1;                ///< the part of the kernel's support that the solid does not cover
  Vec3d gradient = Vec3d::Zero();  ///< grad gamma (1/m)
  double distance = 0;             ///< to the nearest wall (m), positive in the fluid; infinite without walls
};

/// The walls of a scene, where they are at time 0, with the scene's gamma method or another one.
class WallQuery {
 public:
  /// `threads` 0 takes what the machine has. Throws InputError where the method does not allow the walls.
  explicit WallQuery(const Scene& scene, int threads = 0);
  WallQuery(const WallQuery&) = delete;
  WallQuery& operator=(const WallQuery&) = delete;

  /// Of each point (m, in the coordinates of the scene's file).
  std::vector<WallAnswer> answers(std::span<const Vec3d> points);
  /// The unit normals, into the fluid, at the walls' nearest points; zero without walls.
  std::vector<Vec3d> normals(std::span<const Vec3d> points);
  /// Of the method that is asked: "auto" says what it has picked.
  const std::string& method() const { return picked_.name; }

 private:
  Vec3d origin_;
  float supportRadius_;
  ThreadPool pool_;
  Boundary boundary_;
  PickedGamma picked_;
};

/// What a gamma method of the scene's walls is made of. `boundary` and `pool` stay with the caller.
GammaContext gammaContextOf(const Scene& scene, const Boundary& boundary, ThreadPool& pool);
/// What corrects the density at the scene's walls; without any correction, the gamma that it leaves out.
PickedGamma gammaMethodOf(const Scene& scene, const GammaContext& context);

}  // namespace migiwa
