// What the papers of the baselines promise: Harada et al. 2007 (wall_weight), Kulasegaram et al. 2004
// (spline), Akinci et al. 2012 (particles).
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/sph/kernels.h"
#include "core/walls/shapes.h"
#include "tests/gamma/gamma_reference.h"
#include "tests/sph/quadrature.h"

namespace migiwa {
namespace baselines_test {

using Surfaces = std::vector<std::shared_ptr<const Surface>>;

using reference::kKernels;
constexpr float kSpacing = 0.05F, kSupport = static_cast<float>(reference::kSupport);

Boundary floorWall() {
  return Boundary(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), Vec3d(0, 1, 0))});
}

PickedGamma make(std::string_view handling, const Boundary& boundary, KernelType kernel = KernelType::poly6,
                 float support = kSupport) {
  const auto names = handlingNames();
  const auto index = std::find(names.begin(), names.end(), handling) - names.begin();
  GammaContext context{boundary, kernel, support};
  context.spacing = kSpacing;
  context.region.include(Vec3d::Constant(-0.4));
  context.region.include(Vec3d::Constant(0.4));
  return makeHandling(static_cast<BoundaryHandling>(index), 0, context);
}

GammaSample sampleAt(const PickedGamma& picked, const Vec3f& p) {
  const std::array point{Float4(p)};
  std::array<GammaSample, 1> sample;
  picked.method->evaluate(point, sample);
  return sample[0];
}

double kernelValue(KernelType kernel, double q) {
  return withKernel(
      kernel, [&](auto type) { return static_cast<double>(decltype(type)::value(static_cast<float>(q))); });
}

/// rho/rho0 at a particle of a lattice that fills y > 0, `layer` layers above the floor: fluid alone.
double halfLattice(KernelType kernel, double ratio, int layer) {
  const int reach = static_cast<int>(std::ceil(ratio));
  double sum = 0;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -std::min(layer, reach); y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        sum += kernelValue(kernel, std::sqrt(static_cast<double>(x * x + y * y + z * z)) / ratio);
  return static_cast<double>(restingLattice(kernel, ratio).massRatio) * sum;
}

TEST(Handlings, AreRegisteredAndMakeWhatTheyName) {
  ASSERT_GE(handlingNames().size(), 5U);
  EXPECT_EQ(handlingNames()[0], "gamma");
  EXPECT_EQ(handlingNames()[1], "none");
  const Boundary boundary = floorWall();
  EXPECT_EQ(make("none", boundary).method, nullptr);
  EXPECT_EQ(make("gamma", boundary).name, "product") << "what auto takes for a plane";
  for (const std::string_view name : handlingNames().subspan(2)) {
    const PickedGamma picked = make(name, boundary);
    ASSERT_NE(picked.method, nullptr);
    EXPECT_EQ(picked.name, name);
    EXPECT_FALSE(picked.reason.empty());
  }
}

TEST(WallWeight, ALatticeOnAFlatWallReadsTheDensityAtRest) {
  const Boundary boundary = floorWall();
  for (const KernelType kernel : kKernels) {
    for (const double ratio : {1.7, 2.0, 2.6}) {
      const PickedGamma weight = make("wall_weight", boundary, kernel, static_cast<float>(ratio) * kSpacing);
      ASSERT_EQ(weight.method->form(), WallDensity::added);
      for (int layer = 0; layer < 3; ++layer) {
        const float height = (static_cast<float>(layer) + 0.5F) * kSpacing;
        const double wall = 1 - static_cast<double>(sampleAt(weight, {0.01F, height, 0.02F}).gamma);
        EXPECT_NEAR(halfLattice(kernel, ratio, layer) + wall, 1, 1e-4)
            << "kernel " << static_cast<int>(kernel) << ", ratio " << ratio << ", layer " << layer;
      }
    }
  }
}

TEST(WallWeight, FallsToNothingAtTheSupportRadius) {
  const Boundary boundary = floorWall();
  const PickedGamma weight = make("wall_weight", boundary);
  float before = 0;
  for (float height = 0.005F; height < 0.12F; height += 0.005F) {
    const float gamma = sampleAt(weight, {0, height, 0}).gamma;
    EXPECT_GE(gamma, before);
    before = gamma;
  }
  EXPECT_EQ(before, 1);
}

