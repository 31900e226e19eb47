// The picture with its panels, and the window's loop.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/render/renderer.h"
#include "app/session/session.h"
#include "app/session/ui_state.h"
#include "app/session/undo.h"
#include "app/ui/ui.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"

namespace migiwa {

// One frame of the program: scene, text and panels, in a window and off-screen alike. Who calls it owns the
// context, which must stay current, and decides when to stop.

struct ViewerOptions {
  double scale = 1;     ///< size of text and panels; 1 suits a picture 720 pixels high
  bool panels = true;   ///< draw the panels
  bool timings = true;  ///< show wall times, which differ from run to run
  std::string note{};   ///< an extra line for the caption, "label = value"
  ColorMap colors = makeColorMap();
  /// The scene's text, to be edited in the window; null: not offered. Outlives the viewer.
  SceneEditor* editor = nullptr;
  /// Settings to be tried on a copy; null: not offered. Outlives the viewer.
  WhatIfModel* whatIf = nullptr;
  /// The particle that is looked into; null: particles cannot be picked. Outlives the viewer.
  InspectModel* inspect = nullptr;
  /// What can be opened; null: not offered. Outlives the viewer.
  GalleryModel* gallery = nullptr;
  /// The section through the water; null: not offered. Outlives the viewer.
  SectionModel* section = nullptr;
  /// The particles that are selected; null: not offered. Outlives the viewer.
  SelectionModel* selection = nullptr;
  /// The command line of what is seen; null: not offered. Outlives the viewer.
  CommandModel* command = nullptr;
  bool water = false;     ///< ViewState::water to begin with
  Clipboard clipboard{};  ///< as of Ui
};

/// How the scene of one frame is drawn.
struct SceneDrawing {
  double share = 1;             ///< of its width and height, in (0, 1]; enlarged where it is less
  std::optional<long> frame{};  ///< the same number is the same frame view; nothing: it may be any
};

/// The scale that suits a picture of this size.
double scaleFor(int width, int height);

class Viewer {
 public:
  Viewer(const Scene& scene, WallDrawing walls, const ViewerOptions& options);

  /// Takes over a changed scene. The camera and what else a person has turned stay, unless the scene's own
  /// view has changed. `walls`: of a scene that begins anew; nothing: the same ones, only parameters changed.
  /// `request`: the number of the editor's that it answers; 0: its file has changed. Returns whether
  /// settings() are others than the scene's: those from before a text that was taken back.
  bool replaceScene(const Scene& scene, std::optional<WallDrawing> walls, int request);
  /// The text of that number has been read.
  void answerText(int request);

  /// Draws one frame and returns what the user asked for.
  /// What has not changed is not drawn anew, and stays as fine as it is.
  UiCommands frame(const FrameView& frame, const RunStatus& run, const InputState& input, int width,
                   int height, const SceneDrawing& drawing = {});
  /// Of width and height, that the scene of the last frame was drawn at.
  double sceneShare() const { return drawn_ ? drawn_->share : 1; }
  /// Whether it was drawn anew.
  bool drewScene() const { return drewScene_; }
  /// The picture of the last frame.
  Image picture() const { return target_->read(); }
  /// Draws a frame that is not shown and takes no input; it depends on no earlier one.
  Image takePicture(const FrameView& view, const RunStatus& run, int width, int height);
  void copyToWindow() const { target_->copyToWindow(target_->width(), target_->height()); }

  const Settings& settings() const { return settings_; }
  /// Shows these from now on: those that the panels asked for were refused.
  void setSettings(const Settings& settings) {
    settings_ = settings;
    undo_.follow(undoable());
  }
  const UndoHistory& changes() const { return undo_; }
  ViewState& view() { return view_; }
  const Scene& scene() const { return scene_; }
  double scale() const { return options_.scale; }
  /// The part of the last frame that shows the scene.
  const Rect& area() const { return area_; }
  /// The particle that is looked into; null where none can be.
  const InspectModel* inspected() const { return options_.inspect; }
  ColorFieldInfo colorInfo(ColorField field) const {
    return colorFieldInfo(field, referenceSpeed_, scene_.solver.restDensity);
  }
  /// Ends of the colour map for a field, in its unit.
  std::array<double, 2> colorRange(ColorField field) const;

