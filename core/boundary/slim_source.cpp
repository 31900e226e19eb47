#include "core/boundary/slim_source.h"

#include <deque>
#include <mutex>
#include <optional>

#include "core/base/disk_cache.h"
#include "core/boundary/slim_cache.h"
#include "core/slim/slim_file.h"
#include "core/slim/slim_rays.h"

namespace migiwa {

namespace {

/// A bowl's points: enough for a few thousand nodes.
constexpr std::size_t kBowlPoints = 200000;
/// Others, to judge it by.
constexpr std::size_t kJudgedBowlPoints = 100000;
/// Fits that are kept.
constexpr std::size_t kMostKept = 4;

/// Many points on a bowl, in its place.
OrientedPoints placedBowl(const SlimSource& source, std::size_t count) {
  OrientedPoints points = bowlPoints(source.bowl, count);
  for (OrientedPoint& point : points.points)
    point = {source.transform.point(point.position), source.transform.direction(point.normal)};
  return points;
}

/// Fits to what the source names, unless an earlier run has left the same fit behind.
SlimFit fitOf(const SlimSource& source, ThreadPool& pool) {
  const std::filesystem::path folder = cacheFolder();
  const std::string key = folder.empty() ? std::string() : slimFitKey(source);
  const std::filesystem::path file = key.empty() ? std::filesystem::path() : slimFitFile(folder, key);
  if (!key.empty())
    if (std::optional<SlimFit> known = readSlimFit(file, key)) return *std::move(known);
  SlimFit fit;
  OrientedPoints points;
  if (source.kind == SlimSource::Kind::bowl) {
    points = placedBowl(source, kBowlPoints);
  } else {
    ImportedShape shape = importShape(source.file);
    requireUnchanged(source.file, source.content());
    transformShape(shape, source.transform);
    points = fitPoints(shape, source.nodes);
    fit.notes = std::move(shape.notes);
  }
  SlimFitOptions options;
  options.degree = source.degree;
  options.tolerance = source.tolerance;
  options.nodes = source.nodes;
  if (source.tolerance <= 0 && source.nodes <= 0) {
    Bounds bounds;
    for (const OrientedPoint& point : points.points) bounds.include(point.position.cast<double>());
    options.tolerance = defaultSlimTolerance(bounds);
  }
  fit.data.nodes = fitSlim(points, options, pool);
  fit.data.degree = source.degree;
  fit.data.closed = points.closed;
  // A fit that cannot be kept costs the next start some seconds, no more.
  if (!key.empty()) writeSlimFit(file, key, fit);
  return fit;
}

std::shared_ptr<const SlimWallData> prepare(const SlimSource& source) {
  ThreadPool pool(0);
  auto result = std::make_shared<SlimWallData>();
  if (source.kind == SlimSource::Kind::slimFile) {
    SlimData data = readSlimFile(source.file);
    requireUnchanged(source.file, source.content());
    transformNodes(data.nodes, source.transform);
    transformNodes(data.hierarchy.merged, source.transform);
    if (std::string note = cutTo(data, source.tolerance, source.nodes); !note.empty())
      result->notes.push_back(std::move(note));
    result->model = std::make_unique<const SlimModel>(std::move(data.nodes), data.degree, data.closed, pool);
    result->thinnestPart = slimThickness(*result->model);
    return result;
  }
  SlimFit fit = fitOf(source, pool);
  result->notes = std::move(fit.notes);
  result->model =
      std::make_unique<const SlimModel>(std::move(fit.data.nodes), fit.data.degree, fit.data.closed, pool);
  result->thinnestPart = slimThickness(*result->model);
  return result;
}

struct Kept {
  SlimSource source;
  std::shared_ptr<const SlimWallData> data;
};

}  // namespace

const SlimMesh& SlimWallData::drawnMesh() const {
  std::call_once(extracted_, [this] {
    ThreadPool pool(0);
    mesh_ = extractSlimMesh(*model, pool);
  });
  return mesh_;
}

bool SlimSource::operator==(const SlimSource& other) const {
  return kind == other.kind && file == other.file && identity == other.identity && bowl == other.bowl &&
         degree == other.degree && tolerance == other.tolerance && nodes == other.nodes &&
         transform == other.transform;
}

FileIdentity SlimSource::content() const {
  if (kind == Kind::bowl) return {};
  return identity ? *identity : identityOf(file);
}

std::optional<double> slimFitError(const SlimSource& source, const SlimModel& model) {
  if (source.kind == SlimSource::Kind::slimFile) return std::nullopt;
  ThreadPool pool(0);
  if (source.kind == SlimSource::Kind::bowl)
    return measureSlim(model, placedBowl(source, kJudgedBowlPoints).points, pool).mean;
  if (source.identity && identityOf(source.file) != *source.identity) return std::nullopt;
  ImportedShape shape = importShape(source.file);
  transformShape(shape, source.transform);
  return measureSlim(model, shape, pool).mean;
}

std::shared_ptr<const SlimWallData> prepareSlim(const SlimSource& asked) {
  // The only state that outlives a scene: comparisons and restarts read the same scene again and again, and a
  // fit takes seconds. Fits do not depend on when and where they are made, so nobody sees a difference.
  static std::mutex mutex;
  static std::deque<Kept> kept;
  SlimSource source = asked;
  source.identity = asked.content();
  const std::lock_guard lock(mutex);
  if (!MadeAnew::active())
    for (const Kept& known : kept)
      if (known.source == source) return known.data;
  kept.push_front({source, prepare(source)});
  if (kept.size() > kMostKept) kept.pop_back();
  return kept.front().data;
}

}  // namespace migiwa
