// Picks the method at every point by the walls in reach there:
//   planes at right angles, or one alone    product   closed forms
//   planes at other angles, the rims of
//   thin walls, meshes                      facets    sums over edges
//   curved walls, meshes that are nowhere
//   thin                                    baked, if the grid is soon made, else directions
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/gamma/batches.h"
#include "core/gamma/gamma_method.h"
#include "core/gamma/half_spaces.h"

namespace migiwa {

namespace {

/// Appends to a list.
void addName(std::string& list, std::string_view name) {
  if (!list.empty()) list += ", ";
  list += name;
}

/// Whether a list of names has one.
bool hasName(std::string_view list, std::string_view name) {
  return (", " + std::string(list) + ",").find(", " + std::string(name) + ",") != std::string::npos;
}

enum Pick : std::size_t { kProduct, kFacets, kCurved };
constexpr std::size_t kPicks = 3;

class AutoGamma final : public GammaMethod {
 public:
  AutoGamma(const GammaContext& context, bool withGrid)
      : boundary_(context.boundary),
        support_(context.supportRadius),
        flat_(FlatPlanes::of(boundary_, support_)),
        methods_{makeProductGamma(context), makeFacetsGamma(context), nullptr},
        blocks_(makeBlockGamma(context)),
        curved_(std::none_of(boundary_.surfaces().begin(), boundary_.surfaces().end(),
                             [](const auto& surface) { return surface->planar() || surface->faceted(); })) {
    if (std::unique_ptr<GridGamma> grid = withGrid ? makeAboutCurves(context) : nullptr) {
      grid_ = grid.get();
      methods_[kCurved] = std::move(grid);
    } else {
      methods_[kCurved] = makeDirectionsGamma(fine(context));
    }
  }

  void wallsMoved() override {
    flat_ = FlatPlanes::of(boundary_, support_);
    for (const auto& method : methods_) method->wallsMoved();
  }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    if (curved_) return methods_[kCurved]->evaluate(points, out);
    // Gathered by method, so that each has a batch. Batches are short: the memory stays.
    thread_local Gathered gathered;
    auto& [picked, others, at, samples, walls] = gathered;
    for (std::vector<std::size_t>& those : picked) those.clear();
    if (flat_) {
      methods_[kProduct]->evaluate(points, out);
      if (flat_->rightAngled()) return;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (flat_->obliqueAt(points[i].xyz())) picked[kFacets].push_back(i);
    } else {
      const auto choose = [&](std::size_t i) {
        if (out[i].distance < support_) gathered.picked[pick(points[i].xyz(), gathered.walls)].push_back(i);
      };
      if (blocks_ != nullptr) {
        others.clear();
        blocks_->evaluate(points, out, others);
        std::for_each(others.begin(), others.end(), choose);
      } else {
        measure(boundary_, points, out);
        for (std::size_t i = 0; i < points.size(); ++i) choose(i);
      }
    }
    for (std::size_t method = 0; method < picked.size(); ++method) {
      if (picked[method].empty()) continue;
      at.clear();
      samples.clear();
      for (const std::size_t i : picked[method]) {
        at.push_back(points[i]);
        samples.emplace_back().distance = out[i].distance;
      }
      methods_[method]->evaluateMeasured(at, samples);
      for (std::size_t k = 0; k < at.size(); ++k) out[picked[method][k]] = samples[k];
    }
  }

  long takeOutOfRange() const override {
    long count = blocks_ != nullptr ? blocks_->takeOutOfRange() : 0;
    for (const auto& method : methods_) count += method->takeOutOfRange();
    return count;
  }

