// The methods that gamma_registry.cpp lists, one file each.
#pragma once

#include <memory>

#include "core/boundary/gamma_method.h"

namespace migiwa {

/// A method that has a grid about some of the walls.
class GridGamma : public GammaMethod {
 public:
  /// Whether gamma at p comes from the grid.
  virtual bool covers(const Vec3f& p) const = 0;
  /// evaluate() for samples that hold their distances already, and otherwise nothing.
  virtual void evaluateMeasured(std::span<const Float4> points, std::span<GammaSample> out) const = 0;
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

}  // namespace migiwa
