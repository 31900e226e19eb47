#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/platform/context.h"
#include "app/session/session.h"
#include "app/viewer/scene_window.h"
#include "core/base/messages.h"
#include "core/base/progress.h"

namespace migiwa {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
/// No screen shows more; without a screen's own limit the simulation would lose its processor to drawing.
constexpr double kShortestFrame = 1.0 / 60;
/// So long after the last input the scene is whole again.
constexpr std::chrono::milliseconds kAtRest(250);
/// So long after a frame of the run was drawn an input is answered over it, before the next one is.
constexpr std::chrono::milliseconds kStillGood(120);
/// Of the time, that drawing may take while a run plays and nothing is touched; the rest is the run's.
constexpr double kDrawingShare = 0.4;
/// So often it is looked whether there is something to be drawn, while nothing plays.
constexpr double kBetweenLooksAtRest = 0.04;  // (s)
/// Panels answer to an input over a few frames.
constexpr int kFramesAfterInput = 3;

/// So long nothing is shown while a scene is prepared, and then again after so long.
constexpr std::chrono::milliseconds kPatience(300);
constexpr double kBetweenSigns = 0.1;  // (s)

struct Prepared {
  Scene scene;
  std::unique_ptr<SimulationThread> simulation;
};

/// A scene that is being prepared on a thread of its own.
class Preparation {
 public:
  Preparation(std::string name, std::function<Scene()> read, const WindowOptions& options)
      : name_(std::move(name)), status_(std::make_shared<PreparationStatus>()) {
    prepared_ = std::async(std::launch::async, [status = status_, read = std::move(read),
                                                threads = options.threads, past = options.past] {
      letOthersGoFirst();
      const ProgressScope watched(*status);
      Scene scene = read();
      auto simulation = std::make_unique<SimulationThread>(scene, threads, Pace::realTime, past);
      return Prepared{std::move(scene), std::move(simulation)};
    });
  }

  const std::string& name() const { return name_; }
  std::string doing() const { return status_->text(); }
  bool ready(std::chrono::milliseconds patience = {}) const {
    return prepared_.wait_for(patience) == std::future_status::ready;
  }
  /// Throws what reading threw.
  Prepared take() { return prepared_.get(); }

 private:
  std::string name_;
  std::shared_ptr<PreparationStatus> status_;
  std::future<Prepared> prepared_;
};

/// Opens what the gallery asks for while the scene before it goes on. What is cancelled, or overtaken by
/// another, ends in the background.
class Opening {
 public:
  /// `left`: those that nobody waits for any more.
  Opening(const WindowOptions& options, GalleryModel& gallery, std::vector<Preparation>& left)
      : options_(options), gallery_(gallery), left_(left) {}
  ~Opening() { leave(); }
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  /// Begins what is asked for; returns the scene that is ready, or nothing.
  std::optional<Prepared> poll() {
    if (gallery_.cancel || gallery_.ask) leave();
    gallery_.cancel = false;
    if (const auto asked = std::exchange(gallery_.ask, std::nullopt)) {
      gallery_.faults.clear();
      now_ = std::make_unique<Preparation>(
          asked->filename().string(), [open = options_.open, file = *asked] { return open(file); }, options_);
    }
    std::erase_if(left_, [](const Preparation& one) { return one.ready(); });
    gallery_.opening = now_ ? now_->name() + (now_->doing().empty() ? " ..." : ": " + now_->doing()) : "";
    if (!now_ || !now_->ready()) return std::nullopt;
    try {
      std::optional<Prepared> prepared = now_->take();
      now_.reset();
      return prepared;
    } catch (const std::exception& error) {
      const auto* const input = dynamic_cast<const InputError*>(&error);
      if (input == nullptr) gallery_.faults.emplace_back(error.what());
      if (input != nullptr)
        for (const Fault& fault : input->faults()) gallery_.faults.push_back(fault.text());
    }
    gallery_.open = true;
    now_.reset();
    gallery_.opening.clear();
    return std::nullopt;
  }

 private:
  void leave() {
    if (now_) left_.push_back(std::move(*now_));
    now_.reset();
  }

