#include <exception>
#include <utility>

#include <sys/resource.h>

#include "app/session/session.h"
#include "core/base/messages.h"
#include "core/io/save_file.h"
#include "core/simulation/scene_surface.h"

namespace migiwa {
namespace {

std::string describe(const RunStatistics& statistics) {
  std::string text;
  for (const Trouble& trouble : statistics.trouble) {
    text = trouble.kind + " at step " + std::to_string(trouble.step) + ": " + trouble.detail;
  }
  return text;
}

std::vector<std::string> texts(const std::exception& error) {
  const auto* const input = dynamic_cast<const InputError*>(&error);
  if (input == nullptr) return {error.what()};
  std::vector<std::string> result;
  for (const Fault& fault : input->faults()) result.push_back(fault.text());
  return result;
}

std::string noteOf(const char* done, const std::filesystem::path& file, double time) {
  return std::string(done) + formatNumber(" at %.3f s: ", time) + file.filename().string();
}

}  // namespace

void letOthersGoFirst() {
  constexpr int kNice = 10;
  // Of this thread alone: Linux has one for each. Where it is refused everything works as well, and slower.
  setpriority(PRIO_PROCESS, 0, kNice);
}

/// What makes the water's surface, and of what settings.
struct SimulationThread::Water {
  Water(const Scene& scene, int threads)
      : pool(threads),
        surface(scene, SurfaceOptions{}, pool),
        kernel(scene.solver.kernel),
        supportRadius(scene.supportRadius()),
        method(scene.boundary.gammaMethod) {}

  bool fits(const Scene& scene) const {
    return kernel == scene.solver.kernel && supportRadius == scene.supportRadius() &&
           method == scene.boundary.gammaMethod;
  }

  ThreadPool pool;
  SceneSurface surface;
  KernelType kernel;
  double supportRadius;
  int method;
};

SimulationThread::SimulationThread(const Scene& scene, int threads, Pace pace, std::size_t past)
    : threads_(threads),
      pace_(pace),
      simulation_(std::make_unique<Simulation>(scene, threads)),
      line_(past),
      scene_(simulation_->scene()),
      walls_(simulation_->walls()),
      watchPressure_(scene.view.color == ColorField::pressure) {
  line_.begin(*simulation_);
  status_.line = line_.view(*simulation_);
  finished_.assign(simulation_->drawnView());
  hasFrame_ = true;
  thread_ = std::thread([this] { work(); });
}

SimulationThread::~SimulationThread() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

/// Whether a request cannot be carried out now, which the status then says.
bool SimulationThread::refuses(const char* request, bool needsGoodState) {
  const bool held = !status_.heldFor.empty();
  const bool refused = held || (needsGoodState && status_.stopped);
  status_.refused.clear();
  if (refused)
    status_.refused = std::string(request) + " refused: " + (held ? status_.heldFor : "it has stopped");
  return refused;
}

bool SimulationThread::mayAdvance() const {
  return status_.heldFor.empty() && !status_.stopped && (status_.playing || steps_ > 0);
}

void SimulationThread::play() {
  const std::lock_guard lock(mutex_);
  if (refuses("Play", true)) return;
  status_.playing = true;
  wake_.notify_one();
}

void SimulationThread::pause() {
  const std::lock_guard lock(mutex_);
  status_.playing = false;
  status_.refused.clear();
}

void SimulationThread::step() {
  const std::lock_guard lock(mutex_);
  if (refuses("Step", true)) return;
  status_.playing = false;
  ++steps_;
  wake_.notify_one();
}

void SimulationThread::reset() {
  const std::lock_guard lock(mutex_);
  if (refuses("Reset", false)) return;
  reset_ = true;
  goal_.reset();
  steps_ = 0;
  wake_.notify_one();
}

void SimulationThread::apply(const Settings& settings) {
  const std::lock_guard lock(mutex_);
  settings_ = settings;
  settled_.reset();
  wake_.notify_one();
}

std::optional<Settings> SimulationThread::takeSettings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(settled_, std::nullopt);
}

void SimulationThread::watchPressure(bool on) {
  const std::lock_guard lock(mutex_);
  watchPressure_ = on;
}

void SimulationThread::watchWater(bool on) {
  const std::lock_guard lock(mutex_);
  watchWater_ = on;
  if (on && !hasWater_) wake_.notify_one();
}

void SimulationThread::saveState(std::filesystem::path file, std::vector<Override> overrides) {
  const std::lock_guard lock(mutex_);
  if (refuses("Save state", false)) return;
  save_ = {std::move(file), std::move(overrides)};
  wake_.notify_one();
}