  GammaChoice choice() const override {
    const auto& surfaces = boundary_.surfaces();
    const auto any = [&](const auto& of) { return std::any_of(surfaces.begin(), surfaces.end(), of); };
    const bool planes = any([](const auto& s) { return s->planar(); });
    const bool curves = any([](const auto& s) { return !s->planar() && !s->faceted(); });
    const bool meshes = any([](const auto& s) { return s->faceted() && !s->planar(); });
    const bool rims = any([this](const auto& s) { return s->planar() && s->thickness() < support_; });
    const bool angles = obliquePlanesMeet();
    // A grid has no thin parts.
    const bool thinMeshes = any([this](const auto& s) {
      return s->faceted() && !s->planar() &&
             s->thinWithin(s->bounds().center().template cast<float>(),
                           static_cast<float>(s->bounds().size().norm()) + support_, support_);
    });
    const bool facetsOfMeshes = meshes && (grid_ == nullptr || thinMeshes);
    const bool facets = rims || angles || facetsOfMeshes;
    const bool baked = grid_ != nullptr && (curves || meshes);

    GammaChoice choice;
    if (planes) addName(choice.name, "product");
    if (facets) addName(choice.name, "facets");
    if (baked) addName(choice.name, "baked");
    if (curves && !baked) addName(choice.name, "directions");
    if (!facets && !baked && !curves) {
      choice.reason = "all walls are planes, parallel or at right angles";
      return choice;
    }
    choice.reason = curved_ ? "all walls are curved" : "by the walls in reach of each particle";
    std::string kinds;
    if (planes) addName(kinds, angles ? "planes at various angles" : "planes");
    if (rims) addName(kinds, "the rims of walls thinner than the support radius");
    if (facetsOfMeshes) addName(kinds, grid_ == nullptr ? "meshes" : "thin parts of meshes");
    if (!kinds.empty()) choice.reason += ": " + kinds;
    if (baked)
      choice.reason +=
          std::string(curves ? "; curved walls: " : "; meshes: ") + methods_[kCurved]->choice().reason;
    else if (curves)
      choice.reason += "; curved walls too large for a grid that is made in a few seconds: 1024 directions";
    return choice;
  }

 private:
  /// The points of a batch by what they go to.
  struct Gathered {
    std::array<std::vector<std::size_t>, kPicks> picked;
    std::vector<std::size_t> others;  ///< that blocks_ leaves
    // Of one pick:
    std::vector<Float4> at;
    std::vector<GammaSample> samples;
    // Of one point:
    HalfSpaces walls;
  };

  /// A grid about the curved walls; null where there are none, or too large ones.
  static std::unique_ptr<GridGamma> makeAboutCurves(GammaContext context) {
    Bounds curves;
    for (const auto& surface : context.boundary.surfaces())
      if (!surface->planar()) curves.include(surface->bounds());
    if (curves.empty()) return nullptr;
    if (!context.region.empty()) {
      curves.min = curves.min.cwiseMax(context.region.min);
      curves.max = curves.max.cwiseMin(context.region.max);
      if (curves.empty()) return nullptr;
    }
    context.region = curves;
    return makeBakedGammaIfQuick(context);
  }

  /// Enough directions to stay within 0.004 wherever they are used.
  static GammaContext fine(GammaContext context) {
    context.directions = 1024;
    return context;
  }

  static bool acrossEachOther(const Vec3f& a, const Vec3f& b) {
    const float cosine = std::abs(a.dot(b));
    return cosine < 1e-3F || cosine > 0.999F;
  }

