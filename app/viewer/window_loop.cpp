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
#include "app/session/probe.h"
#include "app/session/section_session.h"
#include "app/session/session.h"
#include "app/viewer/viewer.h"
#include "core/base/messages.h"
#include "core/base/progress.h"

namespace migiwa {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
/// No screen shows more; without a screen's own limit the simulation would lose its processor to drawing.
constexpr double kShortestFrame = 1.0 / 60;
/// Panels answer to an input over a few frames.
constexpr int kFramesAfterInput = 3;

/// So long nothing is shown while a scene is prepared, and then again after so long.
constexpr std::chrono::milliseconds kPatience(300);
constexpr double kBetweenSigns = 0.1;  // (s)

/// How often files and readers are asked for news (s).
constexpr double kBetweenLooks = 0.25;

void applyRequest(const UiCommands& commands, const Settings& settings, SimulationThread& simulation) {
  if (commands.settings) simulation.apply(settings);
  if (commands.reset) simulation.reset();
  if (commands.play) simulation.play();
  if (commands.pause) simulation.pause();
  if (commands.step) simulation.step();
  if (commands.stepBack) simulation.stepBack();
  if (commands.goTo) simulation.goTo(commands.goTo->branch, commands.goTo->time);
}

/// Begins when what was to be kept before is, so that no two files take the same name. An empty future:
/// nothing was.
std::future<void> keep(std::future<void> before, std::function<void()> write) {
  return std::async(std::launch::async, [before = std::move(before), write = std::move(write)]() mutable {
    if (before.valid()) before.get();
    write();
  });
}

void printWarnings(const Scene& scene) {
  for (const std::string& warning : scene.warnings)
    std::cerr << scene.file.string() << ": warning: " << warning << '\n';
}

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
      now_.emplace(
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
  std::optional<Preparation> now_;
};

/// The loop, until the window is closed or, which is returned, another scene was opened.
std::optional<Prepared> show(GlfwWindow& window, const Scene& scene,
                             std::unique_ptr<SimulationThread> simulation, const WindowOptions& options,
                             std::vector<Preparation>& left) {
  using Clock = std::chrono::steady_clock;
  const std::string title = (scene.name.empty() ? scene.stem() : scene.name) + " - Migiwa";
  std::string preparing;
  window.setTitle(title);
  SceneSession session(scene, {options.overrides, options.threads, Pace::realTime, options.past});
  printWarnings(simulation->scene());
  SceneEditor editor = makeEditor(session);
  WhatIfModel whatIf;
  WhatIfSession trials(options.threads);
  InspectModel inspect;
  ProbeSession probes;
  SectionModel section;
  SectionSession sections(options.threads);
  GalleryModel gallery;
  if (options.gallery) gallery.entries = options.gallery();
  Opening opening(options, gallery, left);
  Viewer viewer(simulation->scene(), simulation->walls(),
                {.scale = window.contentScale(),
                 .editor = &editor,
                 .whatIf = &whatIf,
                 .inspect = &inspect,
                 .gallery = options.open ? &gallery : nullptr,
                 .section = &section,
                 .water = options.water});
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
        if (change->simulation) probes.forget(inspect), sections.forget(section);
        applyChange(*change, session, viewer, simulation);
        if (change->scene) printWarnings(*change->scene);
        redraws = kFramesAfterInput;
      }
    }
    if (std::string now = session.preparing(); now != preparing) {
      preparing = std::move(now);
      window.setTitle(preparing.empty() ? title : std::string(preparing).append(" - ").append(title));
    }
    if (!input.dropped.empty() && options.open) gallery.ask = input.dropped.front();
    for (std::size_t k = 1; k < input.dropped.size(); ++k)
      std::cerr << input.dropped[k] << ": not opened, the window shows one scene at a time\n";
    if (!gallery.opening.empty()) redraws = kFramesAfterInput;
    if (std::optional<Prepared> next = opening.poll()) {
      if (saving.valid()) saving.get();
      return next;
    }
    if (trials.poll(whatIf, *simulation, viewer.settings())) redraws = kFramesAfterInput;
    if (probes.poll(inspect, simulation->scene(), viewer.settings())) redraws = kFramesAfterInput;
    if (const std::optional<Settings> inForce = simulation->takeSettings()) {
      viewer.setSettings(*inForce);
      redraws = kFramesAfterInput;
    }
    if (simulation->takeFrame(frame)) redraws = std::max(redraws, 1);
    if (sections.poll(section, viewer.view().section, simulation->scene(), viewer.settings(), frame.view()))
      redraws = std::max(redraws, 1);
    const auto [width, height] = window.framebufferSize();
    last = Clock::now();
    if ((redraws == 0 && !options.frames) || width == 0 || height == 0) continue;

    const RunStatus run = simulation->status();
    const FrameView shown = frame.view();
    const UiCommands commands = viewer.frame(shown, run, input, width, height);
    viewer.copyToWindow();
    window.swap();
    if (options.drawn) options.drawn({shown, run, viewer});
    applyRequest(commands, viewer.settings(), *simulation);
    const SectionView& cut = viewer.view().section;
    simulation->watchPressure(viewer.view().color == ColorField::pressure ||
                              (cut.shown && cut.field == SectionField::pressure));
    simulation->watchWater(viewer.view().water);
    keepState(commands, session, *simulation);
    applyRequest(editor, session, viewer.settings(), viewer.view());
    if (commands.savePicture && options.savePicture)
      saving = keep(std::move(saving),
                    [write = options.savePicture, picture = viewer.picture()] { write(picture); });
    if (commands.saveSection && options.saveSection && section.raster)
      saving = keep(std::move(saving), [write = options.saveSection, raster = section.raster,
                                        origin = simulation->scene().origin, field = section.of.field] {
        write(sectionCsv(*raster, origin, kSectionFieldNames[static_cast<std::size_t>(field)]));
      });
    redraws = std::max(redraws - 1, 0);
    ++drawn;
  }
  if (saving.valid()) saving.get();
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

