// Akinci, Ihmsen, Akinci, Solenthaler, Teschner 2012, "Versatile Rigid-Fluid Coupling for Incompressible
// SPH": walls are sampled with one layer of particles, whose volumes make up for uneven sampling, and
// rho_i = S_i + sum_b Psi_b W_ib (Eq. 6). A wall pushes by the fluid particle's own pressure (Eq. 9): here
// by its own lambda, through the gradient of the same sum.
// Deviation: the paper puts the particles on the surface and lets the fluid come to rest where it will. Here
// centres of fluid particles stay half a spacing in front of the wall, and boundary particles lie as far
// behind it as lets a lattice that rests on a flat wall read the density at rest: the depth at which the
// method does best. Walls have no friction of their own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/base/files.h"
#include "core/base/math.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

/// How far behind a flat wall a square lattice of boundary particles lies (m) that makes up for what a fluid
/// lattice half a spacing in front of it lacks, on the mean over places along the wall.
template <class Kernel>
float restingDepth(double spacing, double support) {
  const double ratio = support / spacing;
  const int reach = static_cast<int>(std::ceil(ratio));
  const auto layer = [&](double height, double x, double z) {
    double sum = 0;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach - 1; i <= reach; ++i)
        sum += static_cast<double>(
            Kernel::value(static_cast<float>(portable::hypot(height, i + x, j + z) / ratio)));
    return sum;
  };
  double lacking = 0, whole = layer(0, 0, 0);
  for (int k = 1; k <= reach; ++k) lacking += layer(k, 0, 0);
  whole += 2 * lacking;
  const auto added = [&](double height) {
    constexpr int kPlaces = 4;
    double sum = 0;
    for (int z = 0; z < kPlaces; ++z)
      for (int x = 0; x < kPlaces; ++x) sum += layer(height, x / double{kPlaces}, z / double{kPlaces});
    return sum / (kPlaces * kPlaces * layer(0, 0, 0));
  };
  double near = 0.5, far = ratio;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (near + far);
    (added(middle) > lacking / whole ? near : far) = middle;
  }
  return static_cast<float>((near - 0.5) * spacing);
}

/// Walls that move as one, with their particles where the walls are described.
struct Body {
  const MovingSurface* mover;  ///< one of them; null: they stand still
  BoundaryParticles particles;
};

template <class Kernel>
class ParticleWalls final : public GammaMethod {
 public:
  explicit ParticleWalls(const GammaContext& context)
      : GammaMethod(WallDensity::added), boundary_(context.boundary) {
    std::vector<std::shared_ptr<const Surface>> still;
    for (const auto& surface : boundary_.surfaces())
      if (dynamic_cast<const MovingSurface*>(surface.get()) == nullptr) still.push_back(surface);
    addBody(context, nullptr, std::move(still));
    for (int group = 0; group < static_cast<int>(boundary_.moving().size()); ++group) {
      const MovingSurface* mover = nullptr;
      std::vector<std::shared_ptr<const Surface>> rest;
      for (const auto& wall : boundary_.moving()) {
        if (wall->group() != group) continue;
        mover = wall.get();
        rest.push_back(wall->rest());
      }
      addBody(context, mover, std::move(rest));
    }
  }

  GammaChoice choice() const override {
    std::size_t count = 0;
    for (const Body& body : bodies_) count += body.particles.particles().size();
    return {"particles", std::to_string(count) + " boundary particles"};
  }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p);
      for (const Body& body : bodies_) add(body, p, out[i]);
    }
  }

 private:
  static void add(const Body& body, const Vec3f& p, GammaSample& sample) {
    float density = 0;
    Vec3f gradient = Vec3f::Zero(), pairGradient = Vec3f::Zero();
    body.particles.around(body.mover != nullptr ? body.mover->toRest(p) : p,
                          [&](const Vec3f& offset, float q, float volume) {
                            density += volume * Kernel::value(q);
                            if (q <= 0) return;
                            gradient += volume * Kernel::derivative(q) / q * offset;
                            pairGradient += volume * PairKernel<Kernel>::derivative(q) / q * offset;
                          });
    sample.gamma -= density;
    if (body.mover != nullptr) {
      gradient = body.mover->directionToWorld(gradient);
      pairGradient = body.mover->directionToWorld(pairGradient);
    }
    sample.gradient -= gradient;
    sample.pairGradient -= pairGradient;
  }

  void addBody(const GammaContext& context, const MovingSurface* mover,
               std::vector<std::shared_ptr<const Surface>> surfaces) {
    if (surfaces.empty()) return;
    Bounds region;
    bool endless = false;
    for (const auto& surface : surfaces) {
      const Bounds own = surface->bounds();
      endless = endless || own.empty();
      region.include(own);
    }
    // A wall without end has particles as far around the scene as the scene is wide.
    if (endless) region.include(context.region.grown(context.region.size().norm()));
    const Boundary boundary = Boundary::atRest(std::move(surfaces));
    std::optional<ThreadPool> own;
    ThreadPool& pool = context.pool != nullptr ? *context.pool : own.emplace(1);
    bodies_.push_back({mover,
                       {sampleWalls(boundary, region, context.spacing,
                                    restingDepth<Kernel>(static_cast<double>(context.spacing),
                                                         static_cast<double>(context.supportRadius)),
                                    pool, context.place),
                        context.kernel, context.supportRadius, pool}});
  }

  const Boundary& boundary_;
  std::vector<Body> bodies_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeBoundaryParticles(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<ParticleWalls<decltype(kernel)>>(context);
  });
}