 private:
  UiCommands drawUi(const FrameView& frame, const RunStatus& run, const Rect& area);
  void drawGallery(const Rect& area);
  void drawSectionLegend(const Rect& area);
  /// With the water's surface only where it is to be seen.
  FrameView asShown(const FrameView& frame) const;
  Shot shot(const Rect& area) const;
  void followView();
  void drawScene(const FrameView& frame, const Rect& area, const SceneDrawing& drawing);
  /// That the scene was drawn into.
  const RenderTarget& sceneTarget() const { return reduced_ && sceneShare() < 1 ? *reduced_ : *target_; }
  void inspect(const FrameView& frame, const InputState& input, const Rect& area);
  bool hidden(const FrameView& frame, std::size_t particle, const InputState& input, const Rect& area) const;
  void lookInto(const FrameView& frame);
  void select(const FrameView& frame, const InputState& input, const Rect& area);
  void selectInside(const FrameView& frame, const Rect& area);
  void measureSelection(const FrameView& frame);
  ColorFieldInfo sectionInfo() const;
  void moveSection(const InputState& input, const Rect& area);
  std::optional<CutPlane> sectionCut() const;
  void moveCamera(const InputState& input, const Rect& area);
  Undoable undoable() const;
  void watchText();
  void undo(UiCommands& commands);
  void restore(const Undoable& state, UiCommands& commands);
  void keys(const InputState& input, const RunStatus& run, UiCommands& commands);
  void close();
  bool wheelMovesSection(const InputState& input) const;
  std::optional<Vec3d> pointAt(int x, int y, const Rect& area) const;
  void takeView();
  Caption caption(const FrameView& frame, const RunStatus& run) const;

  Scene scene_;
  ViewerOptions options_;
  Bounds bounds_;
  double referenceSpeed_;
  Settings settings_;
  ViewState view_;
  ColorScale scale_ = ColorScale::cool;  ///< that options_.colors are of
  Renderer renderer_;
  Ui ui_;
  StageHistory history_;
  UndoHistory undo_;
  bool awaitsText_ = false;             ///< the text that was last asked for is being read
  std::optional<Undoable> afterwards_;  ///< what is to be in force with it, where it was taken back to
  std::vector<GlTexture> galleryPictures_;
  std::optional<RenderTarget> target_, reduced_;
  /// What the scene was last drawn from.
  struct Drawn {
    std::optional<long> frame;
    Shot shot;
    std::shared_ptr<const SurfaceMesh> water;
    double share;
  };
  std::optional<Drawn> drawn_;  ///< nothing: it is to be drawn anew
  bool drewScene_ = false;
  /// What the section is drawn as, and what it was made of.
  std::shared_ptr<const Sheet> sheet_;
  std::shared_ptr<const SectionRaster> sheetRaster_;
  std::array<double, 2> sheetRange_{};
  bool sheetLines_ = false;
  InputState last_;
  Rect area_;
  bool laidOut_ = false;
  bool listsKeys_ = false;
  bool draggingScene_ = false, mouseUsed_ = false;
  std::optional<std::array<float, 2>> pressedAt_;      ///< where the left button went down on the scene
  std::optional<std::array<float, 2>> selectingFrom_;  ///< the corner where the rectangle began
  double sinceClick_ = 1;                              ///< (s)
  bool doubleClicked_ = false;                         ///< by the last press
};

/// Whether a place of the picture (pixels, from the top left) is in `area` and the mouse in the picture.
bool contains(const Rect& area, const InputState& input);

/// The particle that a picture of this size shows at a place of it (pixels, from the top left): the first
/// sphere that the ray of sight meets, of those that the shot does not cut away. Its index in the frame.
std::optional<std::size_t> pickParticle(const FrameView& frame, const Shot& shot, int width, int height,
                                        double x, double y);

// How finely the scene is drawn while things move, so that the window answers quickly where drawing is slow.

/// While something moves, the scene is drawn at a share of its size at which a frame takes `kBudget` at most;
/// whole once all is at rest. Where drawing is quick it is always whole.
class SceneDetail {
 public:
  static constexpr double kBudget = 0.018;  // (s)

