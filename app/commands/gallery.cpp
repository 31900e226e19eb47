// What `migiwa view` can open: the scenes that are shipped, those that were open last, and scenes that are
// made around a mesh, points or a SLIM surface.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "app/commands/command.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/scene/json.h"
#include "core/slim/file.h"
#include "core/slim/shape_import.h"

namespace migiwa {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRecent = 6;
/// Particles along the diagonal of a shape that is dropped on the window.
constexpr double kResolution = 30;
/// Of a mesh that becomes a wall as it is; a SLIM surface is fitted to larger ones.
constexpr std::size_t kMostTriangles = 5000;

/// The root of a JSON file; null for what is none.
Json rootOf(const fs::path& file) {
  try {
    return parseJson(readTextFile(file, "a scene file")).root;
  } catch (const InputError&) {
    return {};
  }
}

std::string wordOf(const Json& root, const char* key) {
  const auto found = root.find(key);
  return found != root.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool isScene(const Json& root) {
  return root.is_object() && (root.contains("format") ? root["format"] == 1 : root.contains("include"));
}

/// Nothing for what is no scene.
std::optional<GalleryEntry> entryOf(const fs::path& file, const fs::path& pictures) {
  const Json root = rootOf(file);
  if (!isScene(root)) return std::nullopt;
  GalleryEntry entry{file, {}, wordOf(root, "name"), wordOf(root, "description")};
  if (entry.name.empty()) entry.name = file.stem().string();
  std::error_code ignored;
  const fs::path picture = pictures / (file.stem().string() + ".png");
  if (fs::exists(picture, ignored)) entry.picture = picture;
  return entry;
}

/// Empty where nothing is kept.
fs::path recentFile() {
  const fs::path folder = cacheFolder();
  return folder.empty() ? fs::path() : folder / "recent_scenes";
}

/// The last one first; those that are no longer there are left out.
std::vector<fs::path> recentScenes() {
  std::vector<fs::path> files;
  std::ifstream in(recentFile());
  std::error_code ignored;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && fs::exists(line, ignored)) files.emplace_back(line);
  return files;
}

void remember(const fs::path& scene) {
  const fs::path file = recentFile();
  if (file.empty()) return;
  std::vector<fs::path> files{fs::absolute(scene).lexically_normal()};
  for (const fs::path& known : recentScenes())
    if (known != files.front() && files.size() < kMostRecent) files.push_back(known);
  writeCacheFile(file, [&](std::ostream& out) {
    for (const fs::path& recent : files) out << recent.string() << '\n';
  });
}

Json vectorOf(const Vec3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

/// Of the nodes' centres.
Bounds boundsOf(const SlimData& data) {
  Bounds bounds;
  for (const auto& node : data.nodes) bounds.include(node.centre.cast<double>());
  return bounds;
}

/// A tank about the shape, and a block of water above it that falls on it.
Json sceneAround(const Json& surface, const Bounds& bounds, const std::string& name) {
  const Vec3d size = bounds.size(), middle = bounds.center();
  const double diagonal = size.norm();
  const Vec3d aside(0.25 * diagonal, 0, 0.25 * diagonal);
  const Vec3d low = bounds.min - aside, high = bounds.max + aside + Vec3d(0, 0.9 * diagonal, 0);
  const Vec3d block(0.4 * std::max(size.x(), 0.3 * diagonal), 0, 0.4 * std::max(size.z(), 0.3 * diagonal));
  Vec3d waterLow = middle - block, waterHigh = middle + block;
  waterLow.y() = bounds.max.y() + 0.1 * diagonal;
  waterHigh.y() = bounds.max.y() + 0.6 * diagonal;
  // Boxes are filled in whole spacings.
  const double spacing = diagonal / kResolution;
  for (int k = 0; k < 3; ++k)
    waterHigh[k] = waterLow[k] + spacing * std::max(1.0, std::round((waterHigh[k] - waterLow[k]) / spacing));
  const Vec3d target(middle.x(), 0.5 * (low.y() + high.y()), middle.z());
  Json scene = Json::object();
  scene["format"] = 1;
  scene["name"] = name;
  scene["description"] = "Made around " + name + ": a block of water falls on it in a tank.";
  scene["duration"] = 4;
  scene["particle_spacing"] = spacing;
  scene["fluid"] =
      Json::array({{{"shape", "box"}, {"min", vectorOf(waterLow)}, {"max", vectorOf(waterHigh)}}});
  scene["boundary"]["surfaces"] = Json::array(
      {surface, {{"shape", "box"}, {"fluid", "inside"}, {"min", vectorOf(low)}, {"max", vectorOf(high)}}});
  scene["view"]["camera"] = {{"eye", vectorOf(target + Vec3d(0.7, 0.6, 2.6) * diagonal)},
                             {"target", vectorOf(target)},
                             {"up", {0, 1, 0}},
                             {"fov_degrees", 40}};
  return scene;
}

/// Whether the file holds a JSON object that is no mesh, whatever its name ends in.
bool isObject(const fs::path& file) {
  if (file.extension() == ".gltf") return false;
  std::ifstream in(file);
  char first = 0;
  return in >> first && first == '{';
}

/// The scene file itself, or one that is made around what the file holds. One that was made before is taken
/// as it is: the user may have changed it.
fs::path sceneFileFor(const fs::path& file) {
  Json surface{{"shape", "slim"}, {"fluid", "outside"}};
  Bounds bounds;
  if (file.extension() == ".json" || isObject(file)) {
    const Json root = rootOf(file);
    if (!root.is_object() || !root.contains("format") || !root["format"].is_string()) return file;
    bounds = boundsOf(readSlimFile(file));
    surface["file"] = fs::absolute(file).string();
  } else {
    const ImportedShape shape = importShape(file);
    bounds = shape.bounds();
    // A wall of all its triangles takes minutes to prepare where there are many; a fit takes seconds.
    const bool exact = shape.isMesh() && (shape.mesh.triangles.size() <= kMostTriangles || shape.branching);
    if (exact) surface["shape"] = "mesh";
    surface[exact ? "file" : "mesh"] = fs::absolute(file).string();
  }
  const fs::path folder =
      cacheFolder().empty() ? fs::temp_directory_path() / "migiwa_opened" : cacheFolder() / "opened";
  fs::create_directories(folder);
  const std::string text = prettyJson(sceneAround(surface, bounds, file.filename().string()));
  // Files of one name in several folders, and another shape in the same file, have scenes of their own.
  const std::string which = hexDigits(checksum(kEmptyChecksum, text.data(), text.size())).substr(0, 8);
  fs::path scene = folder / (file.stem().string() + '-' + which + ".json");
  if (!fs::exists(scene)) writeTextFile(scene, text);
  return scene;
}

}  // namespace

std::vector<GalleryEntry> galleryEntries() {
  std::vector<GalleryEntry> entries;
  fs::path shipped;
  try {
    shipped = shippedPlace("scenes", "SCENE", "the folder of the shipped scenes");
  } catch (const InputError&) {
    // The window can do without.
  }
  const fs::path pictures = shipped / "thumbnails";
  for (const fs::path& file : recentScenes()) {
    std::optional<GalleryEntry> entry = entryOf(file, pictures);
    if (!entry) continue;
    entry->recent = true;
    entries.push_back(std::move(*entry));
  }
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const fs::directory_entry& file : fs::directory_iterator(shipped, ignored))
    if (file.path().extension() == ".json") files.push_back(file.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    if (std::optional<GalleryEntry> entry = entryOf(file, pictures)) entries.push_back(std::move(*entry));
  return entries;
}

Scene openScene(const fs::path& file, const std::vector<Override>& overrides) {
  Scene scene = readScene(sceneFileFor(file), overrides);
  requireSteppable(scene.boundary, scene.file);
  remember(scene.file);
  return scene;
}

}  // namespace migiwa
