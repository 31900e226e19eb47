// gamma about upright blocks thinner than the support radius, by the sums of facets.cpp: where blocks stand
// apart as a point sees them, every facet that faces the point is seen whole, and its edges follow from the
// blocks' coordinates alone. The results are those of facets.cpp to the last bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/gamma/batches.h"
#include "core/gamma/polygon_sums.h"

namespace migiwa {

namespace {

/// A block as a point at the origin sees it; lengths over the support radius.
struct SeenBlock {
  Vec3f low, high;
  /// The corners, looking along an axis, between which all of the block lies to the left of the first and to
  /// the right of the second; in the coordinates of the two axes after it.
  struct Outline {
    std::array<float, 2> right, left;
    bool around;  ///< about the point: there are none
  };
  std::array<Outline, 3> outlines;

  void outline() {
    for (int axis = 0; axis < 3; ++axis) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const float a0 = low[a], a1 = high[a], b0 = low[b], b1 = high[b];
      const int sideA = a0 > 0 ? 1 : a1 < 0 ? -1 : 0, sideB = b0 > 0 ? 1 : b1 < 0 ? -1 : 0;
      const float nearA = sideA >= 0 ? a0 : a1, nearB = sideB >= 0 ? b0 : b1;
      Outline& own = outlines[static_cast<std::size_t>(axis)];
      own.around = sideA == 0 && sideB == 0;
      own.left = {sideB > 0 ? a0 : sideB < 0 ? a1 : nearA, sideA > 0 ? b1 : sideA < 0 ? b0 : nearB};
      own.right = {sideB > 0 ? a1 : sideB < 0 ? a0 : nearA, sideA > 0 ? b0 : sideA < 0 ? b1 : nearB};
    }
  }
};

float turnFrom(const std::array<float, 2>& a, const std::array<float, 2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// Whether a plane through the point and along an axis has one block on each side.
bool apart(const SeenBlock& one, const SeenBlock& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const SeenBlock::Outline &a = one.outlines[axis], &b = other.outlines[axis];
    if (a.around || b.around) continue;
    if (turnFrom(a.left, b.right) >= 0 && turnFrom(a.left, b.left) >= 0) return true;
    if (turnFrom(a.right, b.right) <= 0 && turnFrom(a.right, b.left) <= 0) return true;
  }
  return false;
}

/// Whether two of the half-spaces that bound a thin block, as HalfSpaces::collect() takes them, are so near
/// to a point outside that an edge may be in reach.
bool rimInReach(const UprightBlock& block, const Vec3f& p, float inverseSupport,
                std::span<const HalfSpace> tanks) {
  float least = 1, second = 1;
  const Vec3f local = p - block.center;
  // The face that looks along `axis` to a side, at e in front of the point or, below zero, behind it.
  const auto take = [&](int axis, float side, float e) {
    if (std::abs(e) >= 1) return;
    constexpr float kOnePlane = 1e-4F, kSameNormal = 0.999F;
    for (const HalfSpace& tank : tanks)
      if (-side * tank.normal[axis] > kSameNormal && e >= tank.e - kOnePlane) return;
    const float square = e * e;
    second = std::min(second, std::max(least, square));
    least = std::min(least, square);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const float side = std::copysign(1.0F, local[axis]), within = block.half[axis] - std::abs(local[axis]);
    take(axis, side, within * inverseSupport);
    if (within > 0) take(axis, -side, (block.half[axis] + std::abs(local[axis])) * inverseSupport);
  }
  return least + second < 1;
}

template <class Kernel>
class BlockFacets final : public BlockGamma {
 public:
  explicit BlockFacets(const GammaContext& context)
      : boundary_(context.boundary), kernel_(context.kernel), support_(context.supportRadius) {}

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out,
                std::vector<std::size_t>& others) const override {
    thread_local Scratch scratch;
    scratch.sums.clear(), scratch.faces.clear(), scratch.points.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = GammaSample{};
      if (!look(points[i].xyz(), scratch, out[i].distance)) {
        others.push_back(i);
      } else if (scratch.tanks.empty()) {
        addFaces(i, scratch, out[i]);
      } else {
        scratch.sums.addTanks(i, scratch.tanks, out[i]);
        for (const SeenBlock& block : std::span(scratch.seen).first(scratch.count))
          addBlock(i, block, scratch, out[i]);
      }
    }
    scratch.sums.finish(kernel_, out);
    addUprightFaces(kernel_, scratch.faces, mostFacesFirst(scratch), out);
    for (GammaSample& sample : out) range_.set(sample, sample.gamma);
  }

  long takeOutOfRange() const override { return range_.take(); }

 private:
  static constexpr std::size_t kMostBlocks = 8;

  static constexpr std::size_t kMostFaces = 6 * kMostBlocks;

  struct Scratch {
    PolygonSums<Kernel> sums;  ///< of points that have tanks in reach
    std::vector<WallPiece> pieces;
    // Of the other points:
    std::vector<UprightFace> faces;
    std::vector<FacesSeen> points, ordered;
    // Of one point:
    std::vector<HalfSpace> tanks;
    std::array<const UprightBlock*, kMostBlocks> blocks;
    std::array<SeenBlock, kMostBlocks> seen;
    std::size_t count = 0;  ///< of the blocks
  };

  /// All that it calls is put in its place: it is asked of every particle.
  /// Measures how near walls are. Whether there are thin blocks alone in reach, apart from each other, the
  /// rim of one among them, all within the tanks that are in reach, too.
  [[gnu::flatten]] bool look(const Vec3f& p, Scratch& scratch, float& distance) const {
    const float inverse = 1 / support_, square = support_ * support_;
    float squared = std::numeric_limits<float>::infinity(), walls = squared;
    scratch.count = 0;
    scratch.tanks.clear();
    bool alone = true;
    for (const auto& [surface, block, vessel] : boundary_.near(p, support_)) {
      const float own = block != nullptr ? block->squaredDistance(p) : 0;
      if (own > 0) {
        squared = std::min(squared, own);
        if (own >= square) continue;
        alone = alone && scratch.count < kMostBlocks && block->thickness() < support_;
        if (alone) scratch.blocks[scratch.count++] = block;
        continue;
      }
      Vec3f ignored;
      const float wall = vessel != nullptr ? vessel->distance(p) : surface->distance(p, ignored);
      walls = std::min(walls, wall);
      if (wall >= support_ || !alone) continue;
      alone = surface->planar() && surface->pieceRule() == PieceRule::fluidInsideAll;
      if (alone) addPlanes(*surface, p, scratch);
    }
    distance = std::min(std::sqrt(squared), walls);
    if (!alone || scratch.count == 0 || distance < kClearOfFacets * support_) return false;
    bool rim = false;
    for (std::size_t k = 0; k < scratch.count; ++k) {
      const UprightBlock& block = *scratch.blocks[k];
      rim = rim || rimInReach(block, p, inverse, scratch.tanks);
      SeenBlock& seen = scratch.seen[k];
      seen.low = inverse * (block.low - p), seen.high = inverse * (block.high - p);
      if ((seen.high - seen.low).minCoeff() < kShortEdge) return false;
      if (!inside(seen, scratch.tanks)) return false;
      if (scratch.count == 1) break;
      seen.outline();
      for (std::size_t l = 0; l < k; ++l)
        if (!apart(seen, scratch.seen[l])) return false;
    }
    return rim;
  }

  void addPlanes(const Surface& tank, const Vec3f& p, Scratch& scratch) const {
    const float inverse = 1 / support_;
    scratch.pieces.clear();
    tank.pieces(p, support_, scratch.pieces);
    for (const WallPiece& piece : scratch.pieces)
      intersect(scratch.tanks, {piece.normal, std::max(piece.planeDistance * inverse, 0.0F)});
  }

  /// Whether all of a block is inside of the half-spaces: none cuts its faces.
  static bool inside(const SeenBlock& block, const std::vector<HalfSpace>& tanks) {
    constexpr float kTouching = 1e-6F;
    return std::all_of(tanks.begin(), tanks.end(), [&](const HalfSpace& tank) {
      const Vec3f nearest = (tank.normal.array() > 0).select(block.low, block.high);
      return tank.normal.dot(nearest) + tank.e > -kTouching;
    });
  }

  /// Appends the faces that the point of sample i sees, and has each that its foot is in take a whole plane.
  static void addFaces(std::size_t i, Scratch& scratch, GammaSample& sample) {
    const std::size_t first = scratch.faces.size();
    for (const SeenBlock& block : std::span(scratch.seen).first(scratch.count)) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
          const float height = side < 0 ? block.low[axis] : -block.high[axis];
          if (height < -kOnFacet || height >= 1) continue;
          const float distance = std::max(height, 0.0F);
          const int one = (axis + (side > 0 ? 1 : 2)) % 3, other = (axis + (side > 0 ? 2 : 1)) % 3;
          const float beyond =
              std::max({block.low[one], -block.high[one], block.low[other], -block.high[other]});
          if (beyond > 0 && 1 - distance * distance - beyond * beyond <= 0) continue;
          if (beyond <= 0) {
            const Vec3f normal = side * Vec3f::Unit(axis);
            PolygonSums<Kernel>::addPlane(normal, distance, 1, 1, sample);
          }
          scratch.faces.push_back({distance, side, static_cast<float>(axis), block.low[one], block.high[one],
                                   block.low[other], block.high[other]});
        }
      }
    }
    const std::size_t count = scratch.faces.size() - first;
    if (count > 0)
      scratch.points.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(first),
                                static_cast<std::uint32_t>(count)});
  }

  static std::span<const FacesSeen> mostFacesFirst(Scratch& scratch) {
    std::array<std::size_t, kMostFaces + 1> place{};  // of points with more faces than that
    for (const FacesSeen& point : scratch.points)
      for (std::size_t fewer = 0; fewer < point.count; ++fewer) ++place[fewer];
    scratch.ordered.resize(scratch.points.size());
    for (const FacesSeen& point : scratch.points) scratch.ordered[place[point.count]++] = point;
    return scratch.ordered;
  }

  static void addBlock(std::size_t i, const SeenBlock& block, Scratch& scratch, GammaSample& sample) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0F, 1.0F}) {
        const float height = side < 0 ? block.low[axis] : -block.high[axis];
        if (height < -kOnFacet || height >= 1) continue;
        const float distance = std::max(height, 0.0F);
        if (scratch.sums.addFace(i, block.low, block.high, axis, side, distance, sample) &&
            !scratch.tanks.empty())
          scratch.sums.addBehind(i, face(block, axis, side), distance, true, scratch.tanks, sample);
      }
    }
  }

  /// Counter-clockwise as the point sees it.
  static Polygon face(const SeenBlock& block, int axis, float side) {
    const int one = (axis + (side > 0 ? 1 : 2)) % 3, other = (axis + (side > 0 ? 2 : 1)) % 3;
    Polygon polygon;
    for (const auto& [a, b] : {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
      Vec3f corner;
      corner[axis] = side > 0 ? block.high[axis] : block.low[axis];
      corner[one] = a ? block.high[one] : block.low[one];
      corner[other] = b ? block.high[other] : block.low[other];
      polygon.add(corner);
    }
    return polygon;
  }

  const Boundary& boundary_;
  KernelType kernel_;
  float support_;
  ShareRange range_;
};

}  // namespace

std::unique_ptr<BlockGamma> makeBlockGamma(const GammaContext& context) {
  const auto& surfaces = context.boundary.surfaces();
  if (std::none_of(surfaces.begin(), surfaces.end(), [&](const auto& surface) {
        return surface->uprightBlock() != nullptr && surface->thickness() < context.supportRadius;
      }))
    return nullptr;
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<BlockGamma> {
    return std::make_unique<BlockFacets<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
