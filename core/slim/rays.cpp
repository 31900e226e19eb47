#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "core/slim/model.h"
#include "core/slim/node.h"

namespace migiwa {

namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
/// Part of a ball's radius within which its polynomial is hit: a little more than its core, so that the blend
/// fades out smoothly and rays find no gap between points of the fit.
constexpr float kHitReach = 1.1F * kSlimCore;
/// Hits of one passage lie within so many radii of each other.
constexpr float kSamePassage = 0.5F;

struct Hit {
  float t;       ///< along the ray (m)
  float weight;  ///< of the ball there
  float reach;   ///< up to where hits are of the same passage (m)
  bool leaving;  ///< out of the solid
};

/// Weight of a hit at the squared distance from the ball's centre, over the squared hit reach: fades to zero.
float hitWeight(float squared) {
  const float rest = 1 - squared;
  return rest * rest + 1e-6F;
}

/// The hits of all rays: the nearest ones of each.
class HitLists {
 public:
  void clear(std::size_t rays) {
    counts_.assign(rays, 0);
    hits_.resize(rays * kMost);
  }
  void add(std::uint32_t ray, const Hit& hit) {
    Hit* const hits = &hits_[ray * kMost];
    std::uint32_t& count = counts_[ray];
    if (count < kMost) {
      hits[count++] = hit;
      return;
    }
    Hit& farthest =
        *std::max_element(hits, hits + kMost, [](const Hit& a, const Hit& b) { return a.t < b.t; });
    if (hit.t < farthest.t) farthest = hit;
  }
  std::span<Hit> of(std::size_t ray) { return {&hits_[ray * kMost], counts_[ray]}; }

 private:
  static constexpr std::uint32_t kMost = 16;
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> counts_;
};

struct Scratch {
  DirectionBins bins;
  HitLists lists;
};

/// A node's polynomial along rays from one point.
class NodeAlongRays {
 public:
  NodeAlongRays(const SlimNode& node, const Vec3f& origin, int degree)
      : node_(node), degree_(degree), bitangent_(node.bitangent()), offset_(origin - node.centre) {
    u_ = node.tangent.dot(offset_), v_ = bitangent_.dot(offset_), w_ = node.normal.dot(offset_);
    const auto& c = node.coefficients;
    du_ = c[1] + u_ * (2 * c[3] + 3 * u_ * c[6]) + v_ * (c[4] + 2 * u_ * c[7] + v_ * c[8]);
    dv_ = c[2] + v_ * (2 * c[5] + 3 * v_ * c[9]) + u_ * (c[4] + u_ * c[7] + 2 * v_ * c[8]);
    value_ = w_ - (c[0] + u_ * (c[1] + u_ * (c[3] + u_ * c[6])) + v_ * (c[2] + v_ * (c[5] + v_ * c[9])) +
                   u_ * v_ * (c[4] + u_ * c[7] + v_ * c[8]));
  }

  /// Of f at the origin, along a direction.
  float slope(const Vec3f& direction) const {
    return node_.normal.dot(direction) - du_ * node_.tangent.dot(direction) - dv_ * bitangent_.dot(direction);
  }