namespace {

/// Points that are tried, along a spacing, and along a block.
constexpr int kTriedAlong = 3, kBlock = 6;
constexpr double kMostBlocks = 2e7;
constexpr std::size_t kMostParticles = 20'000'000;
/// What a block through which a wall goes takes on the way: some sixty candidates in vectors that grow, and
/// four particles in their cells.
constexpr double kBytesPerBlock = 2000;
/// Nearer to each other than this many spacings no two particles lie.
constexpr float kNearest = 0.99F;

/// Moves p along the normals to the layer at distance `target` (m). False where there is none close by.
bool moveToLayer(const Boundary& boundary, float target, float tolerance, Vec3f& p) {
  constexpr int kMoves = 6;
  for (int move = 0; move < kMoves; ++move) {
    Vec3f normal;
    const float off = boundary.distance(p, normal) - target;
    if (std::abs(off) <= tolerance) return true;
    p -= off * normal;
  }
  return std::abs(boundary.distance(p) - target) <= tolerance;
}

/// The candidates of one block for the layer at `target`, in the order of the lattice.
class Candidates {
 public:
  Candidates(const Boundary& boundary, float spacing, float depth)
      : boundary_(boundary), spacing_(spacing), depth_(depth), pitch_(spacing / kTriedAlong) {}

  /// Whether the block at `corner` may have candidates.
  bool any(const Vec3f& corner) const {
    const float edge = kBlock * pitch_;
    // No wall is nearer to anything in the block than its middle is, less half of its diagonal; a tenth more
    // for distances that are approximate.
    const float middle = boundary_.distance(corner + Vec3f::Constant(0.5F * edge));
    return std::abs(middle + 0.5F * depth_) <= 1.1F * 0.866F * edge + 0.5F * depth_ + pitch_;
  }

  void collect(const Vec3f& corner, std::vector<Vec3f>& layer, std::vector<Vec3f>& thin) const {
    if (!any(corner)) return;
    for (int z = 0; z < kBlock; ++z) {
      for (int y = 0; y < kBlock; ++y) {
        for (int x = 0; x < kBlock; ++x) {
          const Vec3f at =
              corner + pitch_ * Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
          const float distance = boundary_.distance(at);
          if (std::abs(distance + depth_) <= 0.87F * pitch_) {
            if (Vec3f p = at; moveToLayer(boundary_, -depth_, 0.02F * spacing_, p)) layer.push_back(p);
          }
          if (std::abs(distance) <= 0.87F * pitch_) addThin(at, thin);
        }
      }
    }
  }

 private:
  /// Where the solid behind a place of the wall is too thin for the layer: a point midway.
  void addThin(Vec3f p, std::vector<Vec3f>& thin) const {
    if (!moveToLayer(boundary_, 0, 0.02F * spacing_, p)) return;
    Vec3f normal;
    boundary_.distance(p, normal);
    if (boundary_.distance(p - depth_ * normal) <= -0.75F * depth_) return;
    Vec3f deepest = p;
    float least = 0;
    for (int part = 1; part < 8; ++part) {
      const Vec3f inside = p - static_cast<float>(part) / 8 * depth_ * normal;
      const float distance = boundary_.distance(inside);
      if (distance >= least) continue;
      least = distance, deepest = inside;
    }
    thin.push_back(deepest);
  }

  const Boundary& boundary_;
  float spacing_, depth_, pitch_;
};

/// Points of which no two are nearer than a distance, taken in the order in which they come.
class SparsePoints {
 public:
  explicit SparsePoints(float nearest) : nearest_(nearest) {}

