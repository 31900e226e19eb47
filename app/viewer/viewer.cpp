#include "app/viewer/viewer.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "app/raytrace/optics.h"
#include "app/render/projection.h"
#include "app/session/ui_state.h"
#include "core/base/messages.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace {

void addOutline(const Drain& drain, const Bounds& scene, std::vector<LineSegment>& out) {
  if (drain.shape == DrainShape::sphere)
    Sphere(drain.center, drain.radius, Sphere::Fluid::inside).wireframe(scene, out);
  else
    Box(drain.min, drain.max, Box::Fluid::inside, drain.rotation).wireframe(scene, out);
}

Surroundings surroundings(const Scene& scene, WallDrawing walls) {
  Surroundings result{scene.bounds(), scene.view.camera.up, std::move(walls), {}, {}};
  if (scene.gravity.norm() > 0) result.up = -scene.gravity;
  for (const Drain& drain : scene.drains) addOutline(drain, result.bounds, result.drains);
  for (const Emitter& emitter : scene.emitters) {
    const std::vector<Vec3d> outline = emitter.outline();
    for (std::size_t k = 0; k < outline.size(); ++k)
      result.mouths.push_back({outline[k].cast<float>(), outline[(k + 1) % outline.size()].cast<float>()});
  }
  return result;
}

}  // namespace

bool contains(const Rect& area, const InputState& input) {
  const int x = static_cast<int>(input.mouseX) - area.x, y = static_cast<int>(input.mouseY) - area.y;
  return input.mouseInside && x >= 0 && y >= 0 && x < area.width && y < area.height;
}

double scaleFor(int width, int height) {
  return std::clamp(std::min(width / 1280.0, height / 720.0), 0.8, 4.0);
}

Viewer::Viewer(const Scene& scene, WallDrawing walls, const ViewerOptions& options)
    : scene_(scene),
      options_(options),
      bounds_(scene.bounds()),
      referenceSpeed_(referenceSpeed(scene)),
      settings_{scene.solver, scene.boundary, scene.effects},
      view_{scene.view.camera, scene.view.clip, scene.view.color, true,
            scene.view.nodes,  options.panels,  options.water},
      renderer_(surroundings(scene, std::move(walls)), options.colors),
      ui_(options.scale, options.clipboard) {
  takeView();
  undo_.begin(undoable());
}

void Viewer::takeView() {
  view_.camera = scene_.view.camera;
  view_.clip = scene_.view.clip;
  view_.nodes = scene_.view.nodes;
  view_.color = scene_.view.color;
  // A cut that is switched on later begins in the middle.
  if (!view_.clip.enabled) view_.clip.at = bounds_.center()[static_cast<Eigen::Index>(view_.clip.axis)];
  // So does a section.
  SectionView& section = view_.section;
  if (section.shown) return;
  section.axis = view_.clip.axis;
  section.at = section.free ? section.direction().dot(bounds_.center()) : view_.clip.at;
}

bool Viewer::replaceScene(const Scene& scene, std::optional<WallDrawing> walls, int request) {
  const bool viewChanged = !(scene.view == scene_.view);
  scene_ = scene;
  settings_ = {scene.solver, scene.boundary, scene.effects};
  if (walls) {
    bounds_ = scene.bounds();
    referenceSpeed_ = referenceSpeed(scene);
    renderer_ = Renderer(surroundings(scene, *std::move(walls)), options_.colors);
    drawn_.reset();
  }
  if (viewChanged) takeView();
  const bool restores = afterwards_.has_value();
  if (restores) {
    settings_ = afterwards_->settings;
    view_ = afterwards_->view;
  }
  // What a file brings that was changed elsewhere cannot be taken back here.
  if (request == 0) {
    undo_.begin(undoable());
  } else {
    undo_.follow(undoable());
  }
  answerText(request);
  return restores;
}

void Viewer::answerText(int request) {
  // An answer to an earlier text leaves open what comes of the last one.
  if (options_.editor == nullptr || request != options_.editor->asked) return;
  awaitsText_ = false;
  afterwards_.reset();
}