TEST(Spline, IsThePartOfTheKernelInFrontOfAPlane) {
  // By quadrature: the mass of the kernel beyond distance e is the integral of 2 pi W(s) s (s - e) over s >
  // e.
  const Boundary boundary = floorWall();
  for (const KernelType kernel : kKernels) {
    const PickedGamma spline = make("spline", boundary, kernel);
    ASSERT_EQ(spline.method->form(), WallDensity::divided);
    for (double e = 0.02; e < 1; e += 0.07) {
      const double missing = quadrature::integrate(
          e, 1, 40, [&](double s) { return 2 * std::numbers::pi * kernelValue(kernel, s) * s * (s - e); });
      const double slope = quadrature::integrate(
          e, 1, 40, [&](double s) { return 2 * std::numbers::pi * kernelValue(kernel, s) * s; });
      const GammaSample sample = sampleAt(spline, {0, static_cast<float>(e) * kSupport, 0});
      EXPECT_NEAR(static_cast<double>(sample.gamma), 1 - missing, 3e-4) << e;
      EXPECT_NEAR(static_cast<double>(sample.gradient.y()), slope, 0.015) << e;
      EXPECT_FLOAT_EQ(sample.gradient.x(), 0);
    }
  }
}

TEST(Spline, ErrsAtAnEdgeByWhatTheOtherWallTakes) {
  // The nearest wall alone: 1/2 where the truth is 1/4, as [FM] Eq. 14 has it.
  const Boundary tank(
      Surfaces{std::make_shared<Box>(Vec3d::Zero(), Vec3d::Constant(0.4), Box::Fluid::inside)});
  EXPECT_NEAR(sampleAt(make("spline", tank), {1e-4F, 1e-4F, 0.2F}).gamma, 0.5F, 0.01F);
}

TEST(Particles, AFlatWallHasASquareLatticeAndItsVolumes) {
  // Akinci Eq. 4: V_b = 1 / sum_k W_bk, here over a square lattice a spacing wide.
  ThreadPool pool(1);
  Bounds region;
  region.include(Vec3d(-0.5, -0.1, -0.5));
  region.include(Vec3d(0.5, 0.1, 0.5));
  for (const KernelType kernel : kKernels) {
    const BoundaryParticles particles(sampleWalls(floorWall(), region, kSpacing, 0.5F * kSpacing, pool, ""),
                                      kernel, kSupport, pool);
    double sum = 0;
    for (int z = -2; z <= 2; ++z)
      for (int x = -2; x <= 2; ++x)
        sum += kernelValue(kernel, std::sqrt(static_cast<double>(x * x + z * z)) / 2);
    long inner = 0;
    for (const Float4& b : particles.particles()) {
      EXPECT_NEAR(b.y, -0.5F * kSpacing, 0.02F * kSpacing);
      if (std::max(std::abs(b.x), std::abs(b.z)) > 0.35F) continue;
      EXPECT_NEAR(b.w, 1 / sum, 0.002 / sum);
      ++inner;
    }
    EXPECT_NEAR(static_cast<double>(inner), 196, 15) << "one for every square of a spacing";
  }
}

