// Fields on a plane: a constant is right up to every kind of wall, sums are those of a loop over all
// particles, and the raster is where it says.
#include "core/surface/section.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/walls/shapes.h"

namespace migiwa {
namespace section_test {

constexpr double kSupport = 0.1;
/// Particles so fine that their sum is the integral but for less than what is asked of the section.
constexpr double kFine = 0.1 * kSupport;

std::vector<std::shared_ptr<const Surface>> planes(int count) {
  std::vector<std::shared_ptr<const Surface>> walls;
  for (int axis = 0; axis < count; ++axis)
    walls.push_back(std::make_shared<Plane>(Vec3d::Zero(), Vec3d::Unit(axis)));
  return walls;
}

struct Liquid {
  std::vector<Float4> positions;
  std::vector<float> values;  ///< of a constant 1: how much of a particle's cell is liquid
  Boundary boundary;

  void fill(const Vec3d& min, const Vec3d& max, double spacing) {
    const Vec3d cells = (max - min) / spacing;
    for (int k = 0; k < std::lround(cells.z()); ++k)
      for (int j = 0; j < std::lround(cells.y()); ++j)
        for (int i = 0; i < std::lround(cells.x()); ++i)
          positions.emplace_back(Vec3d(min + spacing * Vec3d(i + 0.5, j + 0.5, k + 0.5)).cast<float>());
    values.assign(positions.size(), 1);
  }
  SectionFluid fluid(double spacing, KernelType kernel = KernelType::poly6) const {
    return {positions, values, static_cast<float>(std::pow(spacing / kSupport, 3)),
            static_cast<float>(kSupport), kernel};
  }
  GammaContext context(KernelType kernel = KernelType::poly6) const {
    return {boundary, kernel, static_cast<float>(kSupport)};
  }
};

/// Cells of the rectangle from `corner`, of so many along each side.
SectionPlane square(const Vec3d& corner, const Vec3d& across, const Vec3d& up, double side, int cells) {
  return {corner, across, up, side / cells, cells, cells};
}

SectionRaster read(const Liquid& liquid, const SectionFluid& fluid, const SectionPlane& plane,
                   SectionDivisor divisor) {
  ThreadPool pool(2);
  const PickedGamma gamma = liquid.boundary.empty() ? PickedGamma{} : referenceGamma(liquid.context());
  return section(plane, fluid, {&liquid.boundary, gamma.method.get()}, divisor, pool);
}

/// Largest difference from 1 of all cells, none of which may lack liquid.
double worstOf(const SectionRaster& raster) {
  double worst = 0;
  for (const float value : raster.values) {
    if (std::isnan(value)) return 1e9;
    worst = std::max(worst, std::abs(static_cast<double>(value) - 1));
  }
  return worst;
}

TEST(Section, AConstantIsOneUpToAPlaneAnEdgeAndACornerAndHalfOfItWithoutGamma) {
  for (const int walls : {1, 2, 3}) {
    SCOPED_TRACE(walls);
    Liquid liquid;
    liquid.boundary = Boundary(planes(walls));
    const double behind = 2.2 * kSupport;
    liquid.fill({0, walls > 1 ? 0 : -1.1 * kSupport, walls > 2 ? 0 : -1.1 * kSupport},
                {behind, walls > 1 ? behind : 1.1 * kSupport, 1.1 * kSupport}, kFine);
    // From the wall itself to a support radius away; of a corner right above its third plane.
    const SectionPlane plane = square({0, 0, walls > 2 ? 1e-6 : 0.001}, Vec3d::UnitX(), Vec3d::UnitY(),
                                      walls > 1 ? kSupport : 0.01, 40);
    SectionPlane band = plane;
    if (walls == 1) band.columns = 400;
    const SectionFluid fluid = liquid.fluid(kFine);
    EXPECT_LT(worstOf(read(liquid, fluid, band, SectionDivisor::gamma)), 0.005);
    EXPECT_LT(worstOf(read(liquid, fluid, band, SectionDivisor::sum)), 1e-5);
    const SectionRaster plain = read(liquid, fluid, band, SectionDivisor::none);
    EXPECT_NEAR(static_cast<double>(plain.values.front()), std::pow(0.5, walls), 0.02) << "at the wall";
  }
}

TEST(Section, AConstantIsOneUpToASphereFromInsideAndFromOutside) {
  for (const auto side : {Sphere::Fluid::inside, Sphere::Fluid::outside}) {
    SCOPED_TRACE(static_cast<int>(side));
    const double radius = 1.6 * kSupport;
    const bool inside = side == Sphere::Fluid::inside;
    Liquid liquid;
    liquid.boundary = Boundary({std::make_shared<Sphere>(Vec3d::Zero(), radius, side)});
    liquid.fill({-1, -0.11, -0.11}, {1, 0.11, 0.11}, kFine);
    // Cells that the sphere cuts count by their share, of 6 x 6 x 6 places.
    for (std::size_t i = 0; i < liquid.positions.size(); ++i) {
      int wet = 0;
      for (int k = 0; k < 216; ++k) {
        const Vec3d place =
            liquid.positions[i].xyz().cast<double>() +
            kFine * (Vec3d(k % 6 + 0.5, k / 6 % 6 + 0.5, k / 36 + 0.5) / 6 - Vec3d(0.5, 0.5, 0.5));
        wet += (place.norm() < radius) == inside ? 1 : 0;
      }
      liquid.values[i] = static_cast<float>(wet) / 216;
    }
    std::erase_if(liquid.positions,
                  [&, k = std::size_t{0}](const Float4&) mutable { return liquid.values[k++] == 0; });
    std::erase(liquid.values, 0.0F);
    // A narrow strip across the wall: the liquid's cells are right, and all up to the wall are liquid.
    const double from = inside ? radius - kSupport : radius - 0.02;
    const SectionPlane plane{{from, -0.004, 0.003}, Vec3d::UnitX(), Vec3d::UnitY(), 0.002, 60, 4};
    const SectionRaster raster = read(liquid, liquid.fluid(kFine), plane, SectionDivisor::gamma);
    int wet = 0;
    for (int row = 0; row < plane.rows; ++row) {
      for (int column = 0; column < plane.columns; ++column) {
        const Vec3d p = plane.point(column, row);
        const double distance = (radius - p.norm()) * (inside ? 1 : -1);
        const std::optional<float> value = raster.at(p);
        if (std::abs(distance) > 1e-5) {
          ASSERT_EQ(value.has_value(), distance > 0) << column << ' ' << row;
        }
        if (!value) continue;
        EXPECT_NEAR(static_cast<double>(*value), 1, 0.005) << column << ' ' << row;
        ++wet;
      }
    }
    EXPECT_GT(wet, 150);
  }
}

/// A random cloud with random values in a box with a ball in it.
Liquid cloudInABox() {
  Liquid liquid;
  liquid.boundary = Boundary({std::make_shared<Box>(Vec3d::Zero(), Vec3d(0.4, 0.4, 0.4), Box::Fluid::inside),
                              std::make_shared<Sphere>(Vec3d(0.2, 0.1, 0.2), 0.08, Sphere::Fluid::outside)});
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(0, 0.4F), value(-2, 3);
  while (liquid.positions.size() < 1500) {
    const float x = place(random), y = 0.6F * place(random), z = place(random);
    const Vec3f p(x, y, z);
    if (liquid.boundary.distance(p) <= 0) continue;
    liquid.positions.emplace_back(p);
    liquid.values.push_back(value(random));
  }
  return liquid;
}

TEST(Section, IsWhatALoopOverAllParticlesSumsUp) {
  const Liquid liquid = cloudInABox();
  Bounds bounds;
  bounds.include(Vec3d::Zero());
  bounds.include(Vec3d(0.4, 0.4, 0.4));
  ThreadPool pool(2);
  const double spacing = 0.035;
  for (std::size_t kernel = 0; kernel < kKernelNames.size(); ++kernel) {
    const auto type = static_cast<KernelType>(kernel);
    const SectionFluid fluid = liquid.fluid(spacing, type);
    const PickedGamma gamma = makeGammaMethod(0, liquid.context(type));
    for (const Vec3d& normal : {Vec3d(0, 0, 1), Vec3d(1, 0.7, -0.4)}) {
      const auto plane =
          sectionPlane(normal, normal.normalized().dot(Vec3d(0.2, 0.12, 0.2)), bounds, Vec3d::UnitY(), 50);
      ASSERT_TRUE(plane);
      const LiquidWalls walls{&liquid.boundary, gamma.method.get()};
      const SectionRaster shown[] = {section(*plane, fluid, walls, SectionDivisor::sum, pool),
                                     section(*plane, fluid, walls, SectionDivisor::gamma, pool),
                                     section(*plane, fluid, walls, SectionDivisor::none, pool),
                                     gammaSection(*plane, fluid, walls, pool)};
      int wet = 0, dry = 0;
      for (int row = 0; row < plane->rows; ++row) {
        for (int column = 0; column < plane->columns; ++column) {
          const Vec3d p = plane->point(column, row);
          double weights = 0, values = 0;
          for (std::size_t i = 0; i < liquid.positions.size(); ++i) {
            const double q = (liquid.positions[i].xyz().cast<double>() - p).norm() / kSupport;
            const double w = std::pow(spacing / kSupport, 3) * withKernel(type, [&](auto k) {
                               return static_cast<double>(decltype(k)::value(static_cast<float>(q)));
                             });
            weights += w;
            values += w * static_cast<double>(liquid.values[i]);
          }
          const Float4 at(Vec3f(p.cast<float>()));
          GammaSample sample;
          gamma.method->evaluate({&at, 1}, {&sample, 1});
          const auto g = static_cast<double>(sample.gamma);
          const auto distance = static_cast<double>(liquid.boundary.distance(at.xyz()));
          if (std::abs(distance) < 1e-6 || std::abs(weights - 0.5 * g) < 1e-4) continue;
          const bool liquidHere = distance > 0 && weights > 0.5 * g;
          ++(liquidHere ? wet : dry);
          const std::size_t cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(plane->columns) +
                                   static_cast<std::size_t>(column);
          const double expected[] = {values / weights, values / g, values, g};
          for (std::size_t k = 0; k < 4; ++k) {
            const float value = shown[k].values[cell];
            ASSERT_EQ(std::isnan(value), !liquidHere) << column << ' ' << row << " of " << k;
            if (!liquidHere) continue;
            ASSERT_NEAR(static_cast<double>(value), expected[k], 2e-5 * (1 + std::abs(expected[k]))) << k;
          }
        }
      }
      EXPECT_GT(wet, 400);
      EXPECT_GT(dry, 250);
    }
  }
}

TEST(SectionThreads, GiveTheSameBytes) {
  const Liquid liquid = cloudInABox();
  Bounds bounds;
  bounds.include(Vec3d::Zero());
  bounds.include(Vec3d(0.4, 0.4, 0.4));
  const SectionPlane plane = *sectionPlane({1, 1, 1}, 0.3, bounds, Vec3d::UnitY(), 130);
  const SectionFluid fluid = liquid.fluid(0.035);
  const PickedGamma gamma = makeGammaMethod(0, liquid.context());
  const auto readWith = [&](int threads) {
    ThreadPool pool(threads);
    return section(plane, fluid, {&liquid.boundary, gamma.method.get()}, SectionDivisor::gamma, pool);
  };
  const SectionRaster one = readWith(1);
  ASSERT_TRUE(one.range());
  for (const int threads : {2, 5}) {
    const SectionRaster other = readWith(threads);
    ASSERT_EQ(other.values.size(), one.values.size());
    EXPECT_EQ(std::memcmp(other.values.data(), one.values.data(), one.values.size() * sizeof(float)), 0);
  }
}

TEST(Section, HasNoValueWhereThereIsNothingOrWhatIsNotFinite) {
  Liquid liquid;
  liquid.fill({0, 0, 0}, {0.1, 0.1, 0.1}, 0.05);
  liquid.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0, 0});
  liquid.positions.push_back({std::numeric_limits<float>::infinity(), 0, 0, 0});
  liquid.values.resize(liquid.positions.size(), 1);
  const SectionPlane plane = square({-0.2, -0.2, 0.05}, Vec3d::UnitX(), Vec3d::UnitY(), 0.6, 60);
  const SectionRaster raster = read(liquid, liquid.fluid(0.05), plane, SectionDivisor::sum);
  EXPECT_FALSE(raster.at({-0.15, 0, 0.05}));
  EXPECT_FALSE(raster.at({5, 0, 0.05}));
  ASSERT_TRUE(raster.at({0.05, 0.05, 0.05}));
  EXPECT_NEAR(static_cast<double>(*raster.at({0.05, 0.05, 0.05})), 1, 1e-6);
  ASSERT_TRUE(raster.range());
  EXPECT_NEAR(static_cast<double>((*raster.range())[0]), 1, 1e-5);
  const SectionRaster empty = read({}, {}, plane, SectionDivisor::sum);
  EXPECT_FALSE(empty.range());
}

