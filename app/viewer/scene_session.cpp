#include "app/viewer/scene_session.h"

#include <chrono>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/io/output_file.h"
#include "core/scene/json_document.h"
#include "core/scene/scene_edit.h"
#include "core/scene/scene_files.h"

namespace migiwa {

namespace {

using Files = std::vector<std::filesystem::path>;

Files joined(Files files, const Files& more) {
  files.insert(files.end(), more.begin(), more.end());
  return files;
}

}  // namespace

SceneSession::SceneSession(const Scene& scene, SessionOptions options)
    : file_(scene.file),
      options_(std::move(options)),
      start_(startOf(scene)),
      watch_(joined(filesOfScene(scene.file), filesNamedBy(scene))) {}

void SceneSession::begin(std::optional<std::string> text) {
  if (reading_.valid()) {
    next_.emplace(std::move(text));
    return;
  }
  // Copies: the session may go on while the scene is read.
  reading_ = std::async(std::launch::async, [file = file_, options = options_, start = start_,
                                             text = std::move(text)]() mutable {
    Reading reading;
    reading.change.fromFile = !text;
    reading.files = filesOfScene(file);
    Files named;
    try {
      Scene scene =
          parseScene(text ? *text : readTextFile(file, "a scene file"), file, options.overrides, named);
      reading.start = startOf(scene);
      if (reading.start != start)
        reading.change.simulation = std::make_unique<SimulationThread>(scene, options.threads, options.pace);
      reading.change.scene = std::move(scene);
    } catch (const InputError& error) {
      reading.change.faults = error.faults();
    } catch (const std::exception& error) {
      reading.change.faults = {{file.string(), error.what()}};
    }
    reading.files = joined(std::move(reading.files), named);
    return reading;
  });
}

std::optional<SceneChange> SceneSession::poll() {
  if (watch_.poll()) begin(std::nullopt);
  if (!reading_.valid() || reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  Reading reading = reading_.get();
  if (reading.change.scene) start_ = reading.start;
  watch_.follow(std::move(reading.files));
  if (next_) begin(*std::exchange(next_, std::nullopt));
  return std::move(reading.change);
}

void SceneSession::apply(std::string text) {
  begin(std::move(text));
}

void SceneSession::wait() {
  if (reading_.valid()) reading_.wait();
}

std::string SceneSession::saveAs(const std::string& name, const std::string& text, const Settings& settings,
                                 const ViewState& view) {
  std::filesystem::path file(name);
  if (file.empty() || file.has_parent_path())
    throw InputError(
        "Save as", "expected a file name without a folder (what the scene names is relative to " +
                       std::filesystem::absolute(file_).parent_path().string() + "), found \"" + name + "\"");
  if (file.extension() != ".json") file += ".json";
  file = file_.parent_path() / file;

  Scene now = parseScene(text, file_, options_.overrides);
  now.solver = settings.solver;
  now.boundary = settings.boundary;
  now.effects = settings.effects;
  now.view.camera = view.camera;
  now.view.clip = view.clip;
  if (now.view.color != view.color) now.view.hasColorRange = false;
  now.view.color = view.color;
  std::string written = sceneTextWith(text, file_, now);
  try {
    writeTextFile(file, written);
  } catch (const OutputError& error) {
    // The editor lists faults; to it this is one.
    throw InputError(file.string(), error.what());
  }
  file_ = file;
  options_.overrides.clear();  // they are in the text now
  watch_.setFiles(filesOfScene(file_));
  apply(written);
  return written;
}

std::filesystem::path SceneSession::stateFile() const {
  return std::filesystem::path(file_).replace_extension(".save");
}

std::string SceneSession::fileText() const {
  std::ostringstream text;
  text << std::ifstream(file_, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace migiwa
