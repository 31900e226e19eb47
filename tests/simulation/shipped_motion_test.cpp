// The shipped scenes with walls that move and with emitters, held against what physics says of them.
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {
namespace shipped_motion_test {

Scene shipped(const std::string& name, const std::vector<Override>& overrides = {}) {
  return readScene(MIGIWA_SOURCE_DIR "/scenes/" + name + ".json", overrides);
}

/// Wave number (1/m) of waves with this period on water of this depth: w^2 = g k tanh(k d), by Newton.
double waveNumber(double period, double depth) {
  const double w2 = std::pow(2 * std::numbers::pi / period, 2), g = 9.81;
  double k = w2 / g;
  for (int round = 0; round < 50; ++round) {
    const double t = std::tanh(k * depth);
    k -= (g * k * t - w2) / (g * t + g * k * depth * (1 - t * t));
  }
  return k;
}

/// Depth of water (m) at a place along the channel, by the volume of the particles about it.
double depthAt(const FrameView& view, double x, double spacing, double width) {
  constexpr double kHalf = 0.08;
  double volume = 0;
  for (const Float4& p : view.positions)
    if (std::abs(static_cast<double>(p.x) - x) < kHalf) volume += std::pow(spacing, 3);
  return volume / (2 * kHalf * width);
}

TEST(WaveMachine, WavesTravelAtTheSpeedOfLinearTheory) {
  const Scene scene = shipped("wave_machine");
  const Motion& motion = *scene.surfaces.at(1)->motion;
  const double period = motion.period, w = 2 * std::numbers::pi / period, depth = 0.4;
  Simulation simulation(scene, 2);
  // Whole periods, after the waves have come and before they are back from the beach.
  const std::vector<double> places{1.0, 1.25, 1.5, 1.75, 2.0};
  std::vector<std::complex<double>> component(places.size());
  const double from = 2 * period, to = 4 * period;
  int samples = 0;
  while (simulation.time() < to - 1e-9) {
    simulation.advanceFrame();
    if (simulation.time() <= from + 1e-9) continue;
    ++samples;
    for (std::size_t k = 0; k < places.size(); ++k)
      component[k] += depthAt(simulation.view(), places[k], scene.particleSpacing, 0.4) *
                      std::polar(1.0, -w * simulation.time());
  }
  EXPECT_FALSE(simulation.statistics().failed());
  // cos(w t - k x): the phase falls by k from metre to metre.
  double sum = 0;
  for (std::size_t k = 1; k < places.size(); ++k) sum -= std::arg(component[k] / component[k - 1]);
  const double measured = sum / (places.back() - places.front());
  EXPECT_NEAR(measured, waveNumber(period, depth), 0.1 * waveNumber(period, depth))
      << "speed " << w / measured << " m/s instead of " << w / waveNumber(period, depth);
  // A piston of stroke S makes waves of height S 2 (cosh 2kd - 1) / (sinh 2kd + 2kd) (Dean & Dalrymple 1991).
  // They lose nothing in theory. Here a part is missing from the beginning, and little on the way: the height
  // falls as exp(-slope x), by least squares.
  const double kd = waveNumber(period, depth) * depth;
  const double ratio = 2 * (std::cosh(2 * kd) - 1) / (std::sinh(2 * kd) + 2 * kd);
  const double amplitude = 2 * std::abs(component[0]) / samples;
  EXPECT_LT(amplitude, 1.05 * ratio * motion.amplitude.x());
  EXPECT_GT(amplitude, 0.65 * ratio * motion.amplitude.x());
  const double middle = 0.5 * (places.front() + places.back());
  double slope = 0, square = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    slope -= (places[k] - middle) * std::log(std::abs(component[k]));
    square += (places[k] - middle) * (places[k] - middle);
  }
  const double lost = 1 - std::exp(-slope / square);
  EXPECT_LT(lost, 0.2) << "lost a metre";
  RecordProperty("amplitude", std::to_string(amplitude) + " m at 1 m, lost a metre " + std::to_string(lost));
  RecordProperty("speed", std::to_string(w / measured) + " m/s, linear theory " +
                              std::to_string(w / waveNumber(period, depth)));
}

TEST(StirredTank, TurnsWithThePlateAndComesToRestAfterIt) {
  const Scene scene = shipped("stirred_tank", {{"/boundary/surfaces/1/motion/stop", "1.5"}});
  Simulation simulation(scene, 2);
  const auto momentum = [&] {
    const FrameView view = simulation.view();
    double sum = 0;
    for (std::size_t i = 0; i < view.positions.size(); ++i) {
      const Vec3d r = view.positions[i].xyz().cast<double>() - Vec3d(0.625, 0, 0.625);
      sum += r.cross(Vec3d(view.velocities[i].xyz().cast<double>())).y();
    }
    return sum / static_cast<double>(view.positions.size());
  };
  double before = 0;
  for (int k = 0; k < 3; ++k) {
    while (simulation.time() < 0.5 * (k + 1) - 1e-9) simulation.advanceFrame();
    EXPECT_GT(momentum(), before) << "the plate adds to it, at " << simulation.time() << " s";
    before = momentum();
  }
  // Rigid rotation of a square of this side: w a^2 / 6.
  EXPECT_LT(before, 150 * std::numbers::pi / 180 * 1.25 * 1.25 / 6);
  while (simulation.time() < 2.5) simulation.advanceFrame();
  EXPECT_LT(momentum(), 0.5 * before) << "a plate that stands brakes";
  EXPECT_FALSE(simulation.statistics().failed());
  EXPECT_EQ(simulation.statistics().maxPenetration, 0);
}

TEST(Faucet, FillsTheGlassAtItsRate) {
  // Coarser than shipped. The jet is let run out and the water come to rest.
  const Scene scene = shipped("faucet", {{"/particle_spacing", "0.0045"}});
  const Emitter& emitter = scene.emitters.at(0);
  const double spacing = scene.particleSpacing, cell = std::pow(spacing, 3);
  const double layer = emitter.area() * mouthLayer(emitter, spacing).thickness;
  Simulation simulation(scene, 2);
  const auto volume = [&] { return static_cast<double>(simulation.view().positions.size()) * cell; };
  for (const double time : {0.5, 1.0, 2.0, 3.0}) {
    while (simulation.time() < time - 1e-9) simulation.advanceFrame();
    EXPECT_NEAR(volume(), time * emitter.rate, 1.01 * layer) << "at " << time << " s";
  }
  while (simulation.time() < 4.5 - 1e-9) simulation.advanceFrame();
  EXPECT_NEAR(volume(), emitter.stop * emitter.rate, 1.01 * layer);
  EXPECT_FALSE(simulation.statistics().failed());
  EXPECT_LT(simulation.statistics().maxPenetration, 1e-3 * spacing);

  // All of it in the glass, a cylinder on half a ball, both of the inner radius: there a volume has one
  // level.
  const double radius = 0.039 - 0.004, ball = 2 * std::numbers::pi * std::pow(radius, 3) / 3;
  const double section = std::numbers::pi * radius * radius, level = (volume() - ball) / section;
  double sum = 0, top = 0;
  for (const Float4& p : simulation.view().positions) {
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y), z = static_cast<double>(p.z);
    EXPECT_LT(y > 0 ? std::hypot(x, z) : std::hypot(x, y, z), radius) << "outside of the glass";
    sum += y;
    top = std::max(top, y);
  }
  // Half a ball has its centre of mass 3/8 of the radius below its top.
  const double expected = (section * level * level / 2 - ball * 3 * radius / 8) / volume();
  EXPECT_NEAR(sum * cell / volume(), expected, 0.35 * spacing);
  EXPECT_NEAR(top + 0.5 * spacing, level, spacing);
}

}  // namespace shipped_motion_test
}  // namespace migiwa