  /// Calls found(t, squared distance to the centre (m^2), leaving) for the zeros within the hit reach.
  template <class Found>
  void zeros(const Vec3f& direction, float least, float most, const Found& found) const {
    const float along = direction.dot(offset_), limit = kHitReach * node_.radius;
    const float across = offset_.squaredNorm() - along * along, square = limit * limit - across;
    if (square <= 0) return;
    const float half = std::sqrt(square);
    const float from = std::max(-along - half, least), to = std::min(-along + half, most);
    if (from >= to) return;
    const float a = node_.tangent.dot(direction), b = bitangent_.dot(direction);
    const auto& c = node_.coefficients;
    // Taylor coefficients along the ray, exact.
    const float first = node_.normal.dot(direction) - du_ * a - dv_ * b;
    const float bend = degree_ < 2 ? 0
                                   : -(a * a * (c[3] + 3 * c[6] * u_ + c[7] * v_) +
                                       a * b * (c[4] + 2 * (c[7] * u_ + c[8] * v_)) +
                                       b * b * (c[5] + 3 * c[9] * v_ + c[8] * u_));
    const float third = degree_ < 3 ? 0 : -(a * a * (a * c[6] + b * c[7]) + b * b * (a * c[8] + b * c[9]));
    const auto value = [&](float t) { return value_ + t * (first + t * (bend + t * third)); };
    const auto steepness = [&](float t) { return first + t * (2 * bend + 3 * t * third); };
    // Between its extrema the polynomial is monotonic.
    float ends[3] = {to, to, to};
    int count = 0;
    if (third != 0) {
      const float discriminant = bend * bend - 3 * third * first;
      if (discriminant > 0) {
        const float q = -(bend + std::copysign(std::sqrt(discriminant), bend));
        const float one = q / (3 * third), other = q != 0 ? first / q : to;
        for (const float t : {std::min(one, other), std::max(one, other)})
          if (t > from && t < to) ends[count++] = t;
      }
    } else if (bend != 0) {
      const float t = -first / (2 * bend);
      if (t > from && t < to) ends[count++] = t;
    }
    float low = from, lowValue = value(from);
    for (int k = 0; k <= count; ++k) {
      float high = ends[k];
      const float highValue = value(high);
      if ((lowValue < 0) != (highValue < 0)) {
        const bool rising = lowValue < 0;
        // Newton from the secant's zero, kept inside the bracket.
        float t = low + (high - low) * lowValue / (lowValue - highValue), a0 = low, b0 = high;
        for (int step = 0; step < 8; ++step) {
          const float here = value(t);
          ((here < 0) == rising ? a0 : b0) = t;
          const float slopeHere = steepness(t);
          float next = t - here / slopeHere;
          if (!(next >= a0 && next <= b0)) next = 0.5F * (a0 + b0);
          const bool there = std::abs(next - t) < 1e-5F * node_.radius;
          t = next;
          if (there) break;
        }
        const Vec3f q = offset_ + t * direction;
        found(t, q.squaredNorm(), rising);
      }
      low = high;
      lowValue = highValue;
    }
  }

 private:
  const SlimNode& node_;
  int degree_;
  Vec3f bitangent_, offset_;  ///< of the origin from the centre
  float u_, v_, w_, du_, dv_, value_;
};

/// What all rays from one point share.
struct RaysFrom {
  const Vec3f& origin;
  bool inside;
  float reach;
  HitLists& lists;
};

/// Hits of a plane with the rays of a bin. `contradicts`: the ball holds the origin, and the plane has it on
/// the wrong side: whatever changes the side does so at once.
void hitPlane(const SlimNode& node, const RaysFrom& rays, const DirectionBins::Bin& bin, bool contradicts) {
  const Vec3f offset = rays.origin - node.centre;
  const float value = node.normal.dot(offset) - node.coefficients[0];
  const float limit = kHitReach * node.radius, inverse = 1 / (limit * limit);
  const FourFloats towards = node.normal.x() * bin.x + node.normal.y() * bin.y + node.normal.z() * bin.z;
  if (contradicts) {
    for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane)
      if ((towards[lane] > 0) == rays.inside && bin.index[lane] != DirectionBins::kNone)
        rays.lists.add(bin.index[lane], {0, hitWeight(offset.squaredNorm() * inverse),
                                         kSamePassage * node.radius, rays.inside});
    return;
  }
  const FourFloats along = offset.x() * bin.x + offset.y() * bin.y + offset.z() * bin.z;
  const FourFloats t = -value / towards;
  const FourFloats squared = (t * (t + 2.0F * along) + offset.squaredNorm()) * inverse;
  const auto valid = (t > 0.0F) & (t < rays.reach) & (squared < 1.0F);
  std::uint64_t halves[2];
  std::memcpy(halves, &valid, sizeof halves);
  if ((halves[0] | halves[1]) == 0) return;
  for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane)
    if (valid[lane] != 0 && bin.index[lane] != DirectionBins::kNone)
      rays.lists.add(bin.index[lane],
                     {t[lane], hitWeight(squared[lane]), kSamePassage * node.radius, towards[lane] > 0});
}