UiCommands Viewer::frame(const FrameView& frame, const RunStatus& run, const InputState& input, int width,
                         int height, const SceneDrawing& drawing) {
  if (!target_ || target_->width() != width || target_->height() != height) {
    target_.emplace(width, height);
    drawn_.reset();
  }
  area_ = ui_.sceneArea(width, height, view_.panels, run.line.branches.size());
  const Rect area = area_;

  followView();
  // The first frame's panels know their own size only once they have been laid out.
  if (!laidOut_) {
    for (int i = 0; i < 2; ++i) {
      ui_.begin(width, height, InputState{});
      drawUi(frame, run, area);
      ui_.end(false);
    }
    laidOut_ = true;
  }

  ui_.begin(width, height, input);
  // Where the mouse happens to be when the window opens, it points at nothing.
  const bool moved = last_.mouseInside && input.mouseInside &&
                     (input.mouseX != last_.mouseX || input.mouseY != last_.mouseY);
  mouseUsed_ = mouseUsed_ || moved || (input.down(MouseButton::left) && !last_.down(MouseButton::left));
  // What is drawn over the picture is drawn for the camera of the picture.
  select(frame, input, area);
  moveCamera(input, area);
  moveSection(input, area);
  inspect(frame, input, area);
  UiCommands commands = drawUi(frame, run, area);
  if (!ui_.wantsKeyboard()) keys(input, run, commands);
  if (commands.listKeys) listsKeys_ = !listsKeys_;
  watchText();
  const bool held = std::any_of(input.buttons.begin(), input.buttons.end(), [](bool down) { return down; });
  undo_.look(undoable(), held || ui_.busy(), input.seconds);
  undo(commands);
  // What is turned while a text is being read holds with it, too.
  if (afterwards_) afterwards_ = undoable();
  last_ = input;

  // A picture that is kept is whole, and of the frame of now.
  drawScene(asShown(frame), area, commands.savePicture ? SceneDrawing{} : drawing);
  ui_.end(true);
  return commands;
}

/// Leaves the target bound for what is drawn over it.
void Viewer::drawScene(const FrameView& frame, const Rect& area, const SceneDrawing& drawing) {
  Drawn now{drawing.frame, shot(area), frame.water, drawing.share};
  const bool same = drawn_ && now.frame && now.frame == drawn_->frame && now.shot == drawn_->shot &&
                    (now.water == nullptr) == (drawn_->water == nullptr) && drawn_->share >= now.share;
  drewScene_ = !same;
  if (!same) {
    drawn_ = std::move(now);
    Shot small = drawn_->shot;
    const auto part = [&](int pixels) { return static_cast<int>(std::lround(drawing.share * pixels)); };
    if (drawing.share < 1) {
      const int width = std::max(part(target_->width()), 1), height = std::max(part(target_->height()), 1);
      if (!reduced_ || reduced_->width() != width || reduced_->height() != height)
        reduced_.emplace(width, height);
      const int x = std::min(part(area.x), width - 1), y = std::min(part(area.y), height - 1);
      small.scene = {x, y, std::clamp(part(area.width), 1, width - x),
                     std::clamp(part(area.height), 1, height - y)};
    }
    sceneTarget().beginScene();
    renderer_.draw(frame, small, sceneTarget());
  }
  if (&sceneTarget() == &*target_)
    target_->beginOverlay();
  else
    target_->beginOverlay(*reduced_);
}

/// Theme and colours, of which others than the view's may be in force.
void Viewer::followView() {
  ui_.setTheme(view_.theme);
  if (view_.scale == scale_) return;
  scale_ = view_.scale;
  options_.colors = scale_ == ColorScale::warm ? makeWarmColorMap() : makeColorMap();
  renderer_.setColors(options_.colors);
  drawn_.reset();
  sheetRaster_.reset();
}

Shot Viewer::shot(const Rect& area) const {
  const Look& look = scene_.view.look;
  return {view_.camera, view_.clip,  view_.color, colorRange(view_.color),
          view_.walls,  view_.nodes, area,        lossOf(look.waterColor, look.waterDepth),
          sectionCut(), sheet_};
}

FrameView Viewer::asShown(const FrameView& frame) const {
  FrameView shown = frame;
  if (!view_.water) shown.water = nullptr;
  return shown;
}

