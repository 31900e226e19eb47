// The droplet on a plate against the shape that gravity and surface tension give a drop that does not wet:
// the Young-Laplace equation, integrated from the top down (Bashforth & Adams 1883).
#include <numbers>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/support/moments.h"

namespace migiwa {
namespace droplet_scene_test {

struct SessileDrop {
  double volume = 0;  ///< (m^3)
  double height = 0;  ///< (m)
  double centre = 0;  ///< height of the centre of mass above the plate (m)
};

/// Of radius of curvature `top` (m) at its top, with a contact angle of 180 degrees.
SessileDrop sessileDrop(double top, double tension, double density, double gravity) {
  // Along the arc from the top: x from the axis, z down, phi the slope.
  const double step = 1e-4 * top;
  double x = 0, z = 0, phi = 0, moment = 0;
  SessileDrop drop;
  while (phi < std::numbers::pi) {
    const double around = x > 0 ? std::sin(phi) / x : 1 / top;
    const double turn = 2 / top + density * gravity * z / tension - around;
    const double middle = phi + 0.5 * step * turn;
    const double dx = step * std::cos(middle), dz = step * std::sin(middle);
    const double disc = std::numbers::pi * (x + 0.5 * dx) * (x + 0.5 * dx) * dz;
    drop.volume += disc, moment += disc * (z + 0.5 * dz);
    x += dx, z += dz, phi += step * turn;
  }
  drop.height = z;
  drop.centre = z - moment / drop.volume;
  return drop;
}

TEST(DropletScene, ComesToRestInTheShapeOfYoungAndLaplace) {
  const Scene scene = readScene(MIGIWA_SOURCE_DIR "/scenes/droplet.json");
  Simulation simulation(scene);
  while (simulation.time() < 0.4) simulation.advanceFrame();
  ASSERT_FALSE(simulation.stopped());
  const FrameView view = simulation.view();
  const auto n = static_cast<double>(view.positions.size());
  const testing::Moments moments = testing::momentsOf(view);
  EXPECT_LT(moments.momentum.norm() / n, 0.01) << "m/s; it fell at 0.2";

  const double volume = n * std::pow(scene.particleSpacing, 3);
  double low = 1e-4, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double middle = std::sqrt(low * high);
    (sessileDrop(middle, 0.072, 1000, 9.81).volume < volume ? low : high) = middle;
  }
  const SessileDrop expected = sessileDrop(low, 0.072, 1000, 9.81);
  // The first layer's centres stand half a spacing above the plate, as their share of the volume does.
  EXPECT_NEAR(moments.centre.y(), expected.centre, 0.08 * expected.centre);
  EXPECT_NEAR(std::cbrt(3 * volume / (4 * std::numbers::pi)), 0.0035, 0.0001);
  EXPECT_LT(expected.height, 0.9 * 0.007) << "gravity must have flattened it";
}

TEST(DropletScene, SlidesOnWithoutFriction) {
  Scene scene = readScene(MIGIWA_SOURCE_DIR "/scenes/droplet.json",
                          {{"/effects/wall_friction", "{\"coefficient\": 0}"}});
  Simulation simulation(scene);
  while (simulation.time() < 0.1) simulation.advanceFrame();
  const testing::Moments moments = testing::momentsOf(simulation.view());
  EXPECT_NEAR(moments.momentum.x() / static_cast<double>(simulation.view().positions.size()), 0.15, 0.003);
}

}  // namespace droplet_scene_test
}  // namespace migiwa