TEST(Section, IsAsSteepAsItsFieldUpToTheBorderOfTheLiquid) {
  SectionRaster raster;
  raster.plane.columns = 5, raster.plane.rows = 5;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column)
      raster.values.push_back(column == 2 && row == 2 ? std::nanf("")
                                                      : static_cast<float>(3 * column + 4 * row));
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column)
      if (!std::isnan(raster.value(column, row))) {
        EXPECT_EQ(raster.steepness(column, row), 5) << column << ' ' << row;
      }
  for (float& value : raster.values) value = 7;
  EXPECT_EQ(raster.steepness(0, 3), 0);
}

TEST(SectionPlane, IsUprightAndHoldsWhatThePlaneCutsOutOfTheBounds) {
  Bounds bounds;
  bounds.include(Vec3d(-1, 0, 0));
  bounds.include(Vec3d(3, 1, 2));
  const SectionPlane side = *sectionPlane({0, 0, 5}, 0.5, bounds, Vec3d::UnitY(), 512);
  EXPECT_EQ(side.across, Vec3d::UnitX());
  EXPECT_EQ(side.up, Vec3d::UnitY());
  EXPECT_TRUE(side.corner.isApprox(Vec3d(-1, 0, 0.5)));
  EXPECT_EQ(side.columns, 512);
  EXPECT_EQ(side.rows, 128);
  const SectionPlane floor = *sectionPlane({0, -1, 0}, -0.25, bounds, Vec3d::UnitY(), 100);
  EXPECT_TRUE(floor.corner.isApprox(Vec3d(-1, 0.25, 0))) << floor.corner.transpose();
  EXPECT_EQ(floor.columns, 100);
  EXPECT_EQ(floor.rows, 50);
  EXPECT_FALSE(sectionPlane({0, 0, 1}, 2.1, bounds, Vec3d::UnitY(), 100));

  std::mt19937 random(3);
  std::uniform_real_distribution<double> one(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3d normal = Vec3d(one(random), one(random), one(random)).normalized();
    const double offset = normal.dot(Vec3d(1, 0.5, 1)) + 0.3 * one(random);
    const SectionPlane plane = *sectionPlane(normal, offset, bounds, Vec3d::UnitY(), 64);
    EXPECT_NEAR(std::abs(plane.normal().dot(normal)), 1, 1e-12);
    EXPECT_NEAR(plane.across.dot(plane.up), 0, 1e-12);
    EXPECT_NEAR(normal.dot(plane.point(3, 5)), offset, 1e-12);
    EXPECT_EQ(std::max(plane.columns, plane.rows), 64);
    // Points of the plane in the bounds are in a cell.
    for (int k = 0; k < 40; ++k) {
      const Vec3d q(-1 + 2 * (1 + one(random)), 0.5 * (1 + one(random)), 1 + one(random));
      const Vec3d p = q - (normal.dot(q) - offset) * normal;
      if (!bounds.contains(p)) continue;
      const double column = (p - plane.corner).dot(plane.across) / plane.cell,
                   row = (p - plane.corner).dot(plane.up) / plane.cell;
      EXPECT_TRUE(column > -1e-6 && row > -1e-6 && column < plane.columns + 1e-6 && row < plane.rows + 1e-6);
    }
  }
}

TEST(Section, ItsTableHasThePlacesOfTheFile) {
  SectionRaster raster{square({0, 0, 0.5}, Vec3d::UnitX(), Vec3d::UnitY(), 1, 2),
                       {1, 2, std::numeric_limits<float>::quiet_NaN(), 4}};
  EXPECT_EQ(sectionCsv(raster, Vec3d::Zero(), "speed"),
            "x,y,z,speed\n0.25,0.25,0.5,1\n0.75,0.25,0.5,2\n0.75,0.75,0.5,4\n");
  EXPECT_EQ(sectionCsv(raster, {1000000, 0, 0}, "speed").substr(12, 22), "1000000.25,0.25,0.5,1\n");
}

}  // namespace section_test
}  // namespace migiwa
