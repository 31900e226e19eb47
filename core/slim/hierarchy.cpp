#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/base/math.h"
#include "core/slim/fit.h"
#include "core/slim/node.h"
#include "core/slim/points.h"

namespace migiwa {

namespace {

/// Pairs are merged in rounds; in each of them only those that err at most so many times as much as the best.
constexpr float kRound = 1.25F;

class Merging {
 public:
  Merging(const OrientedPoints& points, const std::vector<SlimNode>& nodes, int degree, ThreadPool& pool)
      : levels_(points.points), degree_(degree), pool_(pool) {
    Bounds bounds;
    for (const OrientedPoint& point : points.points) bounds.include(point.position.cast<double>());
    largest_ = static_cast<float>(kLargestSlimRadius * bounds.size().norm());
    start(nodes);
  }

  SlimHierarchy run() {
    while (const std::optional<float> least = leastError()) {
      const float limit = kRound * *least;
      while (mergeMutual(limit)) {
      }
    }
    return std::move(hierarchy_);
  }

 private:
  /// A pair of neighbours and the ball that both would become.
  struct Candidate {
    std::uint32_t first, second;
    bool valid = false;
    SlimNode node;
  };
  struct Cluster {
    bool active = true;
    float error = 0;
    std::vector<std::uint32_t> points;
    Extremes extremes;
    std::vector<std::uint32_t> neighbours;  ///< numbers of active clusters, ascending
    std::vector<std::uint32_t> candidates;  ///< valid ones, as places in candidates_
  };

  /// Gives every point to the ball in which it lies deepest; balls whose cores share a point are neighbours.
  void start(const std::vector<SlimNode>& nodes) {
    const auto points = levels_.points();
    clusters_.resize(nodes.size());
    constexpr std::uint32_t kNobody = ~std::uint32_t{0};
    std::vector<std::uint32_t> owner(points.size(), kNobody), reached;
    std::vector<float> depth(points.size(), std::numeric_limits<float>::infinity());
    const auto eachCore = [&](const auto& body) {
      for (std::uint32_t k = 0; k < nodes.size(); ++k) {
        levels_.withinAll(nodes[k].centre, kSlimCore * nodes[k].radius, reached);
        for (const std::uint32_t index : reached) body(k, index);
      }
    };
    eachCore([&](std::uint32_t k, std::uint32_t index) {
      const float t = (points[index].position - nodes[k].centre).norm() / nodes[k].radius;
      if (t < depth[index]) depth[index] = t, owner[index] = k;
    });
    eachCore([&](std::uint32_t k, std::uint32_t index) {
      if (owner[index] == k) return;
      clusters_[k].neighbours.push_back(owner[index]);
      clusters_[owner[index]].neighbours.push_back(k);
    });
    for (std::uint32_t index = 0; index < points.size(); ++index)
      if (owner[index] != kNobody) clusters_[owner[index]].points.push_back(index);
    std::vector<Candidate> pairs;
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
      Cluster& cluster = clusters_[k];
      cluster.error = nodes[k].error;
      for (const std::uint32_t index : cluster.points) cluster.extremes.include(points[index].position);
      std::sort(cluster.neighbours.begin(), cluster.neighbours.end());
      cluster.neighbours.erase(std::unique(cluster.neighbours.begin(), cluster.neighbours.end()),
                               cluster.neighbours.end());
      for (const std::uint32_t other : cluster.neighbours)
        if (k < other) pairs.push_back({k, other, false, {}});
    }
    evaluate(std::move(pairs));
  }

  void evaluate(std::vector<Candidate> pairs) {
    constexpr std::size_t kAtATime = 8;
    pool_.run((pairs.size() + kAtATime - 1) / kAtATime, [&](std::size_t chunk) {
      std::vector<std::uint32_t> indices;
      const std::size_t end = std::min(pairs.size(), (chunk + 1) * kAtATime);
      for (std::size_t k = chunk * kAtATime; k < end; ++k) evaluate(pairs[k], indices);
    });
    for (Candidate& pair : pairs) {
      if (!pair.valid) continue;
      for (const std::uint32_t k : {pair.first, pair.second})
        clusters_[k].candidates.push_back(static_cast<std::uint32_t>(candidates_.size()));
      candidates_.push_back(std::move(pair));
    }
  }