Image Viewer::takePicture(const FrameView& view, const RunStatus& run, int width, int height) {
  laidOut_ = false;
  frame(view, run, InputState{}, width, height);
  return picture();
}

void PreparationView::draw(const std::string& doing, int width, int height) {
  if (!target_ || target_->width() != width || target_->height() != height) target_.emplace(width, height);
  target_->beginScene();
  target_->beginOverlay();
  ui_.begin(width, height, InputState{});
  ui_.caption({name_, {{"preparing", doing.empty() ? "the scene" : doing}}}, {0, 0, width, height});
  ui_.end(true);
}

UiCommands Viewer::drawUi(const FrameView& frame, const RunStatus& run, const Rect& area) {
  UiCommands commands;
  history_.add(frame.info.steps, frame.info.stages);
  ui_.caption(caption(frame, run), area);
  if (!asShown(frame).water)
    ui_.legend(colorInfo(view_.color), colorRange(view_.color), options_.colors, area);
  const NodePass& nodes = renderer_.nodes();
  if (view_.walls && view_.nodes && !nodes.empty()) {
    Rect above = area;
    above.height -= ui_.legendHeight();
    ui_.legend(NodePass::legend(), nodes.range(), makeWarmColorMap(), above);
  }
  if (sheet_) drawSectionLegend(area);
  if (options_.inspect != nullptr)
    ui_.inspector(*options_.inspect, frame.info, scene_.origin,
                  makeProjection(view_.camera, target_->width(), target_->height(), area), area);
  if (options_.selection != nullptr && !asShown(frame).water)
    ui_.selection(*options_.selection, frame,
                  makeProjection(view_.camera, target_->width(), target_->height(), area), area);
  if (view_.panels) {
    measureSelection(frame);
    PanelModel model{frame.info,
                     run,
                     options_.timings,
                     scene_,
                     bounds_,
                     settings_,
                     view_,
                     !nodes.empty(),
                     commands,
                     options_.editor,
                     options_.whatIf,
                     options_.gallery,
                     options_.section,
                     options_.command,
                     options_.selection,
                     history_,
                     undo_};
    ui_.panels(model, target_->height());
    if (!run.line.branches.empty()) ui_.timeLine(model, area);
    if (options_.editor != nullptr) ui_.sceneEditor(*options_.editor, area);
  }
  if (options_.gallery != nullptr && options_.gallery->open) drawGallery(area);
  if (options_.command != nullptr) ui_.command(*options_.command, area);
  ui_.bindings(listsKeys_, area);
  return commands;
}

void Viewer::drawSectionLegend(const Rect& area) {
  const ColorFieldInfo info = sectionInfo();
  Rect above = area;
  const NodePass& nodes = renderer_.nodes();
  if (!view_.water) above.height -= ui_.legendHeight();
  if (view_.walls && view_.nodes && !nodes.empty()) above.height -= ui_.legendHeight();
  ColorFieldInfo legend = info;
  legend.label += ", section";
  ui_.legend(legend, {info.low, info.high}, options_.colors, above);
  ui_.sectionPointer(*options_.section, info, scene_.origin);
}

/// The pictures of entries become textures when they are first to be seen.
void Viewer::drawGallery(const Rect& area) {
  for (GalleryEntry& entry : options_.gallery->entries) {
    if (entry.texture != 0 || entry.picture.empty()) continue;
    const std::optional<Image> picture = readPng(entry.picture);
    entry.picture.clear();
    if (!picture) continue;
    galleryPictures_.push_back(makePictureTexture(*picture));
    entry.texture = galleryPictures_.back().name();
  }
  ui_.gallery(*options_.gallery, area);
}