  /// Whether a particle may have two planes in reach that are not at right angles, of what counts together:
  /// all tanks, with each block.
  bool obliquePlanesMeet() const {
    const std::span<const std::shared_ptr<MovingSurface>> moving = boundary_.moving();
    if (std::any_of(moving.begin(), moving.end(), [](const auto& wall) { return wall->motion().turns; }))
      return true;
    constexpr float kEverywhere = std::numeric_limits<float>::infinity();
    std::vector<WallPiece> tanks, block;
    for (const auto& surface : boundary_.surfaces())
      if (surface->planar() && surface->pieceRule() == PieceRule::fluidInsideAll)
        surface->pieces(Vec3f::Zero(), kEverywhere, tanks);
    for (std::size_t k = 0; k < tanks.size(); ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (!acrossEachOther(tanks[k].normal, tanks[l].normal)) return true;
    for (const auto& surface : boundary_.surfaces()) {
      if (!surface->planar() || surface->pieceRule() == PieceRule::fluidInsideAll) continue;
      block.clear();
      surface->pieces(Vec3f::Zero(), kEverywhere, block);
      const Vec3f center = surface->bounds().center().cast<float>();
      const Vec3f half = 0.5F * surface->bounds().size().cast<float>();
      for (const WallPiece& plane : tanks) {
        const float distance = plane.planeDistance + plane.normal.dot(center);
        if (!boundary_.moves() && distance - half.dot(plane.normal.cwiseAbs()) >= 2 * support_) continue;
        for (const WallPiece& face : block)
          if (!acrossEachOther(plane.normal, face.normal)) return true;
      }
    }
    return false;
  }

  Pick pick(const Vec3f& p, HalfSpaces& walls) const {
    if (grid_ != nullptr && grid_->covers(p)) return kCurved;
    bool meshes = false;
    for (const Surface* surface : boundary_.near(p, support_)) {
      if (surface->planar()) continue;
      Vec3f normal;
      if (surface->distance(p, normal) >= support_) continue;
      if (!surface->faceted()) return kCurved;
      meshes = true;
    }
    if (meshes || walls.collect(boundary_, p, support_, true)) return kFacets;
    Pick most = ofPlanes(walls.tanks());
    for (const std::vector<HalfSpace>& block : walls.blocks()) most = std::max(most, ofPlanes(block));
    return most;
  }

  static Pick ofPlanes(std::span<const HalfSpace> planes) {
    for (std::size_t k = 0; k < planes.size(); ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (!acrossEachOther(planes[k].normal, planes[l].normal)) return kFacets;
    return kProduct;
  }

  const Boundary& boundary_;
  float support_;
  std::optional<FlatPlanes> flat_;
  std::unique_ptr<GammaMethod> methods_[kPicks];
  std::unique_ptr<BlockGamma> blocks_;  ///< in place of facets where it can; null: nowhere
  const GridGamma* grid_ = nullptr;     ///< the last, if it is one
  bool curved_;                         ///< all walls are
};

}  // namespace

std::unique_ptr<GammaMethod> makeAutoGammaWithoutGrid(const GammaContext& context) {
  return std::make_unique<AutoGamma>(context, false);
}

std::unique_ptr<GammaMethod> makeAutoGamma(const GammaContext& context) {
  const auto& surfaces = context.boundary.surfaces();
  const bool curves =
      std::any_of(surfaces.begin(), surfaces.end(), [](const auto& surface) { return !surface->planar(); });
  // Closed forms follow planes wherever they go; a grid goes along with its wall.
  if (context.boundary.moves() && curves) return makeMovingGamma(context, makeAutoGamma);
  return std::make_unique<AutoGamma>(context, true);
}

// gamma where walls move: those that move as one keep their shape, so in their own frame gamma stays what it
// is, and what is costly to look at needs a grid only once. Where walls of several frames are in reach of a
// point their solids may overlap, and gamma is found anew from all of them.

namespace {

class MovingGamma final : public GammaMethod {
 public:
  MovingGamma(const GammaContext& context, std::unique_ptr<GammaMethod> (*make)(const GammaContext&))
      : boundary_(context.boundary),
        support_(context.supportRadius),
        whole_(makeAutoGammaWithoutGrid(context)) {
    std::vector<std::shared_ptr<const Surface>> still;
    for (const auto& surface : boundary_.surfaces())
      if (dynamic_cast<const MovingSurface*>(surface.get()) == nullptr) still.push_back(surface);
    if (!still.empty()) addFrame(context, nullptr, std::move(still), make);
    for (const auto& wall : boundary_.moving()) {
      const auto known = std::find_if(frames_.begin(), frames_.end(), [&](const Frame& frame) {
        return frame.mover != nullptr && frame.mover->group() == wall->group();
      });
      if (known != frames_.end()) continue;
      std::vector<std::shared_ptr<const Surface>> rest;
      for (const auto& other : boundary_.moving())
        if (other->group() == wall->group()) rest.push_back(other->rest());
      GammaContext alone = context;
      alone.region = {};
      addFrame(alone, wall.get(), std::move(rest), make);
    }
  }

