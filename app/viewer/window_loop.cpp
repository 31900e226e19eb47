#include "app/viewer/window_loop.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <iostream>
#include <utility>

#include "app/platform/glfw_window.h"
#include "app/viewer/editing.h"
#include "app/viewer/simulation_thread.h"
#include "app/viewer/viewer.h"
#include "app/viewer/what_if_session.h"

namespace migiwa {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
/// No screen shows more; without a screen's own limit the simulation would lose its processor to drawing.
constexpr double kShortestFrame = 1.0 / 60;
/// Panels answer to an input over a few frames.
constexpr int kFramesAfterInput = 3;

/// How often files and readers are asked for news (s).
constexpr double kBetweenLooks = 0.25;

void carryOut(const Wishes& wishes, const Settings& settings, SimulationThread& simulation) {
  if (wishes.settings) simulation.apply(settings);
  if (wishes.reset) simulation.reset();
  if (wishes.play) simulation.play();
  if (wishes.pause) simulation.pause();
  if (wishes.step) simulation.step();
}

/// Begins when the picture before it is kept, so that no two take the same name. An empty future: none was.
std::future<void> keepPicture(std::future<void> before, const WindowOptions& options, Image picture) {
  return std::async(std::launch::async, [before = std::move(before), keep = options.savePicture,
                                         picture = std::move(picture)]() mutable {
    if (before.valid()) before.get();
    keep(picture);
  });
}

void printWarnings(const Scene& scene) {
  for (const std::string& warning : scene.warnings)
    std::cerr << scene.file.string() << ": warning: " << warning << '\n';
}

}  // namespace

void runWindow(const Scene& scene, const WindowOptions& options) {
  using Clock = std::chrono::steady_clock;
  const std::string name = scene.name.empty() ? scene.stem() : scene.name;
  GlfwWindow window(name + " - Migiwa", kWidth, kHeight);
  SceneSession session(scene, {options.overrides, options.threads, Pace::realTime});
  auto simulation = std::make_unique<SimulationThread>(scene, options.threads, Pace::realTime);
  printWarnings(simulation->scene());
  SceneEditor editor = makeEditor(session);
  WhatIfModel whatIf;
  WhatIfSession trials(options.threads);
  Viewer viewer(simulation->scene(), simulation->walls(),
                {.scale = window.contentScale(), .editor = &editor, .whatIf = &whatIf});
  if (options.playing) simulation->play();

  FrameSnapshot frame;
  std::future<void> saving;
  int redraws = kFramesAfterInput;
  long drawn = 0;
  Clock::time_point last = Clock::now(), looked = last;
  while (!window.shouldClose() && (!options.frames || drawn < *options.frames)) {
    const double since = std::chrono::duration<double>(Clock::now() - last).count();
    const InputState input = window.waitForInput(std::max(kShortestFrame - since, 0.0));
    if (window.somethingHappened()) redraws = kFramesAfterInput;
    if (std::chrono::duration<double>(Clock::now() - looked).count() > kBetweenLooks) {
      looked = Clock::now();
      if (std::optional<SceneChange> change = session.poll()) {
        tellEditor(*change, session, editor);
        if (change->scene) trials.forget(whatIf, *simulation);
        if (change->scene) takeOver(*change, session, viewer, simulation);
        if (change->scene) printWarnings(*change->scene);
        redraws = kFramesAfterInput;
      }
    }
    if (trials.poll(whatIf, *simulation, viewer.settings())) redraws = kFramesAfterInput;
    if (const std::optional<Settings> inForce = simulation->takeRefusal()) {
      viewer.setSettings(*inForce);
      redraws = kFramesAfterInput;
    }
    if (simulation->takeFrame(frame)) redraws = std::max(redraws, 1);
    const auto [width, height] = window.framebufferSize();
    last = Clock::now();
    if ((redraws == 0 && !options.frames) || width == 0 || height == 0) continue;

    const RunStatus run = simulation->status();
    const FrameView shown = frame.view();
    const Wishes wishes = viewer.frame(shown, run, input, width, height);
    viewer.copyToWindow();
    window.swap();
    if (options.drawn) options.drawn({shown, run, viewer});
    carryOut(wishes, viewer.settings(), *simulation);
    simulation->watchPressure(viewer.view().color == ColorField::pressure);
    keepState(wishes, session, *simulation);
    carryOut(editor, session, viewer.settings(), viewer.view());
    if (wishes.savePicture && options.savePicture)
      saving = keepPicture(std::move(saving), options, viewer.picture());
    redraws = std::max(redraws - 1, 0);
    ++drawn;
  }
  if (saving.valid()) saving.get();
}

}  // namespace migiwa
