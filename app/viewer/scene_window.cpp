#include "app/viewer/scene_window.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "app/session/command_text.h"
#include "app/session/selection.h"
#include "core/base/files.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

/// How often files and readers are asked for news (s).
constexpr double kBetweenLooks = 0.25;

void carryOutOn(SimulationThread& simulation, const UiCommands& commands, const Settings& settings) {
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

}  // namespace

SceneWindow::SceneWindow(const Scene& scene, std::unique_ptr<SimulationThread> simulation,
                         const WindowOptions& options, const Look& look)
    : options_(options),
      simulation_(std::move(simulation)),
      session_(scene, {options.overrides, options.threads, Pace::realTime, options.past}),
      editor_(makeEditor(session_)),
      trials_(options.threads),
      sections_(options.threads),
      viewer_(simulation_->scene(), simulation_->walls(),
              {.scale = look.scale,
               .timings = look.timings,
               .editor = &editor_,
               .whatIf = &whatIf_,
               .inspect = &inspect_,
               .gallery = options.open ? &gallery_ : nullptr,
               .section = &section_,
               .selection = &selection_,
               .command = &command_,
               .water = options.water,
               .clipboard = look.clipboard}) {
  printWarnings(simulation_->scene());
  if (options.gallery) gallery_.entries = options.gallery();
  if (options.playing) simulation_->play();
}

SceneWindow::~SceneWindow() {
  if (saving_.valid()) saving_.wait();
}

void SceneWindow::keepAll() {
  if (saving_.valid()) saving_.get();
}

SceneWindow::News SceneWindow::poll() {
  bool panels = false, picture = false;
  const auto now = std::chrono::steady_clock::now();
  if (std::chrono::duration<double>(now - looked_).count() > kBetweenLooks) {
    looked_ = now;
    if (std::optional<SceneChange> change = session_.poll()) {
      tellEditor(*change, session_, editor_);
      if (change->scene) trials_.forget(whatIf_, *simulation_);
      if (change->simulation) {
        probes_.forget(inspect_);
        sections_.forget(section_);
        selection_.ids.clear();
      }
      applyChange(*change, session_, viewer_, simulation_);
      if (change->scene) printWarnings(*change->scene);
      panels = true;
    }
  }
  panels |= trials_.poll(whatIf_, *simulation_, viewer_.settings());
  panels |= probes_.poll(inspect_, simulation_->scene(), viewer_.settings());
  if (const std::optional<Settings> inForce = simulation_->takeSettings()) {
    viewer_.setSettings(*inForce);
    panels = true;
  }
  if (listing_.valid() && listing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    selection_.note = listing_.get();
    panels = true;
  }
  if (simulation_->takeFrame(frame_)) {
    ++frames_;
    picture = true;
  }
  picture |= sections_.poll(section_, viewer_.view().section, simulation_->scene(), viewer_.settings(),
                            frame_.view());
  return panels ? News::panels : picture ? News::frame : News::none;
}

void SceneWindow::draw(const InputState& input, int width, int height, const Haste& haste) {
  run_ = simulation_->status();
  width_ = width, height_ = height;
  if (!haste.keeps) drawn_ = frames_;
  commands_ = viewer_.frame(frame_.view(), run_, input, width, height, {haste.share, drawn_});
}

void SceneWindow::carryOut() {
  if (options_.drawn) options_.drawn({frame_.view(), run_, viewer_});
  carryOutOn(*simulation_, commands_, viewer_.settings());
  const SectionView& cut = viewer_.view().section;
  simulation_->watchPressure(viewer_.view().color == ColorField::pressure ||
                             (cut.shown && cut.field == SectionField::pressure) ||
                             (selection_.shown && selection_.field == ParticleValue::pressure));
  simulation_->watchWater(viewer_.view().water);
  keepState(commands_, session_, *simulation_);
  applyRequest(editor_, session_, viewer_.settings(), viewer_.view());
  if (commands_.copyCommand) tellCommand();
  if (commands_.saveParticles && !listing_.valid()) listParticles();
  keepWhatIsAsked();
}

void SceneWindow::keepWhatIsAsked() {
  if (commands_.savePicture && options_.savePicture)
    saving_ = keep(std::move(saving_),
                   [write = options_.savePicture, picture = viewer_.picture()] { write(picture); });
  if (commands_.saveSection && options_.saveSection && section_.raster)
    saving_ = keep(std::move(saving_), [write = options_.saveSection, raster = section_.raster,
                                        origin = simulation_->scene().origin, field = section_.of.field] {
      write(sectionCsv(*raster, origin, kSectionFieldNames[static_cast<std::size_t>(field)]));
    });
}

/// In the background: a million particles take seconds.
void SceneWindow::listParticles() {
  selection_.note = "being written ...";
  listing_ = std::async(std::launch::async, [frame = frame_, ids = selection_.ids, file = selection_.fileName,
                                             origin = simulation_->scene().origin] {
    try {
      const FrameView view = frame.view();
      writeTextFile(file, particlesCsv(view, ids, origin));
      return groupedDigits(selectedIn(view, ids).size()) +
             formatNumber(" particles of %.3f s in ", view.info.time) +
             std::filesystem::absolute(file).lexically_normal().string();
    } catch (const std::exception& error) {
      return std::string("Not written: ") + error.what();
    }
  });
}

void SceneWindow::tellCommand() {
  // Beside panels the window draws everything smaller, as wide as the whole picture would be.
  const Rect& area = viewer_.area();
  const auto shape = [](int width, int height) { return static_cast<double>(width) / height; };
  const double stretch = std::max(1.0, shape(width_, height_) / shape(area.width, area.height));
  command_ = commandFor({.scene = viewer_.scene(),
                         .file = session_.file(),
                         .overrides = session_.overrides(),
                         .saved = editor_.applied == editor_.known,
                         .line = run_.line,
                         .settings = viewer_.settings(),
                         .view = viewer_.view(),
                         .width = area.width,
                         .height = area.height,
                         .stretch = stretch,
                         .scale = viewer_.scale(),
                         .inspects = inspect_.id.has_value()});
  command_.open = command_.copy = true;
}

}  // namespace migiwa
