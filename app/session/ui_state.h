// What lies between panels and the simulation: what they show, and what the user asks for. No window, no
// OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/scene_section.h"
#include "core/simulation/simulation.h"
#include "core/study/study.h"

namespace migiwa {

struct SceneEditor;
struct WhatIfModel;
class StageHistory;
class UndoHistory;

// What is measured at the end of every frame of a run, to be plotted over its time.

enum class RunMeasure { height, front, densityError, iterations, milliseconds };
inline constexpr std::size_t kMeasureCount = 5;
inline constexpr std::array<std::string_view, kMeasureCount> kMeasureNames{"height", "front", "density error",
                                                                           "iterations", "time of a step"};
inline constexpr std::array<std::string_view, kMeasureCount> kMeasureUnits{"m", "m", "%", "1", "ms"};

struct MeasureSample {
  double time = 0;  ///< (s)
  /// By RunMeasure; not a number where there is nothing to measure, as before the first step.
  std::array<float, kMeasureCount> values{};

  float operator[](RunMeasure measure) const { return values[static_cast<std::size_t>(measure)]; }
};

using MeasureSamples = std::shared_ptr<const std::vector<MeasureSample>>;

/// The past of the run that can be gone back to, and where in it the run is.
struct TimeLineView {
  struct Branch {
    int number = 0;
    std::string name;            ///< what was changed where it began, such as "/solver/tolerance=0.01"
    double from = 0, until = 0;  ///< (s)
    std::vector<double> kept;    ///< times of the states that are kept (s)
    MeasureSamples trace{};      ///< from its beginning on
  };
  std::vector<Branch> branches;  ///< in the order in which they began; none: not offered
  int branch = 0;                ///< the number of the present one
  long frame = 0;
  double time = 0;        ///< (s)
  bool underWay = false;  ///< on its way to another time
  std::size_t bytes = 0;  ///< that the states take
  /// Settings that came into force on the way to where the run is.
  struct Change {
    double time = 0;  ///< (s)
    Settings settings;
  };
  std::vector<Change> history;  ///< the first are those of the start
  bool historyIsWhole = true;   ///< it begins with the scene

  const Branch* present() const {
    for (const Branch& one : branches)
      if (one.number == branch) return &one;
    return nullptr;
  }
};

/// How the simulation is doing, apart from its frame.
struct RunStatus {
  bool playing = false;     ///< or would, if nothing held it
  bool stopped = false;     ///< it stopped itself and cannot go on
  std::string trouble;      ///< why
  std::string heldFor{};    ///< why no frame begins though it may play; empty: nothing holds it
  std::string refused{};    ///< one line on the last request, if it could not be carried out
  std::string stateNote{};  ///< one line on what became of the last request to save or load the state
  std::vector<std::string> stateFaults{};  ///< why it was not done; empty when it was
  /// Why the last change of settings was refused, and those of before stay; empty when it was taken over,
  /// or after a reset.
  std::vector<std::string> settingsFaults{};
  TimeLineView line{};
};

/// A plane through the water with a field on it.
struct SectionView {
  bool shown = false;
  SectionField field = SectionField::density;
  SectionDivisor divisor = SectionDivisor::sum;
  bool free = false;  ///< at an angle: across `normal` in place of the axis
  Axis axis = Axis::z;
  Vec3d normal{0.5, 0, 1};  ///< of some length
  double at = 0;            ///< from the origin along the unit normal (m)
  bool cut = true;          ///< what is before the plane is cut away
  bool lines = true;        ///< of equal values
  bool fit = false;         ///< colours reach from the least to the largest value

  bool operator==(const SectionView&) const = default;
  Vec3d direction() const {
    return free ? normal.normalized() : Vec3d(Vec3d::Unit(static_cast<Eigen::Index>(axis)));
  }
};

enum class Theme { dark, light };
inline constexpr std::array<std::string_view, 2> kThemeNames{"dark", "light"};
/// Of particles and sections; both are for colour-blind eyes, too: they grow lighter in equal steps.
enum class ColorScale { cool, warm };
inline constexpr std::array<std::string_view, 2> kColorScaleNames{"blue to yellow", "plum to cream"};

/// How the scene is looked at.
struct ViewState {
  Camera camera;
  ClipPlane clip;
  ColorField color = ColorField::density;
  bool walls = true;
  bool nodes = false;  ///< of SLIM walls, in place of their surfaces
  bool panels = true;
  bool water = false;  ///< the fluid's surface in place of its particles
  SectionView section{};
  Theme theme = Theme::dark;
  ColorScale scale = ColorScale::cool;
  /// Of the plot over time: a RunMeasure, or kMeasureCount for all.
  std::size_t plotted = static_cast<std::size_t>(RunMeasure::front);

