// Methods of gamma, and the wall models that they are compared with.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/sph/kernels.h"
#include "core/sph/neighbours.h"
#include "core/walls/boundary.h"

namespace migiwa {

// gamma_i of [FM] Eq. 6: the part of the kernel's support that the solid does not cover, with its gradient,
// for a batch of points. A method is one file that implements this interface and one line in
// gamma_method.cpp.

/// gamma at one point. Gradients are those of gamma with respect to the point over the support radius, so
/// without a unit: multiply by 1/h for 1/m.
struct GammaSample {
  float gamma = 1;
  float distance = 0;                  ///< to the nearest wall (m), positive in the fluid
  Vec3f gradient = Vec3f::Zero();      ///< h grad gamma for the density kernel
  Vec3f pairGradient = Vec3f::Zero();  ///< the same for the kernel of the pair gradients: the wall's push
};

/// Keeps shares of a kernel in [0, 1], and counts those that were farther out of it than a method errs: where
/// walls overlap, what is in both is taken twice.
class ShareRange {
 public:
  static constexpr float kTolerance = 0.02F;

  void set(GammaSample& sample, float share) const {
    sample.gamma = std::clamp(share, 0.0F, 1.0F);
    if (std::abs(share - sample.gamma) > kTolerance) out_.fetch_add(1, std::memory_order_relaxed);
  }
  /// How many were, since the last call.
  long take() const { return out_.exchange(0, std::memory_order_relaxed); }

 private:
  mutable std::atomic<long> out_ = 0;
};

/// What a method that chooses among others uses for its walls, and why. Empty for one that does not
/// choose.
struct GammaChoice {
  std::string name, reason;
};

/// How a method's sample enters the density: S is what the fluid particles sum to, over rho0.
enum class WallDensity {
  divided,  ///< rho = S / gamma, [FM] Eq. 5
  added,    ///< rho = S + (1 - gamma): the walls' own density is 1 - gamma, and may exceed 1
  absent,   ///< rho = S, and walls are soft: they push by depth, see core/solver/penalty.cpp
};

class GammaMethod {
 public:
  explicit GammaMethod(WallDensity form = WallDensity::divided) : form_(form) {}
  virtual ~GammaMethod() = default;
  GammaMethod(const GammaMethod&) = delete;
  GammaMethod& operator=(const GammaMethod&) = delete;

  WallDensity form() const { return form_; }
  virtual GammaChoice choice() const { return {}; }
  /// Takes in that walls of the boundary have moved. Not while evaluate() runs.
  virtual void wallsMoved() {}
  /// Fills out[i] for points[i] (xyz in m). Thread-safe.
  virtual void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const = 0;
  /// evaluate() for samples that hold their distances already, and otherwise nothing.
  virtual void evaluateMeasured(std::span<const Float4> points, std::span<GammaSample> out) const {
    evaluate(points, out);
  }
  /// How many samples ShareRange has counted since the last call.
  virtual long takeOutOfRange() const { return range_.take(); }

 protected:
  const ShareRange range_;