/// The same for a polynomial of degree 2: both zeros of the quadratic along each ray.
class QuadricAlongRays {
 public:
  QuadricAlongRays(const SlimNode& node, const RaysFrom& rays)
      : node_(node), rays_(rays), bitangent_(node.bitangent()), offset_(rays.origin - node.centre) {
    const float u = node.tangent.dot(offset_), v = bitangent_.dot(offset_);
    const auto& c = node.coefficients;
    du_ = c[1] + 2 * u * c[3] + v * c[4];
    dv_ = c[2] + 2 * v * c[5] + u * c[4];
    value_ = node.normal.dot(offset_) - (c[0] + u * (c[1] + u * c[3]) + v * (c[2] + v * c[5]) + u * v * c[4]);
    // Along a direction w, the polynomial's slope is slope_ . w.
    slope_ = node.normal - du_ * node.tangent - dv_ * bitangent_;
  }

  void hit(const DirectionBins::Bin& bin, bool contradicts) const {
    const auto along = [&](const Vec3f& axis) {
      return axis.x() * bin.x + axis.y() * bin.y + axis.z() * bin.z;
    };
    const float limit = kHitReach * node_.radius, inverse = 1 / (limit * limit);
    const FourFloats first = along(slope_);
    if (contradicts) {
      for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane)
        if ((first[lane] > 0) == rays_.inside && bin.index[lane] != DirectionBins::kNone)
          rays_.lists.add(bin.index[lane], {0, hitWeight(offset_.squaredNorm() * inverse),
                                            kSamePassage * node_.radius, rays_.inside});
      return;
    }
    const auto& c = node_.coefficients;
    const FourFloats a = along(node_.tangent), b = along(bitangent_), middle = along(offset_);
    const FourFloats bend = -(a * a * c[3] + a * b * c[4] + b * b * c[5]);
    const FourFloats discriminant = first * first - 4.0F * value_ * bend;
    FourFloats root;
    for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane)
      root[lane] = std::sqrt(std::max(discriminant[lane], 0.0F));
    // Without cancellation: the sum of two numbers of the same sign, and the product of the zeros.
    const FourFloats sign = first < 0.0F ? FourFloats{} - 1.0F : FourFloats{} + 1.0F;
    const FourFloats q = -0.5F * (first + sign * root);
    report(bin, q / bend, middle, -sign, discriminant, inverse);
    report(bin, value_ / q, middle, sign, discriminant, inverse);
  }

 private:
  /// `rising`: sign of the polynomial's slope at t.
  void report(const DirectionBins::Bin& bin, const FourFloats& t, const FourFloats& middle,
              const FourFloats& rising, const FourFloats& discriminant, float inverse) const {
    const FourFloats squared = (t * (t + 2.0F * middle) + offset_.squaredNorm()) * inverse;
    const auto valid = (t > 0.0F) & (t < rays_.reach) & (squared < 1.0F) & (discriminant > 0.0F);
    std::uint64_t halves[2];
    std::memcpy(halves, &valid, sizeof halves);
    if ((halves[0] | halves[1]) == 0) return;
    for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane)
      if (valid[lane] != 0 && bin.index[lane] != DirectionBins::kNone)
        rays_.lists.add(bin.index[lane],
                        {t[lane], hitWeight(squared[lane]), kSamePassage * node_.radius, rising[lane] > 0});
  }

  const SlimNode& node_;
  const RaysFrom& rays_;
  Vec3f bitangent_, offset_, slope_;
  float du_, dv_, value_;
};

/// The same for a polynomial of degree 3.
void hitCubic(const SlimNode& node, const NodeAlongRays& along, const RaysFrom& rays,
              const DirectionBins::Bin& bin, bool contradicts) {
  const float limit = kHitReach * node.radius, inverse = 1 / (limit * limit);
  for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane) {
    if (bin.index[lane] == DirectionBins::kNone) continue;
    const Vec3f direction(bin.x[lane], bin.y[lane], bin.z[lane]);
    if (contradicts && (along.slope(direction) > 0) == rays.inside) {
      const float squared = (rays.origin - node.centre).squaredNorm() * inverse;
      rays.lists.add(bin.index[lane], {0, hitWeight(squared), kSamePassage * node.radius, rays.inside});
      continue;
    }
    along.zeros(direction, 0, rays.reach, [&](float t, float squared, bool leaving) {
      rays.lists.add(bin.index[lane], {t, hitWeight(squared * inverse), kSamePassage * node.radius, leaving});
    });
  }
}