  void evaluate(Candidate& pair, std::vector<std::uint32_t>& indices) const {
    const Cluster &a = clusters_[pair.first], &b = clusters_[pair.second];
    if (a.points.empty() || b.points.empty()) return;
    Extremes extremes = a.extremes;
    extremes.include(b.extremes);
    const Vec3f centre = extremes.centre();
    float squared = 0;
    for (const Cluster* cluster : {&a, &b})
      for (const std::uint32_t index : cluster->points)
        squared = std::max(squared, (levels_.points()[index].position - centre).squaredNorm());
    // A little more than needed: nothing must drop out of the core by rounding.
    const float radius = 1.0001F / kSlimCore * std::sqrt(squared);
    if (!(radius > 0) || radius > largest_) return;
    levels_.within(centre, radius, wantedPoints(degree_), indices);
    const LocalFit fit = fitLocally(levels_.points(), indices, centre, radius, degree_);
    if (!fit.valid) return;
    pair.valid = true;
    pair.node = fit.node;
    pair.node.error = std::max({fit.node.error, a.error, b.error});
    // The fit has looked at some of the points only, and the best of many pairs is one where these flatter.
    for (const Cluster* cluster : {&a, &b})
      pair.node.error = std::max(pair.node.error, slimNodeError(fit.node, levels_.points(), cluster->points));
  }

  bool alive(const Candidate& pair) const {
    return clusters_[pair.first].active && clusters_[pair.second].active;
  }

  std::optional<float> leastError() {
    std::optional<float> least;
    for (const Candidate& pair : candidates_)
      if (alive(pair) && (!least || pair.node.error < *least)) least = pair.node.error;
    return least;
  }

  /// Of the candidates of a cluster, the one that errs least; of equal ones the earliest.
  std::optional<std::uint32_t> best(Cluster& cluster, float limit) const {
    std::erase_if(cluster.candidates, [&](std::uint32_t k) { return !alive(candidates_[k]); });
    std::optional<std::uint32_t> found;
    for (const std::uint32_t k : cluster.candidates) {
      const float error = candidates_[k].node.error;
      if (error <= limit && (!found || error < candidates_[*found].node.error)) found = k;
    }
    return found;
  }

  /// Merges all pairs that are each other's best; false if there is none.
  bool mergeMutual(float limit) {
    std::vector<std::uint8_t> votes(candidates_.size(), 0);
    std::vector<std::uint32_t> chosen;
    for (Cluster& cluster : clusters_) {
      if (!cluster.active) continue;
      if (const auto pair = best(cluster, limit); pair && ++votes[*pair] == 2) chosen.push_back(*pair);
    }
    if (chosen.empty()) return false;
    const std::size_t first = clusters_.size();
    for (const std::uint32_t pair : chosen) merge(candidates_[pair]);
    std::vector<Candidate> pairs;
    for (std::size_t k = first; k < clusters_.size(); ++k) {
      Cluster& cluster = clusters_[k];
      for (std::uint32_t& other : cluster.neighbours)
        while (!clusters_[other].active) other = mergedInto_[other];
      std::sort(cluster.neighbours.begin(), cluster.neighbours.end());
      cluster.neighbours.erase(std::unique(cluster.neighbours.begin(), cluster.neighbours.end()),
                               cluster.neighbours.end());
      const auto self = static_cast<std::uint32_t>(k);
      std::erase(cluster.neighbours, self);
      for (const std::uint32_t other : cluster.neighbours) {
        if (other < first) {
          // The two that have gone stay in its list until it is merged itself.
          clusters_[other].neighbours.push_back(self);
          pairs.push_back({other, self, false, {}});
        } else if (other < self) {
          pairs.push_back({other, self, false, {}});
        }
      }
    }
    evaluate(std::move(pairs));
    return true;
  }

  void merge(const Candidate& pair) {
    Cluster result;
    Cluster &a = clusters_[pair.first], &b = clusters_[pair.second];
    result.error = pair.node.error;
    result.points = std::move(a.points);
    result.points.insert(result.points.end(), b.points.begin(), b.points.end());
    result.extremes = a.extremes;
    result.extremes.include(b.extremes);
    result.neighbours = std::move(a.neighbours);
    result.neighbours.insert(result.neighbours.end(), b.neighbours.begin(), b.neighbours.end());
    const auto number = static_cast<std::uint32_t>(clusters_.size());
    mergedInto_.resize(clusters_.size() + 1, number);
    for (Cluster* cluster : {&a, &b}) {
      mergedInto_[static_cast<std::size_t>(cluster - clusters_.data())] = number;
      *cluster = Cluster{};
      cluster->active = false;
    }
    hierarchy_.merged.push_back(pair.node);
    hierarchy_.children.push_back({pair.first, pair.second});
    clusters_.push_back(std::move(result));
  }