TEST(Particles, CoverAnySurfaceEvenly) {
  ThreadPool pool(2);
  struct Case {
    const char* name;
    Boundary boundary;
  };
  std::vector<Case> cases;
  cases.push_back({"vessel", Boundary(Surfaces{std::make_shared<Sphere>(Vec3d(0.01, 0.02, 0), 0.31,
                                                                        Sphere::Fluid::inside)})});
  cases.push_back({"turned tank",
                   Boundary(Surfaces{std::make_shared<Box>(Vec3d(-0.2, -0.15, -0.25), Vec3d(0.2, 0.15, 0.25),
                                                           Box::Fluid::inside, Rotation{{1, 2, 3}, 37})})});
  cases.push_back({"ball on a floor",
                   Boundary(Surfaces{std::make_shared<Sphere>(Vec3d(0, 0.1, 0), 0.2, Sphere::Fluid::outside),
                                     std::make_shared<Plane>(Vec3d::Zero(), Vec3d(0, 1, 0))})});
  Bounds region;
  region.include(Vec3d::Constant(-0.4));
  region.include(Vec3d::Constant(0.4));
  for (const Case& at : cases) {
    const std::vector<Vec3f> points = sampleWalls(at.boundary, region, kSpacing, 0.5F * kSpacing, pool, "");
    ASSERT_GT(points.size(), 100U) << at.name;
    for (std::size_t k = 0; k < points.size(); ++k) {
      EXPECT_NEAR(at.boundary.distance(points[k]), -0.5F * kSpacing, 0.03F * kSpacing) << at.name;
      for (std::size_t j = 0; j < k; ++j)
        ASSERT_GE((points[k] - points[j]).norm(), 0.98F * kSpacing) << at.name;
    }
    // Every place of the wall, found from random places near it, has one about as far as a lattice's
    // farthest.
    float farthest = 0;
    for (int k = 0; k < 4000; ++k) {
      const auto part = [k](double by) { return static_cast<float>(std::fmod(k * by, 1.0) * 0.7 - 0.35); };
      Vec3f p(part(0.618034), part(0.754878), part(0.569840)), normal;
      if (const float d = at.boundary.distance(p, normal); std::abs(d) > kSupport) continue;
      for (int move = 0; move < 8; ++move) p -= (at.boundary.distance(p, normal) + 0.5F * kSpacing) * normal;
      if (std::abs(at.boundary.distance(p) + 0.5F * kSpacing) > 0.01F * kSpacing) continue;
      float nearest = 1;
      for (const Vec3f& point : points) nearest = std::min(nearest, (point - p).norm());
      farthest = std::max(farthest, nearest);
    }
    EXPECT_GT(farthest, 0.4F * kSpacing) << at.name;
    EXPECT_LT(farthest, 1.15F * kSpacing) << at.name;
  }
}

TEST(Particles, AThinPlateHasThemMidway) {
  ThreadPool pool(1);
  const Boundary plate(
      Surfaces{std::make_shared<Box>(Vec3d(-0.2, 0.1, -0.2), Vec3d(0.2, 0.12, 0.2), Box::Fluid::outside)});
  Bounds region;
  region.include(Vec3d::Constant(-0.3));
  region.include(Vec3d::Constant(0.3));
  const std::vector<Vec3f> points = sampleWalls(plate, region, kSpacing, 0.5F * kSpacing, pool, "");
  EXPECT_GT(points.size(), 49U);
  for (const Vec3f& p : points) EXPECT_LT(plate.distance(p), 0) << p.transpose();
  long midway = 0;
  for (const Vec3f& p : points) midway += std::abs(p.y() - 0.11F) < 0.003F ? 1 : 0;
  EXPECT_GT(midway, static_cast<long>(points.size() * 3 / 4));
}

/// What a plane of boundary particles adds to the density at a height above it (m).
double planeDensity(const std::vector<Vec3f>& places, float height) {
  ThreadPool pool(1);
  const BoundaryParticles particles(places, KernelType::poly6, kSupport, pool);
  double least = 1e9, most = 0;
  for (const Vec3f& p :
       {Vec3f(0, height, 0), Vec3f(0.013F, height, 0.007F), Vec3f(-0.021F, height, 0.024F)}) {
    double sum = 0;
    particles.around(p, [&](const Vec3f&, float q, float volume) {
      sum += static_cast<double>(volume * Poly6::value(q));
    });
    least = std::min(least, sum), most = std::max(most, sum);
  }
  EXPECT_LT(most, 1.25 * least);
  return 0.5 * (least + most);
}

