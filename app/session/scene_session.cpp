#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <sys/stat.h>

#include "app/session/session.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene_file.h"

namespace migiwa {

void PreparationStatus::reached(std::string_view what, double part) {
  const std::lock_guard lock(mutex_);
  what_ = what;
  part_ = part;
}

void PreparationStatus::ended() {
  const std::lock_guard lock(mutex_);
  what_.clear();
}

std::string PreparationStatus::text() const {
  const std::lock_guard lock(mutex_);
  return what_.empty() ? std::string() : what_ + formatNumber(": %.0f %%", 100 * part_);
}

namespace {

/// File systems keep times in steps, some in steps of two seconds.
constexpr std::chrono::nanoseconds kYoung = std::chrono::seconds(3);

}  // namespace

std::optional<SceneWatch::Stamp> SceneWatch::stampOf(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  const auto nanoseconds = [](const timespec& time) {
    return std::int64_t{1000000000} * time.tv_sec + time.tv_nsec;
  };
  return Stamp{nanoseconds(status.st_mtim), nanoseconds(status.st_ctim),
               static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_ino)};
}

void SceneWatch::setFiles(std::vector<std::filesystem::path> files) {
  files_.clear();
  for (std::filesystem::path& file : files) {
    Watched watched{std::move(file), {}, false, {}, {}};
    look(watched);
    watched.told = watched.content;
    files_.push_back(std::move(watched));
  }
}

void SceneWatch::follow(std::vector<std::filesystem::path> files) {
  const std::vector<Watched> before = std::exchange(files_, {});
  setFiles(std::move(files));
  for (Watched& watched : files_)
    for (const Watched& known : before)
      if (known.file == watched.file) watched = known;
}

bool SceneWatch::look(Watched& watched) {
  const std::optional<Stamp> stamp = stampOf(watched.file);
  if (stamp == watched.stamp && !watched.young) return false;
  std::optional<FileIdentity> content;
  // Files that this one refers to are watched by themselves.
  if (stamp) content = identityOf(std::vector{watched.file});
  watched.stamp = stamp;
  const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
  watched.young = stamp && now.count() - std::max(stamp->written, stamp->changed) < kYoung.count();
  return std::exchange(watched.content, content) != content;
}

bool SceneWatch::poll() {
  bool moving = false;
  for (Watched& watched : files_) moving |= look(watched);
  if (moving) return false;
  bool changed = false;
  for (Watched& watched : files_) {
    changed |= watched.told != watched.content;
    watched.told = watched.content;
  }
  return changed;
}

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
  const std::vector<int> lines = linesOfFaults(thrown, text, file);
  for (std::size_t k = 0; k < thrown.size(); ++k) faults.push_back({std::move(thrown[k]), lines[k]});
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
    std::erase_if(requests_, [](const Request& request) { return !request.save; });
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

void SceneSession::ask(Request request) {
  const std::lock_guard lock(mutex_);
  // A text that was not yet begun is out of date; so is a look at the same files.
  std::erase_if(requests_,
                [&](const Request& known) { return !known.save && known.source == request.source; });
  requests_.push_back(std::move(request));
  wake_.notify_one();
}

void SceneSession::apply(std::string text, int number) {
  ask({SceneChange::Source::text, std::move(text), std::nullopt, number});
}

void SceneSession::saveAs(SaveRequest request, int number) {
  ask({SceneChange::Source::save, {}, std::move(request), number});
}

void SceneSession::retire(std::unique_ptr<SimulationThread> simulation) {
  retiring_.push_back(
      std::async(std::launch::async, [old = std::move(simulation)]() mutable { old.reset(); }));
}

void SceneSession::wait() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return requests_.empty() && !look_ && !busy_; });
}

std::filesystem::path SceneSession::stateFile() const {
  return std::filesystem::path(file_).replace_extension(".save");
}

