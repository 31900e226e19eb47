#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/slim/file.h"
#include "core/slim/model.h"
#include "core/walls/slim_wall.h"

namespace migiwa {

namespace {

/// A bowl's points: enough for a few thousand nodes.
constexpr std::size_t kBowlPoints = 200000;
/// Others, to judge it by.
constexpr std::size_t kJudgedBowlPoints = 100000;
/// Fits that are kept.
constexpr std::size_t kMostKept = 4;

/// Many points on a bowl, in its place. One whose centre is so far from zero that floats miss its thickness
/// is moved by `transform` before its points are made.
OrientedPoints placedBowl(const SlimSource& source, std::size_t count) {
  constexpr double kFar = 1000;
  Bowl bowl = source.bowl;
  Transform transform = source.transform;
  if (bowl.center.norm() > kFar * (bowl.radius + bowl.height)) {
    bowl.center += transform.rotate.matrix().transpose() * transform.translate / transform.scale;
    transform.translate.setZero();
  }
  OrientedPoints points = bowlPoints(bowl, count);
  for (OrientedPoint& point : points.points)
    point = {transform.point(point.position), transform.direction(point.normal)};
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
  Activity activity("fitting a SLIM surface to " + std::to_string(points.points.size()) + " points");
  fit.data.nodes = fitSlim(points, options, pool, [&](double part) { activity.reach(part); });
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

std::shared_ptr<const SlimWallData> prepareSlim(const SlimSource& source) {
  static KeptResults<SlimSource, std::shared_ptr<const SlimWallData>> kept(kMostKept);
  SlimSource known = source;
  known.identity = source.content();
  return kept.get(known, prepare);
}

namespace fs = std::filesystem;

namespace {

/// Raised whenever the file, or what a fit gives, changes.
constexpr int kVersion = 3;

/// FNV-1a.
std::uint64_t hashOf(std::string_view text) {
  std::uint64_t sum = 0xCBF29CE484222325U;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return sum;
}

std::optional<std::string> contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) return std::nullopt;
  return std::move(text).str();
}

void add(std::string& key, const char* name, std::initializer_list<double> values) {
  key += std::string(" ") + name;
  char digits[32];
  for (const double value : values) {
    std::snprintf(digits, sizeof digits, " %a", value);
    key += digits;
  }
}

std::string header(const std::string& key, std::string_view body) {
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "%zu %016llx", body.size(),
                static_cast<unsigned long long>(hashOf(body)));
  return "migiwa-slim-fit " + std::to_string(kVersion) + "\n" + key + "\n" + numbers + "\n";
}

}  // namespace

std::string slimFitKey(const SlimSource& source) {
  std::string key;
  if (source.kind == SlimSource::Kind::bowl) {
    const Bowl& bowl = source.bowl;
    add(key, "bowl",
        {bowl.center.x(), bowl.center.y(), bowl.center.z(), bowl.radius, bowl.thickness, bowl.height});
  } else {
    const FileIdentity content = source.content();
    if (content.bytes == 0) return {};
    // The reader goes by the name's ending.
    key = "file " + content.text() + " " + source.file.extension().string();
  }
  add(key, "fit", {static_cast<double>(source.degree), source.tolerance, static_cast<double>(source.nodes)});
  const Transform& place = source.transform;
  add(key, "transform",
      {place.scale, place.rotate.axis.x(), place.rotate.axis.y(), place.rotate.axis.z(), place.rotate.degrees,
       place.translate.x(), place.translate.y(), place.translate.z()});
  return key;
}

fs::path slimFitFile(const fs::path& folder, const std::string& key) {
  char name[32];
  std::snprintf(name, sizeof name, "slim_%016llx.fit", static_cast<unsigned long long>(hashOf(key)));
  return folder / name;
}

std::optional<SlimFit> readSlimFit(const fs::path& file, const std::string& key) {
  if (CacheBypass::active()) return std::nullopt;
  const std::optional<std::string> text = contentOf(file);
  if (!text) return std::nullopt;
  // Magic and version, key, size and checksum: three lines, the rest is the body.
  std::size_t end = 0;
  for (int line = 0; line < 3; ++line) {
    end = text->find('\n', end);
    if (end == std::string::npos) return std::nullopt;
    ++end;
  }
  std::string body = text->substr(end);
  if (text->substr(0, end) != header(key, body)) return std::nullopt;
  SlimFit fit;
  while (body.starts_with("note ")) {
    const std::size_t eol = body.find('\n');
    fit.notes.push_back(body.substr(5, eol - 5));
    body.erase(0, eol + 1);
  }
  try {
    fit.data = parseSlimFile(body, file.string());
  } catch (const InputError&) {
    return std::nullopt;
  }
  return fit;
}

bool writeSlimFit(const fs::path& file, const std::string& key, const SlimFit& fit) {
  std::string body;
  for (const std::string& note : fit.notes) body += "note " + note + "\n";
  body += slimFileText(fit.data);
  return writeCacheFile(file, [&](std::ostream& out) { out << header(key, body) << body; });
}

}  // namespace migiwa
