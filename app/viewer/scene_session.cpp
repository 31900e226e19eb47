#include "app/viewer/scene_session.h"

#include <algorithm>
#include <chrono>
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

/// Empty if it cannot be read.
std::string textIn(const std::filesystem::path& file) {
  try {
    return readTextFile(file, "a scene file");
  } catch (const InputError&) {
    return {};
  }
}

/// Runs what may throw, and says what was thrown, with places in `text`.
template <class Action>
std::vector<TextFault> faultsOf(const std::filesystem::path& file, const std::string& text,
                                const Action& action) {
  std::vector<Fault> thrown;
  try {
    action();
  } catch (const InputError& error) {
    thrown = error.faults();
  } catch (const std::exception& error) {
    thrown = {{file.string(), error.what()}};
  }
  std::vector<TextFault> faults;
  for (Fault& fault : thrown) {
    const int line = lineOfFault(fault, text, file);
    faults.push_back({std::move(fault), line});
  }
  return faults;
}

}  // namespace

SceneSession::SceneSession(const Scene& scene, SessionOptions options)
    : file_(scene.file),
      overrides_(options.overrides),
      fileText_(textIn(scene.file)),
      reader_{scene.file, std::move(options), startOf(scene),
              SceneWatch(joined(filesOfScene(scene.file), filesNamedBy(scene)))},
      thread_([this] { work(); }) {}

SceneSession::~SceneSession() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    std::erase_if(wishes_, [](const Wish& wish) { return !wish.save; });
  }
  wake_.notify_one();
  thread_.join();
}

std::optional<SceneChange> SceneSession::poll() {
  std::erase_if(retiring_, [](const std::future<void>& done) {
    return done.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  std::unique_lock lock(mutex_);
  look_ = true;
  wake_.notify_one();
  if (answers_.empty()) return std::nullopt;
  Answer answer = std::move(answers_.front());
  answers_.pop_front();
  lock.unlock();
  file_ = std::move(answer.file);
  overrides_ = std::move(answer.overrides);
  if (answer.change.fileText) fileText_ = *answer.change.fileText;
  return std::move(answer.change);
}

void SceneSession::ask(Wish wish) {
  const std::lock_guard lock(mutex_);
  // A text that was not yet begun is out of date; so is a look at the same files.
  std::erase_if(wishes_, [&](const Wish& known) { return !known.save && known.source == wish.source; });
  wishes_.push_back(std::move(wish));
  wake_.notify_one();
}

void SceneSession::apply(std::string text) {
  ask({SceneChange::Source::text, std::move(text), std::nullopt});
}

void SceneSession::saveAs(SaveWish wish) {
  ask({SceneChange::Source::save, {}, std::move(wish)});
}

void SceneSession::retire(std::unique_ptr<SimulationThread> simulation) {
  retiring_.push_back(
      std::async(std::launch::async, [old = std::move(simulation)]() mutable { old.reset(); }));
}

void SceneSession::wait() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return wishes_.empty() && !look_ && !busy_; });
}

std::filesystem::path SceneSession::stateFile() const {
  return std::filesystem::path(file_).replace_extension(".save");
}

void SceneSession::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return quit_ || look_ || !wishes_.empty(); });
    if (quit_ && wishes_.empty()) return;
    busy_ = true;
    if (!wishes_.empty()) {
      Wish wish = std::move(wishes_.front());
      wishes_.pop_front();
      const bool last = quit_;
      lock.unlock();
      Answer answer = carryOut(std::move(wish), last);
      lock.lock();
      answers_.push_back(std::move(answer));
    } else {
      look_ = false;
      lock.unlock();
      const bool changed = look();
      lock.lock();
      if (changed && !quit_) wishes_.push_back({});
    }
    busy_ = false;
    idle_.notify_all();
  }
}

/// What cannot be looked at has not changed.
bool SceneSession::look() {
  try {
    return reader_.watch.poll();
  } catch (const std::exception&) {
    return false;
  }
}

SceneSession::Answer SceneSession::carryOut(Wish wish, bool last) {
  Answer answer;
  SceneChange& change = answer.change;
  change.source = wish.source;
  std::string text = std::move(wish.text);
  if (wish.save) {
    change.faults = faultsOf(reader_.file, wish.save->text, [&] {
      text = write(*wish.save);
      change.fileText = text;
      change.saved = std::move(wish.save);
    });
  } else if (change.fromFile()) {
    change.faults = faultsOf(reader_.file, {}, [&] { text = readTextFile(reader_.file, "a scene file"); });
    change.fileText = text;
  }
  if (change.faults.empty() && !last) {
    Files named;
    change.faults = faultsOf(reader_.file, text, [&] { read(text, change, named); });
    faultsOf(reader_.file, text, [&] { reader_.watch.follow(joined(filesOfScene(reader_.file), named)); });
  }
  answer.file = reader_.file;
  answer.overrides = reader_.options.overrides;
  return answer;
}

void SceneSession::read(std::string text, SceneChange& change, Files& named) {
  Scene scene = parseScene(text, reader_.file, reader_.options.overrides, named);
  std::string start = startOf(scene);
  if (start != reader_.start)
    change.simulation =
        std::make_unique<SimulationThread>(scene, reader_.options.threads, reader_.options.pace);
  reader_.start = std::move(start);
  change.scene = std::move(scene);
}

std::string SceneSession::write(const SaveWish& wish) {
  std::filesystem::path file(wish.name);
  if (file.empty() || file.has_parent_path())
    throw InputError("Save as",
                     "expected a file name without a folder (what the scene names is relative to " +
                         std::filesystem::absolute(reader_.file).parent_path().string() + "), found \"" +
                         wish.name + "\"");
  if (file.extension() != ".json") file += ".json";
  file = reader_.file.parent_path() / file;

  Scene now = parseScene(wish.text, reader_.file, reader_.options.overrides);
  now.solver = wish.settings.solver;
  now.boundary = wish.settings.boundary;
  now.effects = wish.settings.effects;
  now.view.camera = wish.view.camera;
  now.view.clip = wish.view.clip;
  if (now.view.color != wish.view.color) now.view.hasColorRange = false;
  now.view.color = wish.view.color;
  std::string written = sceneTextWith(wish.text, reader_.file, now);
  try {
    writeTextFile(file, written);
  } catch (const std::runtime_error& error) {
    throw InputError(file.string(), error.what());
  }
  reader_.file = file;
  reader_.options.overrides.clear();  // they are in the text now
  reader_.watch.setFiles(filesOfScene(reader_.file));
  return written;
}

}  // namespace migiwa