TEST(Particles, VolumesMakeUpForTheSampling) {
  // Akinci section 3.1: however densely a wall is sampled, it adds the same. In the limit, the integral of W
  // over the plane at a height over that in the plane.
  const auto overPlane = [](double height) {
    return quadrature::integrate(height, 1, 40, [](double s) {
      return 2 * std::numbers::pi * static_cast<double>(Poly6::value(static_cast<float>(s))) * s;
    });
  };
  const double limit = overPlane(0.5) / overPlane(0);
  std::uint32_t bits = 1;
  for (const float pitch : {1.0F, 0.7F, 0.5F, 0.3F}) {
    std::vector<Vec3f> even, uneven;
    const int reach = static_cast<int>(5 / pitch);
    for (int z = -reach; z <= reach; ++z) {
      for (int x = -reach; x <= reach; ++x) {
        const auto jitter = [&bits] {
          bits = bits * 1664525U + 1013904223U;
          return 0.5F * (static_cast<float>(bits >> 8) / 16777216.0F - 0.5F);
        };
        const float dx = jitter(), dz = jitter();
        const float at = pitch * kSpacing;
        even.emplace_back(at * static_cast<float>(x), 0.0F, at * static_cast<float>(z));
        uneven.emplace_back(at * (static_cast<float>(x) + dx), 0.0F, at * (static_cast<float>(z) + dz));
      }
    }
    EXPECT_NEAR(planeDensity(even, kSpacing), limit, 0.1 * limit) << pitch;
    EXPECT_NEAR(planeDensity(uneven, kSpacing), limit, 0.15 * limit) << pitch;
  }
}

TEST(Baselines, GradientsAreThoseOfTheirValues) {
  const Boundary boundary(
      Surfaces{std::make_shared<Sphere>(Vec3d(0.02, 0, 0.01), 0.3, Sphere::Fluid::inside)});
  constexpr float kStep = 1e-3F;
  for (const KernelType kernel : kKernels) {
    for (const std::string_view name : handlingNames().subspan(2)) {
      const PickedGamma picked = make(name, boundary, kernel);
      for (int k = 0; k < 60; ++k) {
        const auto part = [k](double by) { return static_cast<float>(std::fmod(k * by, 1.0) - 0.5); };
        const Vec3f direction = Vec3f(part(0.618034), part(0.754878), part(0.569840)).normalized();
        const Vec3f p =
            Vec3f(0.02F, 0, 0.01F) + (0.3F - kSupport * (0.3F + 0.01F * static_cast<float>(k))) * direction;
        const GammaSample sample = sampleAt(picked, p);
        for (int axis = 0; axis < 3; ++axis) {
          const Vec3f step = kStep * kSupport * Vec3f::Unit(axis);
          const float rise =
              (sampleAt(picked, p + step).gamma - sampleAt(picked, p - step).gamma) / (2 * kStep);
          EXPECT_NEAR(sample.gradient[axis], rise, 0.03F) << name << ", kernel " << static_cast<int>(kernel);
        }
      }
    }
  }
}

TEST(Baselines, FollowAWallThatMoves) {
  const auto plate = [](double lift) {
    auto box = std::make_shared<Box>(Vec3d(-0.2, -0.1 + lift, -0.2), Vec3d(0.2, 0.02 + lift, 0.2),
                                     Box::Fluid::outside);
    return box;
  };
  const auto moving = plate(0);
  moving->motion.emplace();
  moving->motion->velocity = {0, 0.5, 0};
  const auto still = std::make_shared<Sphere>(Vec3d::Zero(), 0.4, Sphere::Fluid::inside);
  Boundary follows(Surfaces{still, moving});
  follows.moveTo(0.1, 0.2);
  for (const std::string_view name : handlingNames().subspan(2)) {
    const PickedGamma picked = make(name, follows);
    // The way has a whole number of tried places, so that the plate is sampled alike where it ends up.
    const Boundary there(Surfaces{still, plate(0.1)});
    const PickedGamma stands = make(name, there);
    for (const Vec3f& p : {Vec3f(0, 0.15F, 0), Vec3f(0.05F, 0.17F, 0.1F), Vec3f(-0.3F, 0.2F, 0)}) {
      const GammaSample a = sampleAt(picked, p), b = sampleAt(stands, p);
      EXPECT_NEAR(a.gamma, b.gamma, name == "particles" ? 0.03F : 1e-5F) << name;
      EXPECT_NEAR(a.distance, b.distance, 1e-5F) << name;
    }
  }
}

}  // namespace baselines_test
}  // namespace migiwa