void SimulationThread::loadState(std::filesystem::path file) {
  const std::lock_guard lock(mutex_);
  if (refuses("Load state", false)) return;
  load_ = std::move(file);
  goal_.reset();
  steps_ = 0;
  wake_.notify_one();
}

void SimulationThread::hold(std::string why) {
  const std::lock_guard lock(mutex_);
  status_.heldFor = std::move(why);
}

void SimulationThread::release() {
  const std::lock_guard lock(mutex_);
  status_.heldFor.clear();
  status_.refused.clear();
  wake_.notify_one();
}

std::future<StateImage> SimulationThread::capture() {
  const std::lock_guard lock(mutex_);
  std::future<StateImage> image = captures_.emplace_back().get_future();
  wake_.notify_one();
  return image;
}

bool SimulationThread::takeFrame(FrameSnapshot& frame) {
  const std::lock_guard lock(mutex_);
  if (!hasFrame_) return false;
  std::swap(frame, finished_);
  hasFrame_ = false;
  return true;
}

RunStatus SimulationThread::status() const {
  const std::lock_guard lock(mutex_);
  RunStatus status = status_;
  status.line.underWay = goal_ || travel_;
  return status;
}

void SimulationThread::work() {
  std::unique_lock lock(mutex_);
  while (waitForWork(lock)) {
    try {
      // They go elsewhere.
      if (travel_ && (reset_ || load_)) {
        travel_.reset();
        settle();
      }
      // Whatever else is asked for since is of the place that it is on its way to.
      if (!travel_) applyRequests(lock);
      if (goal_) {
        depart(lock);
      } else if (travel_) {
        travelOn(lock);
      } else if (mayAdvance() && !settings_) {  // what came meanwhile holds for the next frame, too
        if (steps_ > 0) --steps_;
        advance(lock);
      }
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      travel_.reset();
      settle();
      stop(error.what());
    }
  }
  try {
    while (save_ && travel_) goal_ ? depart(lock) : travelOn(lock);
    if (save_) applySave(lock);
  } catch (const std::exception&) {
    // Nobody is left to tell; an older file stays.
  }
}

/// Sleeps until there is something to do and, in real time, until the next frame is due. False when it is
/// over.
bool SimulationThread::waitForWork(std::unique_lock<std::mutex>& lock) {
  const auto asked = [this] {
    return quit_ || reset_ || settings_ || save_ || load_ || !captures_.empty() || goal_ || travel_ ||
           (watchWater_ && !hasWater_) || (steps_ > 0 && mayAdvance());
  };
  while (!asked()) {
    if (!mayAdvance()) {
      wake_.wait(lock);
    } else if (pace_ == Pace::unlimited || Clock::now() >= due_) {
      break;
    } else {
      wake_.wait_until(lock, due_);
    }
  }
  return !quit_;
}

/// Whoever shows settings is to show those in force, unless others have been asked for.
void SimulationThread::settle() {
  if (!settings_) settled_ = simulation_->settings();
}

/// A simulation that stopped itself, or could not be made, waits for a reset.
void SimulationThread::stop(std::string why) {
  status_.playing = false;
  status_.stopped = true;
  status_.trouble = std::move(why);
}

/// In the order in which each is of what the one before makes, again for what comes meanwhile, until nothing
/// is left that is of the place of now.
void SimulationThread::applyRequests(std::unique_lock<std::mutex>& lock) {
  while (!quit_ && (!goal_ || sooner_ || reset_ || load_)) {
    if (reset_ || settings_) {
      applySettings(lock);
    } else if (save_) {
      applySave(lock);
    } else if (load_) {
      applyLoad(lock);
    } else if (!captures_.empty()) {
      giveCaptures(lock);
    } else if (watchWater_ && !hasWater_) {
      publish(lock);
    } else {
      return;
    }
  }
}

void SimulationThread::giveCaptures(std::unique_lock<std::mutex>& lock) {
  std::vector<std::promise<StateImage>> captures = std::exchange(captures_, {});
  lock.unlock();
  for (std::promise<StateImage>& capture : captures) capture.set_value(StateImage::of(*simulation_));
  lock.lock();
}

