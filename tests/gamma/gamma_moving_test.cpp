// gamma of a wall that has moved is gamma of the wall that stands there.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace gamma_moving_test {

constexpr float kSupport = 0.1F;

int methodIndex(std::string_view name) {
  const auto names = gammaMethodNames();
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

PickedGamma make(const Boundary& boundary, std::string_view method) {
  return makeGammaMethod(methodIndex(method), {boundary, KernelType::poly6, kSupport});
}

std::vector<Float4> points(const Boundary& boundary) {
  std::vector<Float4> result;
  for (int k = 0; result.size() < 300 && k < 100000; ++k) {
    const auto part = [k](double by) { return static_cast<float>(std::fmod(k * by, 1.0)); };
    const Vec3f p(part(0.618034), part(0.754878), part(0.569840));
    const float distance = boundary.distance(p);
    if (distance > 0.2F * kSupport && distance < kSupport) result.emplace_back(p);
  }
  return result;
}

/// Largest differences of gamma and of h grad gamma between walls that have moved and walls that stand there.
struct Difference {
  float gamma = 0, gradient = 0;
};
Difference difference(Boundary& moving, const Boundary& there, std::string_view method,
                      std::string_view reference, double time) {
  const PickedGamma follows = make(moving, method), stands = make(there, reference);
  for (const double now : {0.3 * time, 0.7 * time, time}) {
    moving.moveTo(now - 0.01, now);
    follows.method->wallsMoved();
  }
  const std::vector<Float4> at = points(there);
  EXPECT_GT(at.size(), 100U);
  std::vector<GammaSample> a(at.size()), b(at.size());
  follows.method->evaluate(at, a);
  stands.method->evaluate(at, b);
  Difference largest;
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_NEAR(a[k].distance, b[k].distance, 1e-5F);
    largest.gamma = std::max(largest.gamma, std::abs(a[k].gamma - b[k].gamma));
    largest.gradient = std::max(largest.gradient, (a[k].gradient - b[k].gradient).norm());
    largest.gradient = std::max(largest.gradient, (a[k].pairGradient - b[k].pairGradient).norm());
  }
  return largest;
}

std::shared_ptr<const Surface> tank() {
  return std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(1, 1, 1), Box::Fluid::inside);
}

TEST(GammaOfMovingWalls, PistonHasThatOfOneThatStandsThere) {
  Motion push;
  push.velocity = {0.4, 0, 0};
  const auto block = [](double face) {
    return std::make_shared<Box>(Vec3d(face - 1, -0.5, -0.5), Vec3d(face, 1.5, 1.5), Box::Fluid::outside);
  };
  for (const auto* const method : {"auto", "product", "copula", "directions", "mean", "nearest"}) {
    SCOPED_TRACE(method);
    const auto piston = block(0);
    piston->motion = push;
    Boundary moving({tank(), piston});
    const Boundary there({tank(), block(0.2)});
    const Difference found = difference(moving, there, method, method, 0.5);
    EXPECT_LT(found.gamma, 2e-5F);
    EXPECT_LT(found.gradient, 2e-4F);
  }
}

TEST(GammaOfMovingWalls, PlanesThatMoveKeepTheirClosedForms) {
  Motion sway;
  sway.oscillates = true;
  sway.amplitude = {0.1, 0, 0};
  sway.period = 2;
  const auto plane = std::make_shared<Plane>(Vec3d(0.2, 0, 0), Vec3d(1, 0, 0));
  plane->motion = sway;
  Boundary moving({tank(), plane});
  const Boundary there({tank(), std::make_shared<Plane>(Vec3d(0.3, 0, 0), Vec3d(1, 0, 0))});
  EXPECT_EQ(make(moving, "auto").name, "product");
  const Difference found = difference(moving, there, "auto", "auto", 0.5);
  EXPECT_LT(found.gamma, 1e-5F);
  EXPECT_LT(found.gradient, 1e-4F);
}

TEST(GammaOfMovingWalls, ABlockThatTurnsHasThatOfOneTurned) {
  Motion turn;
  turn.turns = true;
  turn.axis = {1, 2, 3};
  turn.point = {0.5, 0.5, 0.5};
  turn.degreesPerSecond = 70;
  const auto block = [](double degrees) {
    return std::make_shared<Box>(Vec3d(0.35, 0.3, 0.4), Vec3d(0.65, 0.7, 0.6), Box::Fluid::outside,
                                 Rotation{{1, 2, 3}, degrees});
  };
  const auto turning = block(0);
  turning->motion = turn;
  Boundary moving({tank(), turning});
  const Boundary there({tank(), block(35)});
  const Difference found = difference(moving, there, "auto", "auto", 0.5);
  EXPECT_LT(found.gamma, 2e-5F);
  EXPECT_LT(found.gradient, 2e-4F);
}

TEST(GammaOfMovingWalls, ABallAsksItsGridInItsOwnFrame) {
  Motion motion;
  motion.velocity = {0.2, 0.1, 0};
  motion.turns = true;
  motion.axis = {0, 1, 0};
  motion.point = {0.4, 0.4, 0.5};
  motion.degreesPerSecond = 100;
  const auto ball = std::make_shared<Sphere>(Vec3d(0.4, 0.4, 0.5), 0.25, Sphere::Fluid::outside);
  ball->motion = motion;
  // It has come near to the floor's edge, so that some points see the tank, too.
  motion.velocity = {-0.22, -0.22, 0};
  ball->motion = motion;
  Boundary moving({tank(), ball});
  const Boundary there(
      {tank(), std::make_shared<Sphere>(Vec3d(0.29, 0.29, 0.5), 0.25, Sphere::Fluid::outside)});
  const PickedGamma picked = make(moving, "auto");
  EXPECT_NE(picked.name.find("baked"), std::string::npos) << picked.name;
  // A sphere looks the same however it is turned: many directions say what is right.
  const Difference found = difference(moving, there, "auto", "directions", 0.5);
  EXPECT_LT(found.gamma, 0.006F);
  EXPECT_LT(found.gradient, 0.05F);
}

}  // namespace gamma_moving_test
}  // namespace migiwa
