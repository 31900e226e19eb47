// gamma from a grid about the walls that is made once and kept on disk: for walls that stand still and cost
// much to look at. Where a thin wall is near, deep in the solid and outside the grid, directions take its
// place.
#include <algorithm>
#include <cstdio>
#include <limits>

#include "core/base/disk_cache.h"
#include "core/boundary/gamma/bake.h"
#include "core/boundary/gamma/gamma_methods.h"
#include "core/boundary/gamma/grid_cache.h"

namespace migiwa {

namespace {

/// Cells along a support radius: with these the grid is within 0.005.
constexpr float kCellsPerSupport = 5;
/// Some seconds on one core: blocks with coefficients, and all of them.
constexpr double kQuickUsed = 2e4, kQuickBlocks = 1e6;

class BakedGamma final : public GridGamma {
 public:
  /// A grid of more blocks than `mostBlocks` is not even laid out.
  explicit BakedGamma(const GammaContext& context, bool curvedOnly = false,
                      double mostBlocks = std::numeric_limits<double>::infinity())
      : boundary_(context.boundary),
        exact_(exactWalls(boundary_)),
        support_(context.supportRadius),
        elsewhere_(makeDirectionsGamma(fine(context))),
        ownPool_(context.pool != nullptr ? nullptr : std::make_unique<ThreadPool>(1)),
        pool_(context.pool != nullptr ? *context.pool : *ownPool_) {
    Bounds region = context.region;
    if (region.empty())
      for (const auto& surface : boundary_.surfaces()) region.include(surface->bounds());
    if (region.empty()) {
      reason_ = "walls without end and no fluid: 1024 directions instead of a grid";
      return;
    }
    settings_ = {context.kernel,
                 support_,
                 support_ / kCellsPerSupport,
                 region.grown(static_cast<double>(support_)),
                 curvedOnly,
                 context.place};
    if (blocksIn(settings_) <= mostBlocks) grid_ = layOut(exact_, settings_, pool_);
  }

  bool laidOut() const { return !grid_.blocks.empty(); }
  /// Blocks to be filled.
  double used() const {
    return static_cast<double>(
        std::count_if(grid_.blocks.begin(), grid_.blocks.end(), [](auto at) { return at >= 0; }));
  }

  /// Reads the grid or makes it.
  void fill() {
    if (!laidOut()) return;
    const std::string source = readOrMake();
    const double mebibytes = static_cast<double>(grid_.coefficients.size() * sizeof(float)) / (1024.0 * 1024);
    char text[64];
    std::snprintf(text, sizeof text, "a grid of %.1f MiB, ", mebibytes);
    reason_ = text + source;
  }

  GammaChoice choice() const override { return {"baked", reason_}; }
  bool covers(const Vec3f& p) const override { return laidOut() && grid_.placeOf(p).state >= 0; }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(points[i].xyz());
    }
    evaluateMeasured(points, out);
  }

  void evaluateMeasured(std::span<const Float4> points, std::span<GammaSample> out) const override {
    std::array<GammaGrid::Place, kBatch> places;
    for (std::size_t begin = 0; begin < points.size(); begin += kBatch) {
      const std::size_t count = std::min(kBatch, points.size() - begin);
      const auto at = points.subspan(begin, count);
      const auto samples = out.subspan(begin, count);
      for (std::size_t i = 0; i < count; ++i) {
        places[i].state = GammaGrid::kFar;
        if (samples[i].distance < support_) places[i] = grid_.placeOf(at[i].xyz());
        if (places[i].state == GammaGrid::kElsewhere)
          elsewhere_->evaluate(at.subspan(i, 1), samples.subspan(i, 1));
      }
      interpolate(grid_, support_, std::span(places).first(count), samples);
    }
  }

 private:
  static constexpr std::size_t kBatch = 64;

  static Boundary exactWalls(const Boundary& boundary) {
    std::vector<std::shared_ptr<const Surface>> surfaces;
    for (const auto& surface : boundary.surfaces()) {
      const std::shared_ptr<const Surface> exact = surface->exact();
      surfaces.push_back(exact != nullptr ? exact : surface);
    }
    return Boundary::atRest(std::move(surfaces));
  }

  static GammaContext fine(GammaContext context) {
    context.directions = 1024;
    return context;
  }

  /// Says what it did.
  std::string readOrMake() {
    const std::string key = keyOf(settings_);
    const std::filesystem::path folder = cacheFolder();
    const std::filesystem::path file = folder.empty() ? folder : gridFile(folder, key);
    if (!file.empty()) {
      if (std::optional<GammaGrid> known = readGrid(file, key)) {
        grid_ = *std::move(known);
        return "read from " + file.string();
      }
    }
    bake(exact_, settings_, pool_, grid_);
    const bool kept = !file.empty() && writeGrid(file, key, grid_);
    return kept ? "made and kept in " + file.string()
                : "made and not kept: no folder to write to; MIGIWA_CACHE in the environment can name one";
  }

  /// Everything that the grid depends on.
  std::string keyOf(const BakeSettings& settings) const {
    char text[256];
    std::snprintf(text, sizeof text, "kernel %d support %a cell %a curved %d region %a %a %a %a %a %a\n",
                  static_cast<int>(settings.kernel), static_cast<double>(settings.supportRadius),
                  static_cast<double>(settings.cell), settings.curvedOnly ? 1 : 0, settings.region.min.x(),
                  settings.region.min.y(), settings.region.min.z(), settings.region.max.x(),
                  settings.region.max.y(), settings.region.max.z());
    return text + describeWalls(exact_);
  }

  const Boundary& boundary_;
  Boundary exact_;  ///< the same walls without grids of distances: what the grid of gamma is made from
  float support_;
  std::unique_ptr<GammaMethod> elsewhere_;
  std::unique_ptr<ThreadPool> ownPool_;
  ThreadPool& pool_;
  BakeSettings settings_{};
  GammaGrid grid_;
  std::string reason_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeBakedGamma(const GammaContext& context) {
  if (context.boundary.moves()) return makeMovingGamma(context, makeBakedGamma);
  auto method = std::make_unique<BakedGamma>(context);
  method->fill();
  return method;
}

std::unique_ptr<GridGamma> makeBakedGammaIfQuick(const GammaContext& context) {
  auto method = std::make_unique<BakedGamma>(context, true, kQuickBlocks);
  if (!method->laidOut() || method->used() > kQuickUsed) return nullptr;
  method->fill();
  return method;
}

}  // namespace migiwa