  PointLevels levels_;
  int degree_;
  ThreadPool& pool_;
  float largest_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> mergedInto_;
  SlimHierarchy hierarchy_;
};

}  // namespace

SlimHierarchy mergeSlim(const OrientedPoints& points, const std::vector<SlimNode>& nodes, int degree,
                        ThreadPool& pool) {
  if (nodes.size() < 2) return {};
  return Merging(points, nodes, degree, pool).run();
}

std::vector<SlimNode> cutSlim(const std::vector<SlimNode>& nodes, const SlimHierarchy& hierarchy,
                              double tolerance) {
  // Errors grow towards the roots: a ball within the tolerance hides its children, and is hidden by its
  // parent.
  std::vector<std::uint8_t> shown(nodes.size() + hierarchy.merged.size(), 0);
  std::fill(shown.begin(), shown.begin() + static_cast<std::ptrdiff_t>(nodes.size()), std::uint8_t{1});
  for (std::size_t k = 0; k < hierarchy.merged.size(); ++k) {
    if (static_cast<double>(hierarchy.merged[k].error) > tolerance) continue;
    shown[nodes.size() + k] = 1;
    for (const std::uint32_t child : hierarchy.children[k]) shown[child] = 0;
  }
  std::vector<SlimNode> cut;
  for (std::size_t k = 0; k < shown.size(); ++k)
    if (shown[k] != 0) cut.push_back(k < nodes.size() ? nodes[k] : hierarchy.merged[k - nodes.size()]);
  return cut;
}

double toleranceFor(const std::vector<SlimNode>& nodes, const SlimHierarchy& hierarchy, std::size_t wanted) {
  if (nodes.size() <= wanted || hierarchy.merged.empty()) return 0;
  // Every merged ball within the tolerance makes one ball less.
  std::vector<float> errors;
  for (const SlimNode& node : hierarchy.merged) errors.push_back(node.error);
  const auto at = static_cast<std::ptrdiff_t>(std::min(nodes.size() - wanted, errors.size()) - 1);
  std::nth_element(errors.begin(), errors.begin() + at, errors.end());
  return static_cast<double>(errors[static_cast<std::size_t>(at)]);
}

namespace {

/// From the centre of a cube of 3 x 3 x 3 to all others.
constexpr std::array<int, 3> directionOf(std::size_t k) {
  const int cell = static_cast<int>(k < 13 ? k : k + 1);
  return {cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
}

}  // namespace

void Extremes::include(const Vec3f& p) {
  for (std::size_t k = 0; k < kDirections; ++k) {
    const auto [x, y, z] = directionOf(k);
    const float reach =
        static_cast<float>(x) * p.x() + static_cast<float>(y) * p.y() + static_cast<float>(z) * p.z();
    if (any_ && reach <= reaches_[k]) continue;
    reaches_[k] = reach;
    points_[k] = p;
  }
  any_ = true;
}

void Extremes::include(const Extremes& other) {
  if (!other.any_) return;
  for (std::size_t k = 0; k < kDirections; ++k) {
    if (any_ && other.reaches_[k] <= reaches_[k]) continue;
    reaches_[k] = other.reaches_[k];
    points_[k] = other.points_[k];
  }
  any_ = true;
}

Vec3f Extremes::centre() const {
  // Badoiu and Clarkson 2003: towards the farthest point, by less and less.
  constexpr int kSteps = 40;
  Vec3f centre = Vec3f::Zero();
  for (const Vec3f& p : points_) centre += p / static_cast<float>(kDirections);
  for (int step = 1; step <= kSteps; ++step) {
    float farthest = -1;
    Vec3f towards = Vec3f::Zero();
    for (const Vec3f& p : points_) {
      const float squared = (p - centre).squaredNorm();
      if (squared <= farthest) continue;
      farthest = squared;
      towards = p - centre;
    }
    centre += towards / static_cast<float>(step + 2);
  }
  return centre;
}

}  // namespace migiwa