 private:
  WallDensity form_;
};

struct GammaContext {
  const Boundary& boundary;
  KernelType kernel;
  float supportRadius;         ///< (m)
  int directions = 256;        ///< of the method "directions"
  int samples = 100000;        ///< of the method "monte_carlo"
  Bounds region{};             ///< where the method "baked" has a grid (m); empty: about the finite walls
  ThreadPool* pool = nullptr;  ///< for what takes long; null: the calling thread alone
  std::string place{};         ///< of the method in the scene file, for errors
  float spacing = 0;           ///< of fluid particles at rest (m): what baselines put into walls
};

/// Names for the scene's gamma method, "auto" first.
std::span<const std::string_view> gammaMethodNames();
/// The first of them, which a simulation can use in every step. The others are references to compare with.
std::span<const std::string_view> steppedGammaMethodNames();
struct PickedGamma {
  std::unique_ptr<GammaMethod> method;
  std::string name;    ///< of the method that is used
  std::string reason;  ///< why "auto" took it; empty when it was asked for by name
};
PickedGamma makeGammaMethod(int index, const GammaContext& context);

// How the density is corrected at walls: by gamma, by one of the baselines that it is compared with, or not
// at all. All of them are a GammaMethod, so the solver treats them alike. A baseline is one file in
// core/gamma and one line in gamma_method.cpp.

/// The place of a handling in handlingNames(); baselines come after those that have a name here.
enum class BoundaryHandling : int {
  gamma,  ///< [FM] Eq. 5: divided by the part of the kernel that the solid does not cover
  none,   ///< not at all: the paper's "without correction"; walls only keep centres out
};

/// Names for the scene's "handling" key.
std::span<const std::string_view> handlingNames();

/// The method that corrects the density: the gamma method of that index for `gamma`, null for `none`, else
/// the baseline, for which the name is that of the handling.
PickedGamma makeHandling(BoundaryHandling handling, int gammaMethod, const GammaContext& context);

// The methods that gamma_method.cpp lists, one file each.

/// A method that has a grid about some of the walls.
class GridGamma : public GammaMethod {
 public:
  /// Whether gamma at p comes from the grid.
  virtual bool covers(const Vec3f& p) const = 0;
};

/// gamma of the closest wall alone, as if it were an infinite plane.
std::unique_ptr<GammaMethod> makeNearestGamma(const GammaContext& context);
/// [FM] Eq. 14: the Gaussian-weighted mean over the pieces in reach.
std::unique_ptr<GammaMethod> makeMeanGamma(const GammaContext& context);
/// The product over planes at right angles.
std::unique_ptr<GammaMethod> makeProductGamma(const GammaContext& context);
/// A Gaussian copula over planes at any angle.
std::unique_ptr<GammaMethod> makeCopulaGamma(const GammaContext& context);
/// The mean over fixed directions of the kernel's mass up to the first wall; any shape.
std::unique_ptr<GammaMethod> makeDirectionsGamma(const GammaContext& context);
/// Sums over the edges of flat facets, exact but for rounding; of curved walls the tangent planes.
std::unique_ptr<GammaMethod> makeFacetsGamma(const GammaContext& context);
/// A grid of gamma about walls that stand still, made once and kept on disk.
std::unique_ptr<GammaMethod> makeBakedGamma(const GammaContext& context);
/// The same about the curved walls, or null where making the grid could take more than some seconds.
std::unique_ptr<GridGamma> makeBakedGammaIfQuick(const GammaContext& context);
/// The reference: the share of samples of the kernel that lie in the fluid.
std::unique_ptr<GammaMethod> makeMonteCarloGamma(const GammaContext& context);
/// Picks among the others at every point, by the shapes in reach.
std::unique_ptr<GammaMethod> makeAutoGamma(const GammaContext& context);
/// The same without a grid: for walls that move, or of which some do.
std::unique_ptr<GammaMethod> makeAutoGammaWithoutGrid(const GammaContext& context);
/// Walls that move as one asked in their own frame, each by what `make` makes of them; where several frames
/// are in reach, by makeAutoGammaWithoutGrid.
std::unique_ptr<GammaMethod> makeMovingGamma(const GammaContext& context,
                                             std::unique_ptr<GammaMethod> (*make)(const GammaContext&));

// What gamma is compared with: other ways to make up for the density that a wall takes, each from its paper.
// They meet gamma in the same solver, and act on a particle through the same GammaSample.

/// Akinci, Ihmsen, Akinci, Solenthaler, Teschner 2012: particles sampled on the walls, each with the volume
/// that it stands for.
std::unique_ptr<GammaMethod> makeBoundaryParticles(const GammaContext& context);
/// Harada, Koshizuka, Kawaguchi 2007: a wall full of resting particles, summed beforehand over the distance.
std::unique_ptr<GammaMethod> makeWallWeight(const GammaContext& context);
/// Kulasegaram, Bonet, Lewis, Profit 2004: gamma as a spline over the distance.
std::unique_ptr<GammaMethod> makeSplineGamma(const GammaContext& context);
/// No correction, and a force that grows with the depth in the wall: core/solver/penalty.cpp.
std::unique_ptr<GammaMethod> makePenalty(const GammaContext& context);

// gamma on a plane cut through a scene, and how far it is from a fine reference: the paper's Figure 3.

/// A rectangle in the plane axis = at, sampled cell-centred.
struct MapWindow {
  int axis = 2;                              ///< normal of the cut: 0 x, 1 y, 2 z
  double at = 0;                             ///< (m)
  int across = 0, up = 1;                    ///< axes of the picture
  double low[2] = {0, 0}, high[2] = {1, 1};  ///< along those axes (m)
  int columns = 240, rows = 240;

  Vec3d point(int column, int row) const;
};

/// gamma of a method at the window's points, row by row; NaN in the solid.
std::vector<float> gammaMap(const GammaMethod& method, const Boundary& boundary, const MapWindow& window,
                            ThreadPool& pool);

/// What the map's error is measured against: many more directions than any method uses, within 2e-4 of the
/// truth.
PickedGamma referenceGamma(GammaContext context);

// Boundary particles: points spread over the walls of a scene, one layer thick, each with the volume that it
// stands for (Akinci et al. 2012, "Versatile Rigid-Fluid Coupling for Incompressible SPH", section 3.1).

/// Points `depth` (m) behind the walls, within `region`: no two nearer to each other than about a `spacing`
/// (m), and no place of that layer farther than that from one of them. In parts of a solid that are too thin
/// for that depth they lie midway. Flat walls along the axes have a square lattice of them. The same for any
/// number of threads. Throws InputError, at `place`, when there would be too many.
std::vector<Vec3f> sampleWalls(const Boundary& boundary, const Bounds& region, float spacing, float depth,
                               ThreadPool& pool, const std::string& place);

/// Boundary particles, to be found from where a fluid particle is.
class BoundaryParticles {
 public:
  /// Akinci Eqs. 4 and 5: Psi_b / rho0 = V_b = 1 / sum_k W_bk over all boundary particles k in reach, b
  /// itself included.
  BoundaryParticles(const std::vector<Vec3f>& places, KernelType kernel, float supportRadius,
                    ThreadPool& pool);

  /// xyz: place (m); w: volume over the support radius cubed.
  std::span<const Float4> particles() const { return particles_; }

  /// Calls body(offset, q, volume) for the boundary particles within the support radius of p: offset from
  /// there to p and its length, both over the support radius.
  template <class Body>
  void around(const Vec3f& p, const Body& body) const {
    const CellGrid::Cell cell = grid_.cellOf(Float4(p));
    for (int row = 0; row < 9; ++row) {
      const auto [from, to] = grid_.row(cell.x - 1, cell.x + 1, cell.y + row % 3 - 1, cell.z + row / 3 - 1);
      for (std::uint32_t k = from; k < to; ++k) {
        const Vec3f offset = inverseSupport_ * (p - particles_[k].xyz());
        const float squared = offset.squaredNorm();
        if (squared < 1) body(offset, std::sqrt(squared), particles_[k].w);
      }
    }
  }

 private:
  float inverseSupport_;
  CellGrid grid_;
  std::vector<Float4> particles_;  ///< in the order of the grid
};

}  // namespace migiwa
