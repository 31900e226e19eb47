#include "core/study/pareto.h"

#include <algorithm>
#include <utility>

namespace migiwa {

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  struct Point {
    double cost, error;
    std::size_t index;
  };
  std::vector<Point> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].cost && points[i].error) order.push_back({*points[i].cost, *points[i].error, i});
  std::sort(order.begin(), order.end(), [](const Point& a, const Point& b) {
    return std::pair(a.cost, a.error) != std::pair(b.cost, b.error)
               ? std::pair(a.cost, a.error) < std::pair(b.cost, b.error)
               : a.index < b.index;
  });
  std::vector<std::size_t> front;
  const Point* best = nullptr;  // the last that was taken: by now the most exact
  for (const Point& point : order) {
    const bool same = best != nullptr && point.cost == best->cost && point.error == best->error;
    if (best != nullptr && !same && point.error >= best->error) continue;
    front.push_back(point.index);
    best = &point;
  }
  return front;
}

}  // namespace migiwa
