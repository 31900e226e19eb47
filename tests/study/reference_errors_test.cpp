// Errors of states made by hand: gamma against a sum over a fine lattice that shares nothing with the
// program.
#include <cmath>

#include <gtest/gtest.h>

#include "core/study/study.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace reference_errors_test {

using namespace migiwa::testing;

constexpr double kSupport = 2 * kSpacing;

double poly6(double squared) {
  return squared < 1 ? std::pow(1 - squared, 3) : 0;
}

/// The part of Poly6 about `p` (m) with all coordinates positive, by midpoints: a corner at the origin.
double gammaByLattice(const Vec3d& p) {
  constexpr int kCells = 120;
  double fluid = 0, all = 0;
  for (int k = 0; k < kCells; ++k)
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        const Vec3d offset = Vec3d(i + 0.5, j + 0.5, k + 0.5) * (2.0 / kCells) - Vec3d::Ones();
        const double weight = poly6(offset.squaredNorm());
        all += weight;
        if ((p + kSupport * offset).minCoeff() > 0) fluid += weight;
      }
  return fluid / all;
}

Scene tank() {
  Scene scene = emptyScene();
  addTank(scene, {0, 0, 0}, {2, 2, 2});
  return scene;
}

ReferenceErrors errorsOf(const std::vector<Float4>& points, const std::vector<float>& gamma) {
  ReferenceSampler sampler(1);
  sampler.sample(tank(), 0, points, gamma);
  return sampler.result();
}

Float4 at(double x, double y, double z) {
  return Float4(Vec3f(Vec3d(x, y, z).cast<float>()));
}

TEST(ReferenceErrors, ExactGammaHasNone) {
  const double near = 0.25 * kSupport;
  const std::vector<Vec3d> places{{near, 1, 1}, {near, near, 1}, {near, 2 * near, near}};
  std::vector<Float4> points;
  std::vector<float> gamma;
  for (const Vec3d& place : places) {
    points.push_back(at(place.x(), place.y(), place.z()));
    gamma.push_back(static_cast<float>(gammaByLattice(place)));
  }
  // The lattice of the test is good to 0.0005 itself.
  EXPECT_LT(*errorsOf(points, gamma).gammaMax, 0.001);
  gamma[1] += 0.1F;
  EXPECT_NEAR(*errorsOf(points, gamma).gammaMax, 0.1, 0.001);
  EXPECT_NEAR(*errorsOf(points, gamma).gammaMean, 0.1 / 3, 0.001);
}

TEST(ReferenceErrors, ExactGradientHasNone) {
  // Differences of the lattice's gamma, over a tenth of the support radius.
  const Vec3d place = kSupport * Vec3d(0.25, 0.5, 0.25);
  Vec3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d step = 0.05 * kSupport * Vec3d::Unit(axis);
    gradient[axis] = static_cast<float>((gammaByLattice(place + step) - gammaByLattice(place - step)) / 0.1);
  }
  const auto errorOf = [&](const Vec3f& given) {
    ReferenceSampler sampler(1);
    const std::vector<Float4> points{at(place.x(), place.y(), place.z())};
    const std::vector<float> gamma{1};
    const std::vector<Vec3f> gradients{given};
    sampler.sample(tank(), 0, points, gamma, gradients);
    return *sampler.result().gradientMean;
  };
  EXPECT_LT(errorOf(gradient), 0.02);
  EXPECT_NEAR(errorOf(gradient + Vec3f(0.3F, 0, 0)), 0.3, 0.02);
}

TEST(ReferenceErrors, OnlyParticlesNearWallsCountForGamma) {
  EXPECT_FALSE(errorsOf({at(1, 1, 1)}, {0.5F}).gammaMean.has_value());
  EXPECT_FALSE(errorsOf({}, {}).densityMean.has_value());
}

TEST(ReferenceErrors, DensityIsOverTheReferenceGammaWhateverTheRunTook) {
  // 40 particles in one place weigh 40 W(0); the lattice at rest weighs the sum of W over it.
  constexpr int kMany = 40;
  double resting = 0;
  for (int k = -2; k <= 2; ++k)
    for (int j = -2; j <= 2; ++j)
      for (int i = -2; i <= 2; ++i) resting += poly6((i * i + j * j + k * k) / 4.0);
  const double near = 0.25 * kSupport;
  const double expected = kMany / resting / gammaByLattice({near, near, near}) - 1;
  const std::vector<Float4> points(kMany, at(near, near, near));
  for (const float gamma : {1.0F, 0.3F}) {
    const ReferenceErrors found = errorsOf(points, std::vector<float>(kMany, gamma));
    EXPECT_NEAR(*found.densityMean, expected, 0.005 * expected);
    EXPECT_NEAR(*found.densityMax, expected, 0.005 * expected);
  }
  // A particle alone is too thin, not too dense.
  EXPECT_EQ(*errorsOf({at(1, 1, 1)}, {1}).densityMean, 0);
}

}  // namespace reference_errors_test
}  // namespace migiwa