  const WindowOptions& options_;
  GalleryModel& gallery_;
  std::vector<Preparation>& left_;
  std::unique_ptr<Preparation> now_;
};

/// The loop, until the window is closed or, which is returned, another scene was opened.
std::optional<Prepared> show(GlfwWindow& window, const Scene& scene,
                             std::unique_ptr<SimulationThread> simulation, const WindowOptions& options,
                             std::vector<Preparation>& left) {
  using Clock = std::chrono::steady_clock;
  const std::string title = (scene.name.empty() ? scene.stem() : scene.name) + " - Migiwa";
  std::string preparing;
  window.setTitle(title);
  SceneWindow content(scene, std::move(simulation), options,
                      {.scale = window.contentScale(), .clipboard = window.clipboard()});
  GalleryModel& gallery = content.gallery();
  Opening opening(options, gallery, left);

  int redraws = kFramesAfterInput;
  long drawn = 0;
  SceneDetail detail;
  Clock::time_point touched = Clock::now(), sceneDrawn = touched - kStillGood;
  double between = kShortestFrame;  // (s), as long as nothing is touched
  Clock::time_point last = Clock::now();
  while (!window.shouldClose() && (!options.frames || drawn < *options.frames)) {
    const double since = std::chrono::duration<double>(Clock::now() - last).count();
    const InputState input =
        window.waitForInput(std::max((redraws > 0 ? kShortestFrame : between) - since, 0.0));
    const bool answering = window.somethingHappened();
    if (answering) {
      redraws = kFramesAfterInput;
      touched = Clock::now();
    }
    if (std::string now = content.preparing(); now != preparing) {
      preparing = std::move(now);
      window.setTitle(preparing.empty() ? title : std::string(preparing).append(" - ").append(title));
    }
    if (!input.dropped.empty() && options.open) gallery.ask = input.dropped.front();
    for (std::size_t k = 1; k < input.dropped.size(); ++k)
      std::cerr << input.dropped[k] << ": not opened, the window shows one scene at a time\n";
    if (!gallery.opening.empty()) redraws = kFramesAfterInput;
    if (std::optional<Prepared> next = opening.poll()) return next;
    const SceneWindow::News news = content.poll();
    redraws = std::max(redraws, news == SceneWindow::News::panels  ? kFramesAfterInput
                                : news == SceneWindow::News::frame ? 1
                                                                   : 0);
    const bool moving = content.run().playing || Clock::now() - touched < kAtRest;
    if (!moving && content.viewer().sceneShare() < 1) redraws = std::max(redraws, 1);
    const auto [width, height] = window.framebufferSize();
    last = Clock::now();
    if (!content.run().playing) between = kBetweenLooksAtRest;
    if ((redraws == 0 && !options.frames) || width == 0 || height == 0) continue;

    // What was just drawn serves once more: an input is answered before the next frame of the run is drawn.
    const bool first = answering && last - sceneDrawn < kStillGood;
    content.draw(input, width, height, {detail.share(moving), first});
    content.viewer().copyToWindow();
    window.finish();
    // Without the swap, which waits for the screen.
    const double took = std::chrono::duration<double>(Clock::now() - last).count();
    if (content.viewer().drewScene()) {
      sceneDrawn = Clock::now();
      detail.drawn(moving, took);
    }
    window.swap();
    content.carryOut();
    if (content.run().playing) between = std::max(kShortestFrame, took / kDrawingShare);
    redraws = std::max(redraws - 1, 0);
    ++drawn;
  }
  return std::nullopt;
}

/// Shows what is done until it is done; null: the window was closed before.
std::optional<Prepared> awaited(Preparation& preparing, GlfwWindow& window) {
  const std::string title = preparing.name() + " - Migiwa";
  std::optional<PreparationView> view;
  while (!preparing.ready()) {
    if (window.shouldClose()) return std::nullopt;
    const std::string doing = preparing.doing();
    window.setTitle(std::string(doing.empty() ? "preparing" : doing).append(" - ").append(title));
    if (const auto [width, height] = window.framebufferSize(); width > 0 && height > 0) {
      if (!view) view.emplace(preparing.name(), window.contentScale());
      view->draw(doing, width, height);
      view->copyToWindow();
      window.swap();
    }
    window.waitForInput(kBetweenSigns);
  }
  return preparing.take();
}

}  // namespace

void SceneDetail::drawn(bool moving, double seconds) {
  if (!moving) return;
  constexpr double kNew = 0.25;
  // The next finer level has twice the pixels; a frame has more to do than them, so that it does not come
  // back.
  constexpr double kFiner = 0.35;
  mean_ = frames_ == 0 ? seconds : (1 - kNew) * mean_ + kNew * seconds;
  ++frames_;
  const bool coarser = frames_ >= kSettled ? mean_ > kBudget : frames_ > 1 && mean_ > 2 * kBudget;
  const bool finer = frames_ >= 4 * kSettled && mean_ < kFiner * kBudget;
  if (coarser && level_ + 1 < kShares.size())
    ++level_;
  else if (finer && level_ > 0)
    --level_;
  else
    return;
  mean_ = 0, frames_ = 0;
}

void runWindow(const std::string& name, const std::function<Scene()>& read, const WindowOptions& options) {
  Preparation preparing(name, read, options);
  std::vector<Preparation> left;  // after the window: it closes before they end
  std::optional<Prepared> prepared;
  if (preparing.ready(kPatience)) prepared = preparing.take();
  std::optional<GlfwWindow> window;
  try {
    window.emplace(name + " - Migiwa", kWidth, kHeight);
  } catch (const MissingError&) {
    // What is wrong with the scene is told first.
    if (!prepared) preparing.take();
    throw;
  }
  if (!prepared) prepared = awaited(preparing, *window);
  WindowOptions now = options;
  while (prepared) {
    prepared = show(*window, prepared->scene, std::move(prepared->simulation), now, left);
    // What was opened since plays as particles, with the settings of its file.
    now.overrides.clear();
    now.playing = true;
    now.water = false;
  }
}

}  // namespace migiwa