namespace {

/// Messages say the place again where it is not a line of the text.
void listFaults(const std::vector<TextFault>& faults, const SceneSession& session, SceneEditor& editor) {
  editor.faults.clear();
  const std::string own = session.file().string() + ":";
  for (const TextFault& fault : faults) {
    std::string message = fault.text();
    if (fault.line > 0 && message.starts_with(own)) message.erase(0, own.size());
    editor.faults.push_back({fault.line, std::move(message)});
  }
}

std::string counted(std::size_t faults) {
  return faults == 1 ? "1 fault" : std::to_string(faults) + " faults";
}

/// What the file holds now. A text that was changed since stays.
void takeFileText(const std::string& text, bool edited, SceneEditor& editor) {
  editor.known = text;
  if (!edited) editor.replaceText(text);
}

/// What was typed since the request stays.
void takeSaved(const SaveRequest& saved, const SceneSession& session, SceneEditor& editor) {
  takeFileText(session.fileText(), editor.text != saved.text, editor);
  editor.fileName = session.file().filename().string();
  if (editor.saveName == saved.name) editor.saveName = editor.fileName;
}

}  // namespace

SceneEditor makeEditor(const SceneSession& session) {
  SceneEditor editor;
  editor.fileName = editor.saveName = session.file().filename().string();
  editor.text = editor.known = editor.applied = session.fileText();
  return editor;
}

void tellEditor(const SceneChange& change, const SceneSession& session, SceneEditor& editor) {
  if (change.saved) takeSaved(*change.saved, session, editor);
  if (change.fromFile() && change.fileText) takeFileText(*change.fileText, editor.edited(), editor);
  if (change.fromFile() && change.scene) editor.applied = session.fileText();
  listFaults(change.faults, session, editor);
  if (change.source == SceneChange::Source::save && !change.saved) {
    editor.note = "not saved: " + counted(change.faults.size());
    return;
  }
  std::string source;
  if (change.fromFile()) source = editor.fileName + " has changed: ";
  if (change.saved) source = "saved as " + session.file().string() + ", ";
  if (!change.faults.empty()) {
    editor.note = source + counted(change.faults.size()) + ", the scene before it goes on";
  } else {
    editor.note = source + (change.simulation ? "taken over from the start" : "taken over");
  }
}

void applyRequest(SceneEditor& editor, SceneSession& session, const Settings& settings,
                  const ViewState& view) {
  const bool revert = std::exchange(editor.revert, false);
  if (revert) editor.replaceText(editor.known);
  if (std::exchange(editor.apply, false) || revert) {
    editor.note = "reading ...";
    session.apply(editor.text, editor.asked);
  }
  if (const std::optional<std::string> text = std::exchange(editor.restore, std::nullopt)) {
    editor.note = "reading ...";
    session.apply(*text, editor.asked);
  }
  if (std::exchange(editor.save, false)) {
    editor.note = "saving ...";
    session.saveAs({editor.saveName, editor.text, settings, view}, editor.asked);
  }
}

void keepState(const UiCommands& commands, const SceneSession& session, SimulationThread& simulation) {
  if (commands.saveState) simulation.saveState(session.stateFile(), session.overrides());
  if (commands.loadState) simulation.loadState(session.stateFile());
}

void applyChange(SceneChange& change, SceneSession& session, Viewer& viewer,
                 std::unique_ptr<SimulationThread>& simulation) {
  if (!change.scene) return viewer.answerText(change.request);
  if (!change.simulation) {
    viewer.replaceScene(*change.scene, std::nullopt, change.request);
    return simulation->apply(viewer.settings());
  }
  const bool playing = simulation->status().playing;
  session.retire(std::exchange(simulation, std::move(change.simulation)));
  if (viewer.replaceScene(simulation->scene(), simulation->walls(), change.request))
    simulation->apply(viewer.settings());
  if (playing) simulation->play();
}

}  // namespace migiwa