void SimulationThread::applySettings(std::unique_lock<std::mutex>& lock) {
  const bool reset = std::exchange(reset_, false);
  const std::optional<Settings> settings = std::exchange(settings_, std::nullopt);
  if (!reset && !settings) return;
  const bool stopped = status_.stopped;
  lock.unlock();
  std::vector<std::string> faults;
  try {
    const Settings before = simulation_->settings();
    // A change of the camera or of a name in the scene's text comes with the same settings.
    if (settings && !changesBetween(before, *settings).empty()) {
      simulation_->apply(*settings);
      // From a state that it has stopped in, perhaps between two frames, no branch begins.
      if (!stopped || simulation_->frame() >= line_.lastFrame(line_.branch())) {
        try {
          line_.changed(*simulation_, before);
        } catch (...) {
          simulation_->apply(before);
          throw;
        }
      }
    }
  } catch (const std::exception& error) {
    faults = texts(error);
  }
  if (reset) {
    auto again = std::make_unique<Simulation>(scene_, threads_);
    again->apply(simulation_->settings());
    line_.begin(*again);
    simulation_ = std::move(again);
  }
  lock.lock();
  if (!faults.empty()) settle();
  status_.settingsFaults = std::move(faults);
  if (reset) begin();
  publish(lock);
}

void SimulationThread::begin() {
  status_.stopped = false;
  status_.trouble.clear();
}

// A window samples nothing for the report's "settled", so what a save keeps of that is left empty here, and
// passed over there: a run that goes on from it samples what is left of its last tenth.

void SimulationThread::applySave(std::unique_lock<std::mutex>& lock) {
  const Save save = *std::exchange(save_, std::nullopt);
  lock.unlock();
  std::vector<std::string> faults;
  try {
    SettledSampler none;
    writeSave(save.file, *simulation_, none, save.overrides);
  } catch (const std::exception& error) {
    faults = texts(error);
  }
  const double time = simulation_->time();
  lock.lock();
  status_.stateNote = faults.empty() ? noteOf("Saved", save.file, time) : "Not saved:";
  status_.stateFaults = std::move(faults);
}

void SimulationThread::applyLoad(std::unique_lock<std::mutex>& lock) {
  const std::filesystem::path file = *std::exchange(load_, std::nullopt);
  lock.unlock();
  std::vector<std::string> faults;
  try {
    SettledSampler passedOver;
    auto loaded = std::make_unique<Simulation>(scene_, threads_);
    loaded->apply(simulation_->settings());
    readSave(file, *loaded, passedOver);
    line_.begin(*loaded);
    simulation_ = std::move(loaded);
  } catch (const std::exception& error) {
    faults = texts(error);
  }
  const double time = simulation_->time();
  lock.lock();
  status_.stateNote = faults.empty() ? noteOf("Loaded", file, time) : "Not loaded, the simulation goes on:";
  status_.stateFaults = std::move(faults);
  if (status_.stateFaults.empty()) begin();
  publish(lock);  // after a fault, too: a way that it was on ends here
}

void SimulationThread::advance(std::unique_lock<std::mutex>& lock) {
  const bool watchPressure = watchPressure_;
  lock.unlock();
  const auto start = Clock::now();
  advanceFrame(watchPressure);
  const bool stopped = simulation_->stopped();
  const std::string trouble = stopped ? describe(simulation_->statistics()) : "";
  // A late frame is not made up for: time lost would come back as a burst.
  const auto length = std::chrono::duration<double>(simulation_->settings().solver.timeStep);
  due_ = (due_ < start - length ? start : due_) + std::chrono::duration_cast<Clock::duration>(length);
  lock.lock();
  if (stopped) stop(trouble);
  publish(lock);
}

void SimulationThread::publish(std::unique_lock<std::mutex>& lock) {
  hasWater_ = watchWater_;
  const bool watchWater = watchWater_;
  lock.unlock();
  FrameView view = simulation_->drawnView();
  std::string fault;
  try {
    if (watchWater) view.water = waterOf(view);
  } catch (const std::exception& error) {
    fault = std::string("No water, particles instead: ") + error.what();
  }
  filling_.assign(view);
  TimeLineView line = line_.view(*simulation_);
  lock.lock();
  status_.line = std::move(line);
  if (!fault.empty()) status_.refused = fault;
  std::swap(filling_, finished_);
  hasFrame_ = true;
}

std::shared_ptr<const SurfaceMesh> SimulationThread::waterOf(const FrameView& frame) {
  const Scene& scene = simulation_->scene();
  if (!water_ || !water_->fits(scene)) water_ = std::make_unique<Water>(scene, threads_);
  return std::make_shared<const SurfaceMesh>(water_->surface.mesh(frame.positions, {}, simulation_->time()));
}

}  // namespace migiwa