  bool operator==(const ViewState&) const = default;
};

/// A place on the time line.
struct TimePlace {
  int branch = 0;   ///< its number
  double time = 0;  ///< (s)
};

/// What the user asked for in one frame.
struct UiCommands {
  bool play = false, pause = false, step = false, reset = false;
  bool stepBack = false;
  std::optional<TimePlace> goTo;
  bool settings = false;  ///< the settings were changed
  bool savePicture = false, saveSection = false, saveParticles = false;
  bool saveState = false, loadState = false;
  bool copyCommand = false;
  bool listKeys = false;  ///< the list of keys is to be shown, or hidden
  int undo = 0;           ///< so many changes are taken back; below 0: done again
};

// "Looking in": one particle, its neighbours, and what walls take of its support.

/// Gamma at a place by one method.
struct MethodGamma {
  std::string name;
  std::optional<double> gamma;
  std::string fault;  ///< why there is none: the method is not for these walls
};

/// What walls are at a place and a time.
struct WallAnswers {
  std::uint32_t id = 0;      ///< of the particle that is there
  Vec3f at = Vec3f::Zero();  ///< (m)
  double time = 0;           ///< (s)
  double reference = 1;      ///< gamma by far more directions than any method has
  std::vector<MethodGamma> methods;
  std::vector<float> distances;  ///< from walls to the vertices of the support ball (m), BallMesh::unit()
  bool complete = false;         ///< no method is still to be made
  std::string fault{};           ///< why nothing is known
};

struct PickedParticle {
  std::uint32_t id = 0;
  Vec3f position = Vec3f::Zero(), velocity = Vec3f::Zero();  ///< (m), (m/s)
  float density = 0, gamma = 0, lambda = 0;                  ///< as in a FrameView
  std::optional<float> pressure;                             ///< (Pa)
  std::uint32_t neighbours = 0;                              ///< in the last step
  std::vector<Vec3f> around;                                 ///< places of those in its support now (m)
};

struct InspectModel {
  std::optional<std::uint32_t> id;                ///< of the particle that is looked into
  std::optional<PickedParticle> picked, hovered;  ///< as they are in the frame that is shown
  double time = 0;                                ///< of that frame (s)
  std::optional<WallAnswers> walls;               ///< the last that is known
};

/// The section that is shown: of which field, and when.
struct SectionModel {
  std::shared_ptr<const SectionRaster> raster;  ///< null: none is known yet
  SectionView of;                               ///< as which it was asked for
  double time = 0;                              ///< (s)
  std::string fault;                            ///< why there is none
  std::optional<Vec3d> pointed;                 ///< place on it under the mouse (m)
};

// Particles that were selected, and how a field is spread over them.

/// What a particle has that can be counted and listed.
enum class ParticleValue { density, pressure, speed, gamma, x, y, z, vx, vy, vz, lambda, neighbours };
inline constexpr std::array<std::string_view, 12> kParticleValueNames{
    "density", "pressure", "speed", "gamma", "x", "y", "z", "vx", "vy", "vz", "lambda", "neighbours"};

/// Of a field over particles; deviation is that of all of them, not of a sample.
struct FieldSpread {
  static constexpr std::size_t kBins = 32;