Caption Viewer::caption(const FrameView& frame, const RunStatus& run) const {
  const FrameInfo& info = frame.info;
  Caption caption{scene_.name.empty() ? scene_.stem() : scene_.name,
                  {{"time", formatNumber("%.3f s", info.time)},
                   {"particles", groupedDigits(frame.positions.size())},
                   {"walls", info.handling},
                   {"iterations", std::to_string(info.iterations)},
                   {"ms per step", milliseconds(info.stepSeconds, options_.timings)},
                   {"grid", formatNumber("%g m", renderer_.ground().gridSpacing)}}};
  if (view_.color == ColorField::pressure && frame.pressure.empty() && !frame.positions.empty())
    caption.rows.emplace_back("pressure", "from the next step on");
  if (run.stopped) caption.rows.emplace_back("state", "stopped");
  if (options_.gallery != nullptr && !options_.gallery->opening.empty())
    caption.rows.emplace_back("opening", options_.gallery->opening);
  const std::size_t equals = options_.note.find(" = ");
  if (equals != std::string::npos) {
    caption.rows.emplace_back(options_.note.substr(0, equals), options_.note.substr(equals + 3));
  }
  return caption;
}

std::array<double, 2> Viewer::colorRange(ColorField field) const {
  if (scene_.view.hasColorRange && field == scene_.view.color) return scene_.view.colorRange;
  const ColorFieldInfo info = colorInfo(field);
  return {info.low, info.high};
}

Undoable Viewer::undoable() const {
  const SceneEditor* editor = options_.editor;
  return {settings_, view_, editor != nullptr ? editor->text : "", editor != nullptr ? editor->applied : ""};
}

/// Notes which text is asked to be taken over in this frame.
void Viewer::watchText() {
  if (options_.editor == nullptr) return;
  SceneEditor& editor = *options_.editor;
  if (!editor.apply && !editor.save && !editor.revert) return;
  editor.applied = editor.revert ? editor.known : editor.text;
  ++editor.asked;
  awaitsText_ = true;
  afterwards_.reset();
}

void Viewer::undo(UiCommands& commands) {
  for (; commands.undo > 0 && undo_.canUndo(); --commands.undo) restore(undo_.undo(), commands);
  for (; commands.undo < 0 && undo_.canRedo(); ++commands.undo) restore(undo_.redo(), commands);
  commands.undo = 0;
}

void Viewer::restore(const Undoable& state, UiCommands& commands) {
  settings_ = state.settings;
  view_ = state.view;
  commands.settings = true;
  if (options_.editor == nullptr) return;
  SceneEditor& editor = *options_.editor;
  if (editor.text != state.text) editor.replaceText(state.text);
  if (editor.applied != state.applied) {
    editor.applied = state.applied;
    editor.restore = state.applied;
    ++editor.asked;
    awaitsText_ = true;
  }
  // The scene comes with settings and a view of its own.
  if (awaitsText_) afterwards_ = state;
}

std::optional<Vec3d> Viewer::pointAt(int x, int y, const Rect& area) const {
  const RenderTarget& drawn = sceneTarget();
  const auto place = [](int pixel, int of, int in) {
    return std::clamp(static_cast<int>((pixel + 0.5) * in / of), 0, in - 1);
  };
  const std::optional<float> depth =
      drawn.depthAt(place(x, target_->width(), drawn.width()), place(y, target_->height(), drawn.height()));
  if (!depth) return std::nullopt;
  const Projection projection = makeProjection(view_.camera, target_->width(), target_->height(), area);
  const Eigen::Vector4d onScreen(2 * (x + 0.5 - area.x) / area.width - 1,
                                 1 - 2 * (y + 0.5 - area.y) / area.height,
                                 2 * static_cast<double>(*depth) - 1, 1);
  const Eigen::Matrix4d toScreen = (projection.clip * projection.view).cast<double>();
  const Eigen::Vector4d world = toScreen.inverse() * onScreen;
  return Vec3d(world.head<3>() / world.w());
}

double referenceSpeed(const Scene& scene) {
  const Vec3d size = scene.bounds().size();
  double speed = std::sqrt(2 * scene.gravity.cwiseAbs().dot(size));
  for (const auto& source : scene.fluid) speed = std::max(speed, source->largestSpeed());
  for (const Emitter& emitter : scene.emitters) speed = std::max(speed, emitter.mouthSpeed());
  if (!(speed > 0) || !std::isfinite(speed)) return 1;
  const double digit = std::pow(10, std::floor(std::log10(speed)));
  return std::max(1.0, std::round(speed / digit)) * digit;
}

}  // namespace migiwa