void SceneSession::work() {
  letOthersGoFirst();
  const ProgressScope watched(preparing_);
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return quit_ || look_ || !requests_.empty(); });
    if (quit_ && requests_.empty()) return;
    busy_ = true;
    if (!requests_.empty()) {
      Request request = std::move(requests_.front());
      requests_.pop_front();
      const bool last = quit_;
      lock.unlock();
      Answer answer = applyRequest(std::move(request), last);
      lock.lock();
      answers_.push_back(std::move(answer));
    } else {
      look_ = false;
      lock.unlock();
      const bool changed = look();
      lock.lock();
      if (changed && !quit_) requests_.push_back({});
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

SceneSession::Answer SceneSession::applyRequest(Request request, bool last) {
  Answer answer;
  SceneChange& change = answer.change;
  change.source = request.source;
  change.request = request.number;
  std::string text = std::move(request.text);
  if (request.save) {
    change.faults = faultsOf(reader_.file, request.save->text, [&] {
      text = write(*request.save);
      change.fileText = text;
      change.saved = std::move(request.save);
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

void SceneSession::read(const std::string& text, SceneChange& change, Files& named) {
  Scene scene = parseScene(text, reader_.file, reader_.options.overrides, named);
  std::string start = startOf(scene);
  if (start != reader_.start)
    change.simulation = std::make_unique<SimulationThread>(scene, reader_.options.threads,
                                                           reader_.options.pace, reader_.options.past);
  reader_.start = std::move(start);
  change.scene = std::move(scene);
}

std::string SceneSession::write(const SaveRequest& request) {
  std::filesystem::path file(request.name);
  if (file.empty() || file.has_parent_path())
    throw InputError("Save as",
                     "expected a file name without a folder (what the scene names is relative to " +
                         std::filesystem::absolute(reader_.file).parent_path().string() + "), found \"" +
                         request.name + "\"");
  if (file.extension() != ".json") file += ".json";
  file = reader_.file.parent_path() / file;

  Scene now = parseScene(request.text, reader_.file, reader_.options.overrides);
  now.solver = request.settings.solver;
  now.boundary = request.settings.boundary;
  now.effects = request.settings.effects;
  now.view.camera = request.view.camera;
  now.view.clip = request.view.clip;
  if (now.view.color != request.view.color) now.view.hasColorRange = false;
  now.view.color = request.view.color;
  std::string written = sceneTextWith(request.text, reader_.file, now);
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

namespace {

std::string labelOf(const Settings& settings, const WhatIfAnswer& answer) {
  return answer.handling + ", at most " + std::to_string(settings.solver.maxIterations) + " iterations, " +
         formatNumber("tolerance %g", settings.solver.tolerance);
}

WhatIfPoint pointOf(const Settings& settings, const WhatIfAnswer& answer) {
  WhatIfPoint point;
  point.label = labelOf(settings, answer);
  point.milliseconds = 1e3 * answer.stepSeconds;
  point.iterations = answer.iterations;
  point.densityError = answer.errors.densityMean;
  point.gammaError = answer.errors.gammaMean;
  point.trouble = answer.trouble;
  return point;
}

}  // namespace

void WhatIfSession::begin(WhatIfModel& model, SimulationThread& simulation, const Settings& now) {
  simulation.hold("\"What if\" measures");
  holds_ = true;
  std::vector<Settings> settings;
  if (model.points.empty()) settings.push_back(now);
  if (!model.points.empty() || !model.follows) settings.push_back(model.asked);
  model.busy = true;
  model.note = "measuring " + std::to_string(model.frames) + " frames on a copy; the run waits";
  std::future<StateImage> state;
  if (moment_ == nullptr) state = simulation.capture();
  asking_ = std::async(
      std::launch::async, [state = std::move(state), copy = copy_, moment = moment_, threads = threads_,
                           frames = model.frames, scene = simulation.scene(), settings]() mutable {
        letOthersGoFirst();
        Outcome outcome;
        outcome.frames = frames;
        try {
          if (moment == nullptr) moment = std::make_shared<const StateImage>(state.get());
          if (copy == nullptr) copy = std::make_shared<WhatIf>(scene, threads);
          const Meter meter(scene);
          for (const Settings& tried : settings) {
            Trace trace;
            const WhatIfAnswer answer = copy->ask(
                *moment, tried, frames, [&](const Simulation& reached) { trace.add(meter.read(reached)); });
            outcome.points.push_back(pointOf(tried, answer));
            outcome.points.back().trace = trace.samples();
            outcome.time = answer.time;
          }
          outcome.copy = std::move(copy);
        } catch (const std::exception& error) {
          outcome.fault = error.what();
        }
        outcome.moment = std::move(moment);  // also that of points before one that was refused
        return outcome;
      });
}

bool WhatIfSession::poll(WhatIfModel& model, SimulationThread& simulation, const Settings& now) {
  if (std::exchange(model.clear, false) && !asking_.valid()) {
    model.points.clear();
    model.follows = true;
    model.note.clear();
    moment_.reset();
  }
  if (std::exchange(model.ask, false) && !asking_.valid()) {
    begin(model, simulation, now);
    return true;
  }
  if (!asking_.valid() || asking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return false;
  Outcome outcome = asking_.get();
  model.busy = false;
  if (std::exchange(holds_, false)) simulation.release();
  if (std::exchange(dropped_, false)) return true;
  copy_ = std::move(outcome.copy);
  moment_ = std::move(outcome.moment);
  model.note = !outcome.fault.empty() ? outcome.fault
                                      : std::to_string(outcome.frames) + " frames on from " +
                                            formatNumber("%.3f s", outcome.time);
  for (WhatIfPoint& point : outcome.points) model.points.push_back(std::move(point));
  return true;
}

void WhatIfSession::forget(WhatIfModel& model, SimulationThread& simulation) {
  if (std::exchange(holds_, false)) simulation.release();
  model.points.clear();
  model.note.clear();
  model.follows = true;
  copy_.reset();
  moment_.reset();
  dropped_ = asking_.valid();
}

void WhatIfSession::wait() const {
  if (asking_.valid()) asking_.wait();
}

}  // namespace migiwa