  std::size_t count = 0;
  double least = 0, largest = 0, mean = 0, deviation = 0;
  /// From the least to the largest value, all of one width.
  std::array<std::size_t, kBins> bins{};
};

struct SelectionModel {
  std::vector<std::uint32_t> ids;                 ///< that are selected, in rising order; none: all count
  bool tool = false;                              ///< the next drag over the picture selects
  std::optional<std::array<float, 4>> rectangle;  ///< that is being drawn: left, top, right, bottom (pixels)
  ParticleValue field = ParticleValue::density;
  std::string fileName = "particles.csv";
  std::string note{};                 ///< one line on what became of the last table
  bool shown = false;                 ///< its panel was open in the last frame
  std::size_t here = 0, all = 0;      ///< of `ids`, and of all, those in the frame
  std::optional<FieldSpread> spread;  ///< of those of `ids` that are still there; nothing: not known
};

/// The command line that reproduces what is seen.
struct CommandModel {
  std::string text;
  std::vector<std::string> lacks;  ///< what it does not reproduce, a line each
  bool open = false;
  bool copy = false;  ///< it is to be put on the clipboard; cleared by whoever does it
};

// The gallery: what can be opened.

struct GalleryEntry {
  std::filesystem::path file, picture;  ///< the scene's, and a small PNG of it; empty: none
  std::string name, description;
  bool recent = false;         ///< one that was opened last
  std::uintptr_t texture = 0;  ///< of the picture, once it was drawn
};

struct GalleryModel {
  std::vector<GalleryEntry> entries;
  bool open = false;
  std::string typed;                         ///< name of a file
  std::optional<std::filesystem::path> ask;  ///< what is to be opened; cleared by whoever does it
  bool cancel = false;                       ///< what is being opened is not to be
  std::string opening;                       ///< what is being opened, and how far that is; empty: nothing
  std::vector<std::string> faults;           ///< of what could not be opened
};

struct PanelModel {
  const FrameInfo& frame;
  const RunStatus& run;
  bool timings;  ///< show wall times, which differ from run to run
  const Scene& scene;
  Bounds bounds;  ///< of the scene (m)
  Settings& settings;
  ViewState& view;
  bool hasNodes;  ///< some wall has nodes to show
  UiCommands& commands;
  SceneEditor* editor;        ///< null: the scene's text is not offered
  WhatIfModel* whatIf;        ///< null: not offered
  GalleryModel* gallery;      ///< null: not offered
  SectionModel* section;      ///< null: not offered
  CommandModel* command;      ///< null: not offered
  SelectionModel* selection;  ///< null: not offered
  const StageHistory& history;
  const UndoHistory& undo;
};

// "What if": error and cost of the present state with other settings beside those of now, as points in one
// chart.

/// One setting that was tried.
struct WhatIfPoint {
  std::string label;  ///< such as "gamma: product, at most 10 iterations, tolerance 0.01"
  double milliseconds = 0;
  double iterations = 0;
  std::optional<double> densityError, gammaError;  ///< against the reference, mean
  std::string trouble;                             ///< why it could not go on
  MeasureSamples trace{};                          ///< of its frames
};

struct WhatIfModel {
  Settings asked;  ///< what the form says
  bool ask = false, clear = false;
  int frames = WhatIf::kFrames;  ///< that the next one goes on for
  bool busy = false;
  bool follows = true;              ///< the form has not been touched: it says what the run has
  std::string note;                 ///< what is going on
  std::vector<WhatIfPoint> points;  ///< the first is what the run has now
};

// The scene's JSON in the window: a text to edit with its faults marked at their lines. What it asks for is
// carried out by whoever owns the scene's file.

struct SceneEditor {
  struct Fault {
    int line = 0;  ///< in the text, from 1; 0: elsewhere
    std::string message;
  };

  std::string fileName;  ///< whose text it is
  std::string text;
  std::string known;          ///< what the file holds
  std::string applied;        ///< the text that was last asked to be taken over
  int asked = 0;              ///< how often one was
  std::vector<Fault> faults;  ///< of the last text that was tried
  std::string note;           ///< one line on what became of the last request
  std::string saveName;
  bool open = false;
  bool apply = false, save = false, revert = false;  ///< what the user asks for; cleared by whoever does it
  std::optional<std::string> restore;                ///< a text to be taken over in place of what is shown

  int goTo = 0;             ///< line to put the caret on in the next frames; 0: none
  int caretLine = 1;        ///< where the caret is
  bool wantsFocus = false;  ///< the text is to take the keyboard in the next frame

  bool active = false;  ///< the text has the keyboard
  int generation = 0;   ///< of the text: one that replaces another has nothing of that one's to undo

  bool edited() const { return text != known; }
  /// Another text, also while the caret is in it.
  void replaceText(std::string with) {
    text = std::move(with);
    ++generation;
    // The widget is a new one, and goes on where the old one was.
    if (active) wantsFocus = true, goTo = caretLine;
  }
};

}  // namespace migiwa
