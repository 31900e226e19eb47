// The table of sheets, and the values on the grid against a sum over all particles.
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/surface/cell.h"
#include "core/surface/grid.h"
#include "core/walls/shapes.h"

namespace migiwa::surface {
namespace cells_test {

/// The corners of a cell that are joined along edges, on one side.
int partsOf(int config, bool water) {
  std::set<int> left;
  for (int corner = 0; corner < kCorners; ++corner)
    if (inside(config, corner) == water) left.insert(corner);
  int parts = 0;
  while (!left.empty()) {
    ++parts;
    std::vector<int> open{*left.begin()};
    left.erase(left.begin());
    while (!open.empty()) {
      const int corner = open.back();
      open.pop_back();
      for (int axis = 0; axis < 3; ++axis)
        if (left.erase(corner ^ 1 << axis) != 0) open.push_back(corner ^ 1 << axis);
    }
  }
  return parts;
}

TEST(CellSheets, EdgesThatLeaveTheWaterHaveOneAndNoOthers) {
  for (int config = 0; config < 256; ++config) {
    std::map<int, int> edges;
    for (int edge = 0; edge < kEdges; ++edge) {
      const int sheet = kSheets.of[static_cast<std::size_t>(config)][static_cast<std::size_t>(edge)];
      const int lower = lowerEnd(edge), upper = lower | 1 << edge / 4;
      EXPECT_EQ(edgeAt(edge / 4, lower), edge);
      EXPECT_EQ(inside(config, lower) != inside(config, upper), sheet != kNoSheet) << config << ' ' << edge;
      if (sheet != kNoSheet) ++edges[sheet];
    }
    const int count = kSheets.count[static_cast<std::size_t>(config)];
    EXPECT_EQ(edges.size(), static_cast<std::size_t>(count)) << config;
    for (const auto& [sheet, number] : edges) {
      EXPECT_LT(sheet, count);
      EXPECT_GE(number, 3) << config;
    }
  }
}

TEST(CellSheets, CornersInTheWaterAreApartWhereAFaceLeavesTheChoice) {
  // Water parts that no edge joins have sheets of their own, so there are no fewer sheets than parts of
  // either side would need: a tunnel through a cell joins parts of the air, never of the water.
  for (int config = 1; config < 255; ++config) {
    const int sheets = kSheets.count[static_cast<std::size_t>(config)];
    EXPECT_GE(sheets, partsOf(config, true)) << config;
    EXPECT_LE(sheets, 4) << config;
  }
  EXPECT_EQ(kSheets.count[0b01101001], 4);  // four corners, none beside another
  EXPECT_EQ(kSheets.count[0b10000001], 2);
  EXPECT_EQ(kSheets.count[0b11111110], 1);
}

TEST(SurfaceGrid, HoldsTheSumOverAllParticlesOverGamma) {
  constexpr float kSupport = 0.1F;
  const Box tank({0, 0, 0}, {0.5, 0.5, 0.5}, Box::Fluid::inside);
  std::vector<std::shared_ptr<const Surface>> surfaces{std::make_shared<Box>(tank)};
  const Boundary boundary(surfaces);
  ThreadPool pool(2);
  for (const KernelType kernel :
       {KernelType::poly6, KernelType::spiky, KernelType::cubicSpline, KernelType::wendlandC2}) {
    const PickedGamma gamma = makeGammaMethod(0, {boundary, kernel, kSupport});
    std::vector<Float4> positions;
    for (int k = 0; k < 300; ++k)
      positions.emplace_back(0.025F + 0.44F * static_cast<float>(k * 7 % 31) / 31,
                             0.025F + 0.4F * static_cast<float>(k * 11 % 37) / 37,
                             0.025F + 0.45F * static_cast<float>(k) / 300,
                             0.01F * static_cast<float>(1 + k % 3));
    SortedParticles particles;
    particles.kernel = kernel, particles.supportRadius = kSupport;
    particles.cells.build(positions, kSupport, pool);
    for (const std::uint32_t k : particles.cells.order()) particles.positions.push_back(positions[k]);
    const Grid grid(particles, {&boundary, gamma.method.get()}, 0.05, 0.025, "here", pool);
    long nodes = 0;
    for (const Block& block : grid.blocks()) {
      for (int n = 0; n < Block::kNodes; n += 5) {
        const Vec3d p = grid.place(block, n % Block::kSide, n / Block::kSide % Block::kSide,
                                   n / Block::kSide / Block::kSide);
        if (block.label[static_cast<std::size_t>(n)] == Label::solid) {
          EXPECT_TRUE((p.array() <= 0).any() || (p.array() >= 0.5).any());
          continue;
        }
        double sum = 0;
        for (const Float4& particle : positions) {
          const double q = (particle.xyz().cast<double>() - p).norm() / double{kSupport};
          sum += static_cast<double>(particle.w) * withKernel(kernel, [&](auto type) {
                   return static_cast<double>(decltype(type)::value(static_cast<float>(q)));
                 });
        }
        const std::array<Float4, 1> point{Float4(p.cast<float>())};
        std::array<GammaSample, 1> sample;
        gamma.method->evaluate(point, sample);
        if (sum < 0.03) continue;
        EXPECT_NEAR(static_cast<double>(block.value[static_cast<std::size_t>(n)]) + 0.5,
                    sum / static_cast<double>(sample[0].gamma), 2e-5 * (1 + sum));
        ++nodes;
      }
    }
    EXPECT_GT(nodes, 300);
  }
}

}  // namespace cells_test
}  // namespace migiwa::surface