  /// Of width and height, for the next frame.
  double share(bool moving) const { return moving ? kShares[level_] : 1; }
  /// A frame in which the scene was drawn at the share of that moment took so long (s).
  void drawn(bool moving, double seconds);

 private:
  static constexpr std::array<double, 4> kShares{1, 0.71, 0.5, 0.36};  ///< below that panels are most of it
  static constexpr int kSettled = 4;  ///< frames after which a mean tells something

  std::size_t level_ = 0;
  double mean_ = 0;  ///< of frames at this level (s)
  int frames_ = 0;
};

// What a window shows while its scene is being prepared.

class PreparationView {
 public:
  /// `scale` as of a viewer.
  PreparationView(std::string name, double scale) : name_(std::move(name)), ui_(scale) {}

  /// `doing` as PreparationStatus has it.
  void draw(const std::string& doing, int width, int height);
  Image picture() const { return target_->read(); }
  void copyToWindow() const { target_->copyToWindow(target_->width(), target_->height()); }

 private:
  std::string name_;
  Ui ui_;
  std::optional<RenderTarget> target_;
};

// The window's loop: input in, commands to the simulation's thread, one frame out.

class Viewer;

/// What the window shows at this moment.
struct DrawnFrame {
  const FrameView& frame;
  const RunStatus& run;
  const Viewer& viewer;
};

struct WindowOptions {
  int threads = 0;
  std::vector<Override> overrides;      ///< of the scene, for when its file is read again
  bool playing = true;                  ///< start at once
  std::optional<long> frames;           ///< close after so many drawn frames
  std::size_t past = TimeLine::kLimit;  ///< bytes for the states of the time line
  /// Keeps a picture that the user asked for; called on a thread of its own, for one picture after the other.
  std::function<void(const Image&)> savePicture;
  /// The same for a section as CSV.
  std::function<void(const std::string&)> saveSection{};
  /// Told of each frame that has been drawn, on the window's thread.
  std::function<void(const DrawnFrame&)> drawn{};
  bool water = false;  ///< shows the water's surface to begin with
  /// What can be opened from the window, and reads it; called on another thread, throws what is wrong with
  /// it.
  std::function<std::vector<GalleryEntry>()> gallery{};
  std::function<Scene(const std::filesystem::path&)> open{};
};

/// Opens a window on the scene and returns when it is closed. `read` is called on another thread, meanwhile
/// the window says what is being done about the scene `name`. Throws what `read` throws, and MissingError
/// where there is no display.
void runWindow(const std::string& name, const std::function<Scene()>& read, const WindowOptions& options);

// The speed that fills the colour map when pictures show speed.

/// That of a fall from the top of the scene to its bottom, or of the fastest source, rounded to one digit
/// (m/s).
double referenceSpeed(const Scene& scene);

// Between the window, the scene's file and what lies beside it, and the simulation that runs.

/// An editor that holds the session's file.
SceneEditor makeEditor(const SceneSession& session);

/// Faults, or that the change has been taken over. A text that the user has changed stays as it is, whatever
/// happens to the file.
void tellEditor(const SceneChange& change, const SceneSession& session, SceneEditor& editor);

/// Hands what the editor asks for to the session, which carries it out in the background.
void applyRequest(SceneEditor& editor, SceneSession& session, const Settings& settings,
                  const ViewState& view);

/// Saves the simulation's state beside the scene's file, or goes on from it.
void keepState(const UiCommands& commands, const SceneSession& session, SimulationThread& simulation);

/// Shows the scene of a change, if it is valid: with its new simulation, which plays if the old one did, or
/// by handing its parameters to the one that runs. The old simulation ends in the session's background.
void applyChange(SceneChange& change, SceneSession& session, Viewer& viewer,
                 std::unique_ptr<SimulationThread>& simulation);

}  // namespace migiwa
