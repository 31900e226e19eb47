// Fluid sources against lattices that can be counted by hand.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/scene/sources.h"

namespace migiwa {
namespace fluid_source_test {

std::vector<Vec3d> filled(const FluidSource& source, double spacing) {
  std::vector<Vec3d> centers;
  source.fill(spacing, centers);
  return centers;
}

Vec3d mean(const std::vector<Vec3d>& points) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double smallestDistance(const std::vector<Vec3d>& points) {
  double least = INFINITY;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) least = std::min(least, (points[i] - points[k]).norm());
  return least;
}

TEST(BoxSource, FillsTheDamOfThePaperWithItsParticles) {
  const BoxSource box({0, 0, 0}, {0.8, 0.9, 1.6});
  EXPECT_EQ(box.count(0.05), 16 * 18 * 32);
  EXPECT_EQ(filled(box, 0.05).size(), 9216U);
}

TEST(BoxSource, CentresLieHalfASpacingInsideTheCorners) {
  const auto centers = filled(BoxSource({1, 2, 3}, {1.2, 2.4, 3.6}), 0.1);
  ASSERT_EQ(centers.size(), 2U * 4U * 6U);
  Bounds bounds;
  for (const Vec3d& p : centers) bounds.include(p);
  EXPECT_TRUE(bounds.min.isApprox(Vec3d(1.05, 2.05, 3.05)));
  EXPECT_TRUE(bounds.max.isApprox(Vec3d(1.15, 2.35, 3.55)));
  EXPECT_TRUE(mean(centers).isApprox(Vec3d(1.1, 2.2, 3.3)));
  EXPECT_NEAR(smallestDistance(centers), 0.1, 1e-12);
}

TEST(BoxSource, HasTheWholeCellsThatFitFromTheLowerCorner) {
  // 2.4, 2.6 and 1.99999999 cells; the last is what decimal numbers make of 2.
  const BoxSource box({0, 0, 0}, {0.24, 0.26, 0.199999999});
  EXPECT_GE(box.count(0.1), 2 * 2 * 2);
  const auto centers = filled(box, 0.1);
  ASSERT_EQ(centers.size(), 8U);
  EXPECT_TRUE(centers.front().isApprox(Vec3d(0.05, 0.05, 0.05)));
  EXPECT_TRUE(centers.back().isApprox(Vec3d(0.15, 0.15, 0.15)));
  EXPECT_TRUE(box.leftOver(0.1).isApprox(Vec3d(0.04, 0.06, 0), 1e-6));
}

TEST(BoxSource, IsNeverFilledBeyondMax) {
  for (int k = 1; k < 2000; ++k) {
    const double length = 0.001 * k, spacing = 0.013 + 1e-5 * k;
    const BoxSource box({-1, 2, 5}, {-1 + length, 2 + 0.1, 5 + 0.1});
    const auto centers = filled(box, spacing);
    EXPECT_GE(box.count(spacing), static_cast<double>(centers.size())) << k;
    double last = -1;
    for (const Vec3d& p : centers) last = std::max(last, p.x() + 0.5 * spacing);
    ASSERT_LE(last, -1 + length + 2e-6 * spacing) << k;
    if (length >= spacing) {
      ASSERT_GT(last, -1 + length - spacing) << k << ": a cell more has room";
    }
  }
}

TEST(BoxSource, ThinnerThanHalfACellIsEmpty) {
  const BoxSource box({0, 0, 0}, {1, 1, 0.04});
  EXPECT_EQ(box.count(0.1), 0);
  EXPECT_TRUE(filled(box, 0.1).empty());
}

TEST(BoxSource, TurnsAboutItsCentre) {
  const Vec3d min(0, 0, 0);
  const Vec3d max(0.4, 0.2, 0.2);
  const auto upright = filled(BoxSource(min, max), 0.1);
  const BoxSource turned(min, max, {.axis = {0, 0, 2}, .degrees = 90});
  const auto centers = filled(turned, 0.1);
  ASSERT_EQ(centers.size(), upright.size());
  EXPECT_TRUE(mean(centers).isApprox(Vec3d(0.2, 0.1, 0.1)));
  // A quarter turn about z takes (x, y) to (-y, x), both from the centre.
  for (std::size_t k = 0; k < centers.size(); ++k) {
    const Vec3d from = upright[k] - Vec3d(0.2, 0.1, 0.1);
    EXPECT_TRUE((centers[k] - Vec3d(0.2, 0.1, 0.1)).isApprox(Vec3d(-from.y(), from.x(), from.z()), 1e-9));
  }
  EXPECT_TRUE(turned.bounds().size().isApprox(Vec3d(0.2, 0.4, 0.2)));
}

TEST(BoxSource, BoundsHoldATurnedBox) {
  const BoxSource cube({-1, -1, -1}, {1, 1, 1}, {.axis = {0, 1, 0}, .degrees = 45});
  const double half = std::numbers::sqrt2;
  EXPECT_TRUE(cube.bounds().max.isApprox(Vec3d(half, 1, half)));
  EXPECT_TRUE(cube.bounds().min.isApprox(Vec3d(-half, -1, -half)));
}

TEST(SphereSource, HoldsTheCellsThatCanBeCountedByHand) {
  // Half-integer points within 2 of the origin: 8 of (1,1,1)/2 and 24 of (1,1,3)/2.
  EXPECT_EQ(filled(SphereSource({5, 6, 7}, 0.2), 0.1).size(), 32U);
}

TEST(SphereSource, IsCentredAndInsideItsRadius) {
  const Vec3d center(0.3, -0.2, 1);
  const auto centers = filled(SphereSource(center, 0.45), 0.05);
  EXPECT_TRUE(mean(centers).isApprox(center, 1e-9));
  for (const Vec3d& p : centers) EXPECT_LE((p - center).norm(), 0.45 + 1e-12);
  EXPECT_NEAR(smallestDistance(centers), 0.05, 1e-12);
  const double volume = 4.0 / 3 * std::numbers::pi * 0.45 * 0.45 * 0.45;
  EXPECT_NEAR(static_cast<double>(centers.size()) * 0.05 * 0.05 * 0.05, volume, 0.03 * volume);
}

TEST(SphereSource, CountIsNeverBelowWhatIsFilled) {
  for (double radius = 0.03; radius < 1; radius *= 1.1) {
    const SphereSource sphere({0, 0, 0}, radius);
    EXPECT_GE(sphere.count(0.1), static_cast<double>(filled(sphere, 0.1).size())) << "radius " << radius;
  }
}

/// The wave that a scene's object describes; y is up.
std::shared_ptr<const FluidSource> waveOf(const std::string& fields) {
  return parseScene(
             R"({"format": 1, "particle_spacing": 0.02, "boundary": {"surfaces": []}, "fluid": [{"shape":
      "wave", )" +
                 fields + "}]}",
             "wave.json")
      .fluid.front();
}