  void add(const Vec3f& p) {
    const std::array<std::int64_t, 3> cell = cellOf(p);
    for (std::int64_t z = -1; z <= 1; ++z)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t x = -1; x <= 1; ++x)
          if (const auto known = cells_.find(key(cell[0] + x, cell[1] + y, cell[2] + z));
              known != cells_.end())
            for (const std::uint32_t other : known->second)
              if ((points_[other] - p).squaredNorm() < nearest_ * nearest_) return;
    cells_[key(cell[0], cell[1], cell[2])].push_back(static_cast<std::uint32_t>(points_.size()));
    points_.push_back(p);
  }
  std::size_t size() const { return points_.size(); }
  std::vector<Vec3f> take() { return std::move(points_); }

 private:
  std::array<std::int64_t, 3> cellOf(const Vec3f& p) const {
    const auto along = [&](int axis) { return static_cast<std::int64_t>(std::floor(p[axis] / nearest_)); };
    return {along(0), along(1), along(2)};
  }
  /// 21 bits for each axis: cells that share a key are far apart, and only cost time.
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(x) & kMask) | (static_cast<std::uint64_t>(y) & kMask) << 21 |
           (static_cast<std::uint64_t>(z) & kMask) << 42;
  }

  float nearest_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
  std::vector<Vec3f> points_;
};

[[noreturn]] void refuse(const std::string& place) {
  throw InputError(place,
                   "expected walls that 20 million boundary particles at most can cover, found larger "
                   "ones; \"gamma\" needs none, and a larger spacing fewer");
}

}  // namespace

std::vector<Vec3f> sampleWalls(const Boundary& boundary, const Bounds& region, float spacing, float depth,
                               ThreadPool& pool, const std::string& place) {
  if (boundary.empty() || region.empty()) return {};
  const double edge = static_cast<double>(spacing) * kBlock / kTriedAlong;
  const Bounds grown = region.grown(static_cast<double>(depth + spacing));
  const Vec3d blocks = (grown.size() / edge).array().ceil();
  if (blocks.prod() > kMostBlocks) refuse(place);
  const auto across = static_cast<std::size_t>(blocks.x()), up = static_cast<std::size_t>(blocks.y());
  const auto slabs = static_cast<std::size_t>(blocks.z());

  const Candidates candidates(boundary, spacing, depth);
  const auto inSlabs = [&](const auto& ofBlock) {
    pool.run(slabs, [&](std::size_t slab) {
      for (std::size_t k = 0; k < across * up; ++k) {
        const std::size_t x = k % across, y = k / across;
        const Vec3d index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(slab));
        ofBlock(slab, (grown.min + edge * index).cast<float>());
      }
    });
  };
  std::vector<std::size_t> blocksNear(slabs, 0);
  inSlabs(
      [&](std::size_t slab, const Vec3f& corner) { blocksNear[slab] += candidates.any(corner) ? 1U : 0U; });
  requireMemory(kBytesPerBlock * std::accumulate(blocksNear.begin(), blocksNear.end(), 0.0),
                "boundary particles", place);
  std::vector<std::vector<Vec3f>> layers(slabs), thins(slabs);
  inSlabs(
      [&](std::size_t slab, const Vec3f& corner) { candidates.collect(corner, layers[slab], thins[slab]); });

  SparsePoints points(kNearest * spacing);
  for (const std::vector<Vec3f>& slab : layers) {
    for (const Vec3f& p : slab) points.add(p);
    if (points.size() > kMostParticles) refuse(place);
  }
  // Of thin parts the middle first: what lies at their rims is near to that.
  std::vector<std::pair<long, Vec3f>> thin;
  for (const std::vector<Vec3f>& slab : thins)
    for (const Vec3f& p : slab) thin.emplace_back(std::lround(20 * boundary.distance(p) / spacing), p);
  std::stable_sort(thin.begin(), thin.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [depthRank, p] : thin) points.add(p);
  if (points.size() > kMostParticles) refuse(place);
  return points.take();
}

BoundaryParticles::BoundaryParticles(const std::vector<Vec3f>& places, KernelType kernel, float supportRadius,
                                     ThreadPool& pool)
    : inverseSupport_(1 / supportRadius) {
  std::vector<Float4> unsorted;
  unsorted.reserve(places.size());
  for (const Vec3f& p : places) unsorted.emplace_back(p);
  grid_.build(unsorted, supportRadius, pool);
  for (const std::uint32_t k : grid_.order()) particles_.push_back(unsorted[k]);
  std::vector<float> volumes(particles_.size());
  withKernel(kernel, [&](auto type) {
    using Kernel = decltype(type);
    parallelFor(pool, particles_.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t b = begin; b < end; ++b) {
        float sum = 0;
        around(particles_[b].xyz(), [&](const Vec3f&, float q, float) { sum += Kernel::value(q); });
        volumes[b] = 1 / sum;
      }
    });
  });
  for (std::size_t b = 0; b < particles_.size(); ++b) particles_[b].w = volumes[b];
}

}  // namespace migiwa
