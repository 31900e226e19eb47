// The front against its definition, applied to every pair.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/study/study.h"

namespace migiwa {
namespace pareto_test {

std::vector<std::size_t> byDefinition(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CostAndError& own = points[i];
    if (!own.cost || !own.error) continue;
    const bool beaten = std::any_of(points.begin(), points.end(), [&](const CostAndError& other) {
      if (!other.cost || !other.error) return false;
      return *other.cost <= *own.cost && *other.error <= *own.error &&
             (*other.cost < *own.cost || *other.error < *own.error);
    });
    if (!beaten) front.push_back(i);
  }
  return front;
}

TEST(ParetoFront, IsWhatNoOtherBeats) {
  std::mt19937 random(7);
  // Few values, so that many are equal in one or in both.
  std::uniform_int_distribution<int> value(0, 9), gap(0, 15);
  for (int round = 0; round < 300; ++round) {
    std::vector<CostAndError> points(static_cast<std::size_t>(1 + round % 25));
    for (CostAndError& point : points) {
      if (gap(random) > 0) point.cost = value(random);
      if (gap(random) > 0) point.error = value(random);
    }
    std::vector<std::size_t> found = paretoFront(points);
    for (std::size_t k = 1; k < found.size(); ++k)
      EXPECT_LE(*points[found[k - 1]].cost, *points[found[k]].cost);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, byDefinition(points));
  }
}

TEST(ParetoFront, OfNothingIsEmpty) {
  EXPECT_TRUE(paretoFront({}).empty());
  EXPECT_TRUE(paretoFront({{std::nullopt, 1.0}, {1.0, std::nullopt}}).empty());
}

}  // namespace pareto_test
}  // namespace migiwa
