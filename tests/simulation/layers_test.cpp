// Blocks that touch, whose sizes are no multiples of the spacing: they lie as still as one block does.
#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {
namespace layers_test {

struct Blocks {
  std::vector<double> across, up;  ///< where cuts between them are, and the ends, along x and y (m)
  double offset;                   ///< of the tank and all in it, along every axis (m)
};

struct Watched {
  std::size_t particles = 0;
  double fastest = 0, highest = 0;  ///< (m/s), (m) above the floor
};

Watched watch(const Blocks& blocks) {
  const double o = blocks.offset;
  std::ostringstream text;
  text.precision(12);
  text << R"({ "format": 1, "particle_spacing": 0.05, "fluid": [)";
  for (std::size_t j = 0; j + 1 < blocks.up.size(); ++j)
    for (std::size_t i = 0; i + 1 < blocks.across.size(); ++i)
      text << (i + j > 0 ? "," : "") << R"({ "shape": "box", "min": [)" << o + blocks.across[i] << ", "
           << o + blocks.up[j] << ", " << o << R"(], "max": [)" << o + blocks.across[i + 1] << ", "
           << o + blocks.up[j + 1] << ", " << o + 0.5 << "] }";
  text << R"(], "boundary": { "surfaces": [{ "shape": "box", "fluid": "inside", "min": [)" << o << ", " << o
       << ", " << o << R"(], "max": [)" << o + blocks.across.back() << ", " << o + 2 << ", " << o + 0.5
       << "] }] } }";
  Simulation simulation(parseScene(text.str(), "layers.json"), 1);
  Watched seen;
  while (simulation.time() < 0.4) {
    simulation.advanceFrame();
    const FrameView view = simulation.view();
    seen.particles = view.positions.size();
    for (std::size_t i = 0; i < view.positions.size(); ++i) {
      seen.fastest = std::max<double>(seen.fastest, view.velocities[i].xyz().norm());
      seen.highest = std::max(seen.highest, static_cast<double>(view.positions[i].y) - o);
    }
  }
  return seen;
}

class TouchingBlocks : public ::testing::TestWithParam<Blocks> {};

TEST_P(TouchingBlocks, LieAsStillAsOne) {
  // A lattice that stands in a tank creeps into another order, which is all that moves.
  const Blocks& blocks = GetParam();
  const Watched one = watch({{0, blocks.across.back()}, {0, blocks.up.back()}, blocks.offset});
  const Watched all = watch(blocks);
  EXPECT_EQ(all.particles, one.particles);
  EXPECT_LT(all.fastest, 1.3 * one.fastest);
  EXPECT_LT(all.highest, one.highest + 0.02);
  EXPECT_LT(all.highest, blocks.up.back() + 0.02);
}

INSTANTIATE_TEST_SUITE_P(SizesAndOffsets, TouchingBlocks,
                         ::testing::Values(Blocks{{0, 1}, {0, 0.33, 0.66}, 0},
                                           Blocks{{0, 1}, {0, 0.26, 0.43}, 0.013},
                                           Blocks{{0, 1}, {0, 0.349, 0.649}, -3.3},
                                           Blocks{{0, 1}, {0, 0.12, 0.31, 0.42, 0.6}, 0},
                                           Blocks{{0, 0.47, 1}, {0, 0.33, 0.5}, 0.7},
                                           Blocks{{0, 0.03, 0.22, 0.61, 1}, {0, 0.4}, 0}));

}  // namespace layers_test
}  // namespace migiwa
