// Everything at once: valid scenes drawn at random, 50 frames of each. The seeds are fixed.
#include <cstdlib>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "tests/hard_cases/hard_case.h"

namespace migiwa::testing {
namespace random_scene_test {

/// Draws scene files. Only the engine's bits are used, for distributions differ between libraries.
class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : engine_(seed) {}

  std::string text() {
    std::ostringstream out;
    out << R"({ "format": 1, "particle_spacing": 0.05, "gravity": )" << vector(-15, 15) << R"(, "fluid": [)";
    const int sources = whole(1, 3);
    for (int k = 0; k < sources; ++k) out << (k > 0 ? ", " : "") << source();
    out << R"(], "boundary": { "gamma": { "method": ")"
        << pick({"auto", "product", "copula", "mean", "nearest"})
        << R"(" }, "surfaces": [{ "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 1])"
        << rotation() << " }";
    const int obstacles = whole(0, 3);
    for (int k = 0; k < obstacles; ++k) out << ", " << obstacle();
    out << R"(] }, "solver": { "time_step": )" << pick({"0.001", "0.005", "0.02", "0.1"})
        << R"(, "min_iterations": 1, "max_iterations": )" << whole(1, 20) << R"(, "tolerance": )"
        << pick({"0", "0.01", "0.1"}) << R"(, "kernel": ")"
        << pick({"poly6", "spiky", "cubic_spline", "wendland_c2"}) << R"(", "position_step": ")"
        << pick({"gradient", "pairs_and_wall", "paper"}) << R"(", "acceleration": ")"
        << pick({"chebyshev", "none"}) << R"(" }, "effects": { "viscosity": { "xsph": )"
        << pick({"0", "0.05", "0.5"}) << " } } }";
    return out.str();
  }

 private:
  double number(double least, double most) {
    return least + (most - least) * static_cast<double>(engine_()) / 4294967296.0;
  }
  int whole(int least, int most) { return least + static_cast<int>(number(0, most - least + 0.999)); }
  std::string pick(const std::vector<std::string>& from) {
    return from[static_cast<std::size_t>(whole(0, static_cast<int>(from.size()) - 1))];
  }
  std::string vector(double least, double most) {
    std::ostringstream out;
    const double x = number(least, most), y = number(least, most), z = number(least, most);
    out << "[" << x << ", " << y << ", " << z << "]";
    return out.str();
  }
  std::string box(double largest) {
    std::ostringstream min, max;
    for (int axis = 0; axis < 3; ++axis) {
      const double from = number(0, 0.9), size = number(0.06, largest);
      min << (axis > 0 ? ", " : "") << from;
      max << (axis > 0 ? ", " : "") << from + size;
    }
    return R"("min": [)" + min.str() + R"(], "max": [)" + max.str() + "]";
  }
  std::string rotation() {
    std::ostringstream out;
    if (whole(0, 1) == 1)
      out << R"(, "rotation": { "axis": )" << vector(0.1, 1) << R"(, "degrees": )" << number(-180, 180)
          << " }";
    return out.str();
  }
  std::string source() {
    return R"({ "shape": "box", )" + box(0.4) + R"(, "velocity": )" + vector(-20, 20) + R"(, "trim": )" +
           pick({"true", "false"}) + " }";
  }
  std::string obstacle() {
    std::ostringstream out;
    switch (whole(0, 2)) {
      case 0:
        out << R"({ "shape": "box", "fluid": "outside", )" << box(0.3) << rotation() << " }";
        break;
      case 1:
        out << R"({ "shape": "sphere", "fluid": "outside", "center": )" << vector(0.1, 0.9)
            << R"(, "radius": )" << number(0.03, 0.25) << " }";
        break;
      default:
        out << R"({ "shape": "plane", "point": )" << vector(0, 0.2) << R"(, "normal": )" << vector(0.05, 1)
            << " }";
    }
    return out.str();
  }

  std::mt19937 engine_;
};

/// Scenes drawn: those of `./run test`, or as many as MIGIWA_RANDOM_SCENES says.
unsigned sceneCount() {
  const char* const wanted = std::getenv("MIGIWA_RANDOM_SCENES");
  return wanted != nullptr ? static_cast<unsigned>(std::stoul(wanted)) : 40U;
}

class RandomScenes : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomScenes, KeepEveryInvariant) {
  const std::string text = RandomScene(GetParam()).text();
  SCOPED_TRACE(text);
  const Scene scene = parseScene(text, "random.json");
  const double until = 50 * scene.solver.timeStep;
  const Observed seen = observe(scene, until, 1);
  EXPECT_EQ(seen.nonfinite, 0);
  EXPECT_EQ(seen.lost, 0);
  EXPECT_LE(seen.penetration, 1e-6);
  // What starts in walls or on top of other fluid is moved first, so energy counts from there.
  EXPECT_LE(seen.energyGain, seen.energyBound);
  EXPECT_EQ(observe(scene, until, 3).hash, seen.hash) << "with 3 threads";
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenes, ::testing::Range(1U, 1U + sceneCount()));

}  // namespace random_scene_test
}  // namespace migiwa::testing