/// Blends the hits of a ray into passages.
void passages(std::span<Hit> hits, bool inside, SlimPassages& out) {
  out.fill(kNever);
  if (hits.empty()) return;
  // Mostly there is one passage.
  float weights = 0, sum = 0, nearest = kNever, farthest = 0, reach = kNever;
  bool one = true;
  for (const Hit& hit : hits) {
    one = one && hit.leaving == inside;
    weights += hit.weight, sum += hit.weight * hit.t;
    nearest = std::min(nearest, hit.t), farthest = std::max(farthest, hit.t),
    reach = std::min(reach, hit.reach);
  }
  if (one && farthest <= nearest + reach) {
    out[0] = sum / weights;
    return;
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
  std::size_t found = 0;
  for (std::size_t k = 0; k < hits.size() && found < out.size();) {
    // What does not change the side is the back of a polynomial that reaches past a crease.
    if (hits[k].leaving != inside) {
      ++k;
      continue;
    }
    weights = sum = 0;
    const float end = hits[k].t + hits[k].reach;
    std::size_t last = k;
    for (; last < hits.size() && hits[last].leaving == inside && hits[last].t <= end; ++last)
      weights += hits[last].weight, sum += hits[last].weight * hits[last].t;
    out[found++] = sum / weights;
    inside = !inside;
    k = last;
  }
}

}  // namespace

void slimPassages(const SlimModel& model, const Vec3f& origin, bool inside, const DirectionSet& directions,
                  float reach, std::span<SlimPassages> out) {
  thread_local Scratch scratch;
  if (!scratch.bins.matches(directions)) scratch.bins.build(directions);
  scratch.lists.clear(directions.size());
  const RaysFrom rays{origin, inside, reach, scratch.lists};
  const auto visitNode = [&](const SlimNode& node, const auto& hitBin) {
    const float limit = kHitReach * node.radius;
    const Vec3f towards = node.centre - origin;
    const float length = towards.norm();
    if (length > reach + limit) return;
    if (length <= limit) {
      Vec3f ignored;
      const bool contradicts = (slimNodeValue(node, origin, ignored) < 0) != inside;
      for (const DirectionBins::Bin& bin : scratch.bins.bins()) hitBin(bin, contradicts);
      return;
    }
    const float sine = limit / length;
    scratch.bins.visitCone(towards / length, std::sqrt(1 - sine * sine), sine,
                           [&](const DirectionBins::Bin& bin) { hitBin(bin, false); });
  };
  model.visitWithin(origin, reach, [&](std::uint32_t index) {
    const SlimNode& node = model.nodes()[index];
    if (model.degree() == 1) {
      visitNode(node, [&](const DirectionBins::Bin& bin, bool contradicts) {
        hitPlane(node, rays, bin, contradicts);
      });
    } else if (model.degree() == 2) {
      const QuadricAlongRays quadric(node, rays);
      visitNode(node,
                [&](const DirectionBins::Bin& bin, bool contradicts) { quadric.hit(bin, contradicts); });
    } else {
      const NodeAlongRays along(node, origin, model.degree());
      visitNode(node, [&](const DirectionBins::Bin& bin, bool contradicts) {
        hitCubic(node, along, rays, bin, contradicts);
      });
    }
  });
  for (std::size_t k = 0; k < directions.size(); ++k) passages(scratch.lists.of(k), inside, out[k]);
}

bool slimFirstPassage(const SlimModel& model, const Vec3f& from, const Vec3f& to, bool leaving, float& at,
                      Vec3f& normal) {
  const Vec3f way = to - from;
  const float length = way.norm();
  if (!(length > 0)) return false;
  const Vec3f direction = way / length;
  // The balls around the way are those around its middle, within half of its length.
  HitLists lists;
  lists.clear(1);
  model.visitWithin(0.5F * (from + to), 0.5F * length, [&](std::uint32_t index) {
    const SlimNode& node = model.nodes()[index];
    NodeAlongRays(node, from, model.degree())
        .zeros(direction, 0, length, [&](float t, float squared, bool out) {
          const float limit = kHitReach * node.radius;
          lists.add(0, {t, hitWeight(squared / (limit * limit)), kSamePassage * node.radius, out});
        });
  });
  SlimPassages found;
  passages(lists.of(0), leaving, found);
  if (!(found[0] <= length)) return false;
  at = found[0] / length;
  normal = model.nearest(from + found[0] * direction).normal;
  return true;
}

