// The neighbour search against brute force.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/sph/neighbours.h"

namespace migiwa {
namespace neighbour_search_test {

using Cloud = std::vector<Float4>;

struct Found {
  Cloud sorted;
  std::vector<std::uint32_t> order;
  std::vector<std::vector<std::uint32_t>> lists;
};

Found find(const Cloud& cloud, float radius, int threads) {
  ThreadPool pool(threads);
  CellGrid grid;
  grid.build(cloud, radius, pool);
  Found found;
  found.order = grid.order();
  for (const std::uint32_t i : found.order) found.sorted.push_back(cloud.at(i));
  NeighbourLists lists;
  lists.build(grid, found.sorted, radius, pool);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto list = lists.of(i);
    EXPECT_EQ(lists.counts()[i], list.size());
    found.lists.emplace_back(list.begin(), list.end());
  }
  return found;
}

double squaredDistance(const Float4& a, const Float4& b) {
  const double x = static_cast<double>(a.x) - static_cast<double>(b.x);
  const double y = static_cast<double>(a.y) - static_cast<double>(b.y);
  const double z = static_cast<double>(a.z) - static_cast<double>(b.z);
  return x * x + y * y + z * z;
}

/// Every pair, in double. A pair whose distance is the radius but for rounding may be in or out: W is zero
/// there.
void expectBruteForce(const Found& found, float radius) {
  const double r2 = static_cast<double>(radius) * static_cast<double>(radius);
  for (std::size_t i = 0; i < found.sorted.size(); ++i) {
    const std::set<std::uint32_t> list(found.lists[i].begin(), found.lists[i].end());
    ASSERT_EQ(list.size(), found.lists[i].size()) << "a neighbour of " << i << " is listed twice";
    for (std::uint32_t j = 0; j < found.sorted.size(); ++j) {
      const double d2 = squaredDistance(found.sorted[i], found.sorted[j]);
      const bool listed = list.contains(j);
      if (j == i) {
        ASSERT_FALSE(listed) << i << " is its own neighbour";
      } else if (d2 < r2 * (1 - 1e-6)) {
        ASSERT_TRUE(listed) << i << " and " << j << " at " << std::sqrt(d2) << ", radius " << radius;
      } else if (d2 > r2 * (1 + 1e-6)) {
        ASSERT_FALSE(listed) << i << " and " << j << " at " << std::sqrt(d2) << ", radius " << radius;
      }
    }
  }
}

void expectPermutation(const Found& found) {
  std::vector<std::uint32_t> sorted = found.order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
}

void check(const Cloud& cloud, float radius) {
  const Found found = find(cloud, radius, 3);
  ASSERT_EQ(found.order.size(), cloud.size());
  expectPermutation(found);
  expectBruteForce(found, radius);
}

Cloud randomCloud(std::size_t n, const Vec3f& size, const Vec3f& origin = Vec3f::Zero()) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f u(unit(random), unit(random), unit(random));
    cloud.emplace_back(Vec3f(origin + u.cwiseProduct(size)));
  }
  return cloud;
}

TEST(NeighbourSearch, RandomCloud) {
  check(randomCloud(2500, Vec3f(1, 0.8F, 0.6F)), 0.1F);
}

TEST(NeighbourSearch, CloudAwayFromTheOrigin) {
  check(randomCloud(1500, Vec3f(1, 1, 1), Vec3f(-300, 70, 0.5F)), 0.13F);
}

TEST(NeighbourSearch, LatticeWithNeighboursExactlyAtTheRadius) {
  Cloud cloud;
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 11; ++x)
        cloud.emplace_back(0.025F + 0.05F * static_cast<float>(x), 0.025F + 0.05F * static_cast<float>(y),
                           0.025F + 0.05F * static_cast<float>(z));
  check(cloud, 0.1F);
}

TEST(NeighbourSearch, NoParticles) {
  check({}, 0.1F);
}

TEST(NeighbourSearch, OneParticleHasNoNeighbours) {
  const Found found = find({Float4(3, -4, 5)}, 0.1F, 2);
  EXPECT_TRUE(found.lists.at(0).empty());
}

TEST(NeighbourSearch, CoincidentParticlesAreNeighbours) {
  Cloud cloud = randomCloud(300, Vec3f(1, 1, 1));
  for (int i = 0; i < 20; ++i) cloud.push_back(cloud[5]);
  check(cloud, 0.2F);
}

TEST(NeighbourSearch, AFlatSheetAndALine) {
  check(randomCloud(1500, Vec3f(3, 0, 2)), 0.1F);
  check(randomCloud(1500, Vec3f(0, 5, 0)), 0.01F);
}

TEST(NeighbourSearch, SpreadSoThinThatCellsWouldOutnumberParticles) {
  Cloud cloud = randomCloud(800, Vec3f(1000, 1000, 1000));
  for (int i = 0; i < 200; ++i) {
    Float4 close = cloud[static_cast<std::size_t>(i)];
    close.x += 0.04F;
    cloud.push_back(close);
  }
  check(cloud, 0.1F);
}

TEST(NeighbourSearch, AChannelThousandsOfCellsLong) {
  // Far along the grid a coordinate in cells has few digits left; pairs just inside the radius must still be
  // found.
  const float radius = 0.01F;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> gap(0.99F * radius, 0.99999F * radius);
  Cloud cloud;
  double x = 0;
  for (int i = 0; i < 4000; ++i) {
    cloud.emplace_back(static_cast<float>(x), 0.0F, 0.0F);
    x += static_cast<double>(gap(random));
  }
  check(cloud, radius);
}

TEST(NeighbourSearch, ParticlesOfACellKeepTheirOrder) {
  const Cloud cloud(50, Float4(1, 2, 3));
  ThreadPool pool(2);
  CellGrid grid;
  grid.build(cloud, 0.1F, pool);
  for (std::uint32_t i = 0; i < 50; ++i) EXPECT_EQ(grid.order()[i], i);
}

TEST(NeighbourSearch, IsTheSameForAnyNumberOfThreads) {
  const Cloud cloud = randomCloud(4000, Vec3f(1, 1, 1));
  const Found one = find(cloud, 0.12F, 1);
  for (const int threads : {2, 3, 8}) {
    const Found many = find(cloud, 0.12F, threads);
    EXPECT_EQ(many.order, one.order) << threads;
    EXPECT_EQ(many.lists, one.lists) << threads;
  }
}

TEST(NeighbourSearch, CanBeUsedAgainForAnotherCloud) {
  ThreadPool pool(2);
  CellGrid grid;
  NeighbourLists lists;
  for (const std::size_t n : {std::size_t{2000}, std::size_t{0}, std::size_t{3}, std::size_t{900}}) {
    const Cloud cloud = randomCloud(n, Vec3f(1, 1, 1));
    grid.build(cloud, 0.2F, pool);
    Cloud sorted;
    for (const std::uint32_t i : grid.order()) sorted.push_back(cloud.at(i));
    lists.build(grid, sorted, 0.2F, pool);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (i != j && squaredDistance(sorted[i], sorted[j]) < 0.04) ++expected;
    std::size_t listed = 0;
    for (std::size_t i = 0; i < n; ++i) listed += lists.of(i).size();
    EXPECT_EQ(listed, expected) << n;
  }
}

}  // namespace neighbour_search_test
}  // namespace migiwa