TEST(WaveSource, IsFullUpToItsSurface) {
  const auto source =
      waveOf(R"("form": "cosine", "min": [0, 0, 0], "max": [1, 0.5, 0.02], "height": 0.05, "wavelength": 2)");
  const auto centers = filled(*source, 0.005);
  EXPECT_LE(static_cast<double>(centers.size()), source->count(0.005));
  for (const Vec3d& p : centers) EXPECT_LT(p.y(), 0.5 + 0.05 * std::cos(std::numbers::pi * p.x()));
  // Cells are in or out as a whole: the volume is that of the still water but for that.
  EXPECT_NEAR(static_cast<double>(centers.size()) * std::pow(0.005, 3) / 0.02, 0.5, 0.005 * 0.5);
  // Half a cosine from 0 to 1 carries the centre of mass by -2 H / (pi^2 d).
  EXPECT_NEAR(mean(centers).x(), 0.5 - 2 * 0.05 / (std::numbers::pi * std::numbers::pi * 0.5), 5e-4);
  EXPECT_TRUE(source->velocityAt({0.3, 0.2, 0.1}).isZero());
}

TEST(WaveSource, ASolitaryWaveCarriesItsWater) {
  const double speed = std::sqrt(9.81 * 0.36);
  const auto source = waveOf(
      R"("form": "solitary", "min": [0, 0, 0], "max": [6, 0.3, 0.1], "height": 0.06, "crest": 3, "speed": 1.879255)");
  // At the crest u = c H / (d + H); far away the water is at rest.
  EXPECT_NEAR(source->velocityAt({3, 0.1, 0}).x(), speed * 0.06 / 0.36, 1e-6);
  EXPECT_NEAR(source->velocityAt({6, 0.1, 0}).norm(), 0, 1e-3);
  EXPECT_GE(source->largestSpeed(), source->velocityAt({3, 0.1, 0}).norm());
  // The volume of the hump is 4 d sqrt(d H / 3) for each metre across; its tails are thinner than half a
  // cell.
  double hump = 0;
  for (const Vec3d& p : filled(*source, 0.005)) hump += p.y() > 0.3 ? std::pow(0.005, 3) : 0;
  EXPECT_NEAR(hump / 0.1, 4 * 0.3 * std::sqrt(0.3 * 0.06 / 3), 2e-3);
  // Free of divergence: v at the height y is -y du/dx.
  const double step = 1e-4, x = 2.7, y = 0.2;
  const double slope =
      (source->velocityAt({x + step, y, 0}).x() - source->velocityAt({x - step, y, 0}).x()) / (2 * step);
  EXPECT_NEAR(source->velocityAt({x, y, 0}).y(), -y * slope, 1e-6);
}

TEST(FluidSources, EveryNameMakesASource) {
  ASSERT_FALSE(fluidShapes().empty());
  for (int shape = 0; shape < static_cast<int>(fluidShapes().size()); ++shape)
    EXPECT_NE(makeFluidSource(shape), nullptr) << fluidShapes()[static_cast<std::size_t>(shape)];
}

}  // namespace fluid_source_test
}  // namespace migiwa
