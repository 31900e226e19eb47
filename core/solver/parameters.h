// What the solver can be told, with units, ranges and defaults.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/gamma/gamma_method.h"
#include "core/sph/kernels.h"

namespace migiwa {

/// How the fluid is kept from being compressed; core/solver/solvers.h has what does it.
enum class SolverMethod { pbf, wcsph, pcisph, dfsph };
inline constexpr std::array<std::string_view, 4> kSolverMethodNames{"pbf", "wcsph", "pcisph", "dfsph"};

/// Of weakly compressible SPH.
struct WcsphParameters {
  double compression = 0.01;  ///< that the speed of sound is chosen for (unit: 1, range: [0.0001, 0.1])
  double soundSpeed = 0;      ///< 0: by the compression and the speeds of the scene (unit: m/s)
  double viscosity = 0.08;    ///< artificial, alpha (unit: 1, range: [0, 1])
};

/// How lambda becomes a displacement. METHOD: [FM] Eq. 10 is the short form of the constraint's gradient
/// step.
enum class PositionStep {
  gradient,      ///< the true gradient of the corrected constraint: lambda/gamma pairs and the wall's push
  pairsAndWall,  ///< Eq. 10's (lambda_i + lambda_j) pairs and the wall's push
  paper,         ///< Eq. 10 as printed: pairs only
};
inline constexpr std::array<std::string_view, 3> kPositionStepNames{"gradient", "pairs_and_wall", "paper"};

/// Where velocities come from.
enum class VelocityStep {
  positions,   ///< how far the constraint has moved particles, over the time step: PBF
  projection,  ///< a pressure that makes them free of divergence; the constraint corrects positions alone
};
inline constexpr std::array<std::string_view, 2> kVelocityStepNames{"positions", "projection"};

/// Whether a pressure can take the kernel: one that serves density and forces alike.
inline bool servesPressure(KernelType kernel) {
  return kernel == KernelType::cubicSpline || kernel == KernelType::wendlandC2;
}

/// How the iterations are made to converge in fewer.
enum class Acceleration { chebyshev, none };
inline constexpr std::array<std::string_view, 2> kAccelerationNames{"chebyshev", "none"};

struct SolverParameters {
  SolverMethod method = SolverMethod::pbf;
  WcsphParameters wcsph;
  double timeStep = 0.005;  ///< a frame's step (unit: s, range: (0, 1])
  int substeps = 1;         ///< parts that a frame has at least (range: [1, 1000])
  double cfl = 0.4;  ///< support radii that the fastest particle may move in a substep; 0: no limit (unit: 1)
  int minIterations = 1;     ///< (range: [1, 1000])
  int maxIterations = 20;    ///< (range: [1, 1000], at least minIterations)
  double tolerance = 0.003;  ///< largest mean density error that ends the iterations (unit: 1, range: [0, 1))
  double cfmEpsilon = 1;  ///< Eq. 11's epsilon over the resting lattice's sum of squared gradients (unit: 1)
  double supportRatio = 2.25;  ///< support radius over particle spacing (unit: 1, range: [1.2, 4])
  double restDensity = 1000;   ///< (unit: kg/m^3)
  KernelType kernel = KernelType::wendlandC2;
  PositionStep positionStep = PositionStep::gradient;
  Acceleration acceleration = Acceleration::chebyshev;
  VelocityStep velocityStep = VelocityStep::projection;
  /// Mean divergence, times the time step, that ends a projection (unit: 1, range: [0, 1))
  double divergenceTolerance = 2e-5;
  int maxPressureIterations = 50;  ///< of a projection (range: [1, 1000])

  /// Whether velocities come from a pressure at the places where a step begins: always but in PBF from
  /// positions.
  bool takesPressure() const {
    return method != SolverMethod::pbf || velocityStep == VelocityStep::projection;
  }
  /// Whether a step has iterations that take divergence out.
  bool solvesDivergence() const {
    return method == SolverMethod::dfsph || (method == SolverMethod::pbf && takesPressure());
  }

  /// Takes a method, and what goes with it: a kernel that serves density and forces alike, and the least
  /// iterations and the errors that the publications ask for.
  void takeMethod(SolverMethod with) {
    takeVelocities(VelocityStep::projection);
    method = with;
    const SolverParameters usual;
    maxIterations = usual.maxIterations, divergenceTolerance = usual.divergenceTolerance;
    if (with == SolverMethod::pbf) return;
    minIterations = 2, tolerance = 0.01;
    if (with == SolverMethod::pcisph) minIterations = 3, maxIterations = 50;
    if (with == SolverMethod::dfsph) maxIterations = 50, tolerance = 0.001, divergenceTolerance = 0.001;
  }

  /// Takes velocities from there, and what goes with them. For a projection: a kernel that serves density and
  /// forces alike, and a tolerance that one or two iterations a step keep. From positions: PBF's own kernel,
  /// and a tolerance that leaves noise, for all that the constraint corrects becomes velocity.
  void takeVelocities(VelocityStep from) {
    const SolverParameters usual;
    const bool projects = from == VelocityStep::projection;
    velocityStep = from;
    kernel = projects ? usual.kernel : KernelType::poly6;
    supportRatio = projects ? usual.supportRatio : 2;
    tolerance = projects ? usual.tolerance : 0.01;
    minIterations = projects ? usual.minIterations : 2;
  }
};

struct BoundaryParameters {
  BoundaryHandling handling = BoundaryHandling::gamma;
  int gammaMethod = 0;   ///< index into gammaMethodNames(); 0 is "auto"
  int directions = 256;  ///< of the method "directions" (range: [8, 65536])
  int samples = 100000;  ///< of the method "monte_carlo" (range: [100, 100000000])
};

/// The mechanisms that keep hard cases stable. They act in those alone, and leave every other run as it is to
/// the last bit; tests/hard_cases compares with runs without them. Where fluid starts in walls or on top of
/// fluid, and where a step leaves it so, it is moved apart without gaining speed
/// (core/simulation/simulation.cpp); continuous collision lets no move pass through thin or moving walls
/// (core/solver/collision.cpp); overfull cells are spread before their pairs are listed
/// (core/solver/guards.cpp); a wall that stands still gives no speed (core/solver/collision.cpp); energy that
/// a step adds from nothing is taken back (core/solver/guards.cpp); a step that ends with a value that is not
/// finite, or that walls leave no solution, is refused (core/solver/step.cpp); gamma has a floor
/// (core/solver/wall_gamma.cpp); pairs on one point get a direction (core/solver/pairs_simd-inl.h).
/// Projection onto the fluid side of walls, the clamp of the density constraint and the CFL rule are none of
/// them: they belong to the method.
enum class Guards { on, off };

}  // namespace migiwa