  GammaChoice choice() const override {
    GammaChoice result{"", "walls that move, each in its own frame"};
    const auto addNames = [&result](std::string_view names) {
      while (!names.empty()) {
        const std::string_view name = names.substr(0, names.find(", "));
        if (!hasName(result.name, name)) addName(result.name, name);
        names.remove_prefix(std::min(names.size(), name.size() + 2));
      }
    };
    for (const Frame& frame : frames_) {
      const GammaChoice own = frame.method->choice();
      addNames(own.name);
      result.reason += "; " + std::string(frame.mover == nullptr ? "still: " : "moving: ") + own.reason;
    }
    if (frames_.size() < 2) return result;
    const std::string whole = whole_->choice().name;
    addNames(whole);
    result.reason += "; where several are in reach: " + whole;
    return result;
  }

  long takeOutOfRange() const override {
    long count = whole_->takeOutOfRange();
    for (const Frame& frame : frames_) count += frame.method->takeOutOfRange();
    return count;
  }

  void wallsMoved() override { whole_->wallsMoved(); }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    // Gathered by frame, so that each method has a batch; the last is for points that see several.
    std::vector<std::vector<std::size_t>> picked(frames_.size() + 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      std::size_t frame = frames_.size();
      int inReach = 0;
      float nearest = std::numeric_limits<float>::infinity();
      for (std::size_t k = 0; k < frames_.size(); ++k) {
        const float distance = frames_[k].boundary->distance(frames_[k].toRest(p));
        nearest = std::min(nearest, distance);
        if (distance >= support_) continue;
        frame = inReach++ == 0 ? k : frames_.size();
      }
      out[i] = GammaSample{};
      out[i].distance = nearest;
      if (inReach > 0) picked[frame].push_back(i);
    }
    std::vector<Float4> at;
    std::vector<GammaSample> samples;
    for (std::size_t k = 0; k < picked.size(); ++k) {
      if (picked[k].empty()) continue;
      const Frame* const frame = k < frames_.size() ? &frames_[k] : nullptr;
      at.clear();
      for (const std::size_t i : picked[k])
        at.emplace_back(frame != nullptr ? frame->toRest(points[i].xyz()) : points[i].xyz());
      samples.resize(at.size());
      (frame != nullptr ? frame->method : whole_)->evaluate(at, samples);
      const MovingSurface* const mover = frame != nullptr ? frame->mover : nullptr;
      for (std::size_t n = 0; n < at.size(); ++n) {
        GammaSample& sample = out[picked[k][n]];
        const float distance = sample.distance;
        sample = samples[n];
        sample.distance = distance;
        if (mover == nullptr) continue;
        sample.gradient = mover->directionToWorld(sample.gradient);
        sample.pairGradient = mover->directionToWorld(sample.pairGradient);
      }
    }
  }

 private:
  /// Walls that move as one, as they are described.
  struct Frame {
    const MovingSurface* mover;  ///< one of them; null: they stand still
    std::unique_ptr<const Boundary> boundary;
    std::unique_ptr<GammaMethod> method;

    Vec3f toRest(const Vec3f& p) const { return mover != nullptr ? mover->toRest(p) : p; }
  };

  void addFrame(const GammaContext& context, const MovingSurface* mover,
                std::vector<std::shared_ptr<const Surface>> surfaces,
                std::unique_ptr<GammaMethod> (*make)(const GammaContext&)) {
    auto boundary = std::make_unique<const Boundary>(Boundary::atRest(std::move(surfaces)));
    const GammaContext own{*boundary,       context.kernel, context.supportRadius, context.directions,
                           context.samples, context.region, context.pool,          context.place};
    std::unique_ptr<GammaMethod> method = make(own);
    frames_.push_back({mover, std::move(boundary), std::move(method)});
  }

  const Boundary& boundary_;
  float support_;
  std::unique_ptr<GammaMethod> whole_;
  std::vector<Frame> frames_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeMovingGamma(const GammaContext& context,
                                             std::unique_ptr<GammaMethod> (*make)(const GammaContext&)) {
  return std::make_unique<MovingGamma>(context, make);
}

}  // namespace migiwa