float slimThickness(const SlimModel& model) {
  float thinnest = kNever;
  if (!model.closed()) return thinnest;
  const auto reach = static_cast<float>(model.bounds().size().norm());
  // A few thousand places tell; walls do not get thin at a point.
  const std::size_t step = 1 + model.nodes().size() / 4000;
  for (std::size_t k = 0; k < model.nodes().size(); k += step) {
    const SlimNode& node = model.nodes()[k];
    const Vec3f inwards = -node.normal;
    const Vec3f from = node.centre + 0.2F * node.radius * inwards;
    const float nearest = std::min(thinnest, reach);
    float at = 0;
    Vec3f normal;
    // Out through the opposite side, not back through a crease.
    if (slimFirstPassage(model, from, from + nearest * inwards, true, at, normal) &&
        normal.dot(inwards) > 0.5F)
      thinnest = std::min(thinnest, at * nearest + 0.2F * node.radius);
  }
  return thinnest;
}

bool DirectionBins::matches(const DirectionSet& directions) const {
  const std::size_t n = directions.size();
  if (known_.size() != 3 * n || n == 0) return false;
  return std::memcmp(known_.data(), directions.x.data(), n * sizeof(float)) == 0 &&
         std::memcmp(known_.data() + n, directions.y.data(), n * sizeof(float)) == 0 &&
         std::memcmp(known_.data() + 2 * n, directions.z.data(), n * sizeof(float)) == 0;
}

void DirectionBins::build(const DirectionSet& directions) {
  const std::size_t n = directions.size();
  known_.clear();
  for (const auto& part : {directions.x, directions.y, directions.z})
    known_.insert(known_.end(), part.begin(), part.end());
  bins_.clear();
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  if (n > 0) split(order);

  const std::size_t groups = (bins_.size() + kLanes - 1) / kLanes;
  for (auto* part : {&axisX_, &axisY_, &axisZ_, &sine_}) part->assign(groups, FourFloats{});
  cosine_.assign(groups, FourFloats{} + 2.0F);  // never seen
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const Bin& bin = bins_[k];
    Vec3f axis = Vec3f::Zero();
    for (std::size_t lane = 0; lane < kLanes; ++lane) axis += Vec3f(bin.x[lane], bin.y[lane], bin.z[lane]);
    axis.normalize();
    float cosine = 1;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      cosine = std::min(cosine, axis.dot(Vec3f(bin.x[lane], bin.y[lane], bin.z[lane])));
    cosine -= 1e-5F;  // rounding must not lose a direction at the rim
    const std::size_t group = k / kLanes, lane = k % kLanes;
    axisX_[group][lane] = axis.x(), axisY_[group][lane] = axis.y(), axisZ_[group][lane] = axis.z();
    cosine_[group][lane] = cosine;
    sine_[group][lane] = std::sqrt(std::max(1 - cosine * cosine, 0.0F));
  }
}

void DirectionBins::split(std::span<std::uint32_t> order) {
  const std::size_t n = known_.size() / 3;
  const auto coordinate = [&](std::uint32_t k, int axis) {
    return known_[static_cast<std::size_t>(axis) * n + k];
  };
  if (order.size() <= kLanes) {
    Bin bin{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Missing ones repeat the first, so that the cone stays as it is.
      const std::uint32_t k = order[lane < order.size() ? lane : 0];
      bin.x[lane] = coordinate(k, 0), bin.y[lane] = coordinate(k, 1), bin.z[lane] = coordinate(k, 2);
      bin.index[lane] = lane < order.size() ? k : kNone;
    }
    bins_.push_back(bin);
    return;
  }
  int axis = 0;
  float widest = -1;
  for (int candidate = 0; candidate < 3; ++candidate) {
    const auto [least, most] =
        std::minmax_element(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
          return coordinate(a, candidate) < coordinate(b, candidate);
        });
    const float width = coordinate(*most, candidate) - coordinate(*least, candidate);
    if (width > widest) widest = width, axis = candidate;
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float p = coordinate(a, axis), q = coordinate(b, axis);
    return p != q ? p < q : a < b;
  });
  // Whole bins on the left.
  const std::size_t middle = (order.size() / 2 + kLanes - 1) / kLanes * kLanes;
  split(order.first(middle));
  split(order.subspan(middle));
}

}  // namespace migiwa
