// Studies of what accuracy costs: the grid of runs, its runs, its table, and what is read off them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "core/simulation/statistics.h"

namespace migiwa {

// The grid of runs of a study: every combination of the values that are varied.

/// One `--vary /pointer=a,b,c`. Settings that belong together vary as one: `/first:/second=a:x,b:y`; a value
/// with fewer parts than pointers leaves the last of them as they are.
struct StudyAxis {
  std::string pointer;
  std::vector<std::string> values;  ///< as an Override has them, or several of them with ':' between

  /// What a value sets.
  std::vector<Override> overrides(const std::string& value) const;
  /// What people call the setting: the last token of its pointer.
  std::string name() const { return pointer.substr(pointer.rfind('/') + 1); }
  /// What tells a value from the others, in pictures: the last of its parts.
  std::string label(const std::string& value) const;
};

struct StudyPlan {
  std::filesystem::path scene;
  std::vector<Override> common;  ///< of every run, before what is varied
  std::vector<StudyAxis> axes;   ///< at least one, each with at least one value
  double until = 0;              ///< simulated time at the end of each run (s)

  /// Runs are numbered from 1 to size(); the largest number that it holds stands for more.
  std::size_t size() const;
  /// The values of a run, one for each axis. The last axis changes fastest.
  std::vector<std::string> values(std::size_t run) const;
  std::vector<Override> overrides(std::size_t run) const;
  /// Names and labels of a run's values, from axis `first` on, for people to read.
  std::string describe(const std::vector<std::string>& values, std::size_t first = 0) const;
};

/// Tells the runs of one study from those of any other: a checksum of every value in force, of the content of
/// the files that the scene names as it was when the scene was read, and of `until` (s).
std::string runFingerprint(const Scene& scene, double until);
/// That of a run as its scene and files are now. Throws InputError when the scene cannot be read.
std::string runFingerprint(const StudyPlan& plan, std::size_t run);

// The pressure that a run finds in the water against what it has to be at rest, rho0 g z at the depth z: what
// carries the water, and what would push on a wall. Pressures are those of core/solver/energy.h.
//
// Layers are one spacing high, counted from the level that the fluid's volume has in the tank; what is above
// it is in the first, at depth 0. The error is
//   sqrt(sum_k n_k (p_k - rho0 g z_k)^2 / sum_k n_k) / (rho0 g H)
// over the layers k of n_k particles with the means p_k and z_k, H being the level over the floor.

struct PressureLayer {
  double depth;      ///< mean (m)
  double pressure;   ///< mean (Pa)
  double particles;  ///< mean over the samples
};

class PressureProfile {
 public:
  /// Takes in the frame that a watched simulation (Simulation::watchPressure) has just made. Nothing outside
  /// an upright tank.
  void sample(const Simulation& simulation);
  void sample(const Scene& scene, std::span<const Float4> positions, std::span<const float> pressures);
  /// From the level down; layers without particles are left out.
  std::vector<PressureLayer> layers() const;
  /// Null where there was no tank, no pressure or no particle.
  std::optional<double> error() const;

 private:
  struct Sums {
    double depth = 0, pressure = 0;
    long particles = 0;
  };
  std::vector<Sums> sums_;
  long samples_ = 0;
  double perDepth_ = 0;  ///< rho0 g (Pa/m)
  double level_ = 0;     ///< (m), of the last sample
};

// What one run of a study has shown, and the file that keeps it: DIR/runs/K.json. A record is written whole
// or not at all, so a study that was stopped goes on from the records that are there.

/// The wall time of one repetition.
struct RunTiming {
  double wallMsPerSecond = 0;         ///< wall time a simulated second (ms/s)
  double msPerStep = 0;               ///< median over substeps (ms)
  std::vector<StageTime> stages;      ///< seconds a substep
  std::vector<int> stepMicroseconds;  ///< of every substep (us)
};

struct RunRecord {
  std::string fingerprint;  ///< runFingerprint()
  std::vector<std::string> overrides;
  std::string stateHash;    ///< at the end, 16 hex digits
  std::string gammaMethod;  ///< that ran; empty without correction
  std::string trouble;      ///< why the run failed; empty if it did not
  int threads = 0;
  /// Name of a column (core/study/study.h) and value, null where there is nothing to measure.
  std::vector<std::pair<std::string, std::optional<double>>> measures;
  std::vector<PressureLayer> pressure;  ///< at rest, from the level down; empty outside upright tanks
  std::vector<EnergySample> energy;     ///< over the run
  std::vector<RunTiming> timings;       ///< one a repetition

  std::optional<double> measure(const std::string& name) const;
};

std::filesystem::path recordFile(const std::filesystem::path& study, std::size_t run);
/// Throws InputError when the file cannot be written.
void writeRecord(const std::filesystem::path& file, const RunRecord& record);
/// Null if there is no such file. Throws InputError for anything that is not a record.
std::optional<RunRecord> readRecord(const std::filesystem::path& file);

// One repetition of one run of a study: simulates it and measures what it costs and, the first time, how
// wrong it is.

/// States of a run that are judged by the reference (core/study/study.h): its fifths, the end
/// included.
inline constexpr int kJudgedStates = 5;

/// Takes the run's first repetition into a new record. `eachFrame` is called after every frame.
RunRecord firstRepetition(const StudyPlan& plan, std::size_t run, int threads,
                          const std::function<void(const Simulation&)>& eachFrame);
/// Takes one more repetition's time into the record. Throws InputError if it ends in another state than the
/// first: then its time would not be that of the same run.
void repeatRun(const StudyPlan& plan, std::size_t run, int threads,
               const std::function<void(const Simulation&)>& eachFrame, RunRecord& record);

// study.csv: one row a run. First the columns that people script against, in this order:
// - run: number, from 1
// - /pointer: each varied value
// - wall_ms_per_s: wall time a simulated second (ms/s; runCost)
// - ms_per_step: of a substep (ms, median over the repetitions)
// - iterations: of a substep, mean
// - gamma_error, density_error_mean, density_error_max: by the reference (core/study/study.h)
// - height_error: settled height over the expected one, less 1 (core/simulation/measures.h)
// - edge_crowding, near_wall_spacing_p1, rms_speed (m/s): as there
// - lost (particles), memory_bytes (peak)
// Then more:
// - gamma_error_max, gamma_gradient_error: by the reference
// - solver_density_error_mean: with the run's own gamma
// - pressure_error: core/study/study.h
// - energy_gained, energy_stored (J/kg): the most that the solver has ever added, and what it found at the
//   start (core/simulation/statistics.h)
// - wall_error (m): of walls that are fitted, mean distance from their shape
// - precomputation_ms: what is made once, as if for the first time: reading, fits, grids, filling
// - wave_kept (1), wave_period (s): of the first gauge of the scene (core/study/series.h)
// - gauge_NAME: of each gauge, mean over the last tenth of the run
// - bulk_spacing_p1, particles, steps, nonfinite, repeats, threads, gamma_method, state_hash
// - wall_ms_per_s_min, _max: spread over the repetitions
// - on_front: of density_error_mean
// - share_STAGE: of the stages' sum, medians
// A cell is empty where there is nothing to measure.

struct FinishedRun {
  std::size_t run;
  std::vector<std::string> values;  ///< one for each axis
  RunRecord record;
};

/// Whether a column's cells depend on how the runs were carried out, on their times and memory: the others of
/// two tables of one study agree.
bool isTimeColumn(std::string_view column);

/// A measure of error that is 0 at best, made from a column of the table.
struct AccuracyMeasure {
  std::string column;
  std::string title;
  std::string unit;  ///< empty for ratios
  /// Null where the run has failed or has no such measure.
  std::optional<double> (*error)(const RunRecord& record);
};
/// density_error_mean, by which accuracy is judged first, leads.
const std::vector<AccuracyMeasure>& accuracyMeasures();

/// Wall time a simulated second (ms/s): of every substep the median over the repetitions, summed. A run does
/// the same work in the same substep every time, so what the machine does meanwhile falls out.
double runCost(const RunRecord& record);
/// Indices into `runs` that are on the front of a measure against runCost.
std::vector<std::size_t> frontOf(const std::vector<FinishedRun>& runs, const AccuracyMeasure& measure);

std::string studyCsv(const StudyPlan& plan, const std::vector<FinishedRun>& runs);

// How wrong a state is, judged by a reference that is the same for every run: gamma from 16384 directions a
// particle ("directions", whatever the run itself uses), and densities that are summed anew from the
// positions and divided by that gamma. So runs with different corrections, or with none, compare.
//
// Near a wall means nearer than the support radius. Over the samples:
//   gamma error     |gamma of the run - reference gamma|, mean and largest over the particles near walls; a
//                   run without correction has gamma = 1
//   gradient error  |h grad gamma - reference|, mean over the particles near walls
//   density error   max(rho/rho0 - 1, 0) with the reference gamma ([FM] Eq. 5), mean and largest over all
//                   particles

struct ReferenceErrors {
  std::optional<double> gammaMean, gammaMax;      ///< null where no particle was near a wall
  std::optional<double> gradientMean;             ///< null there, and where no gradients were given
  std::optional<double> densityMean, densityMax;  ///< null without particles
};

class ReferenceSampler {
 public:
  /// Of the reference: its error is below 0.001 at edges and corners (tests/study).
  static constexpr int kDirections = 16384;

  /// `threads` as for a Simulation.
  explicit ReferenceSampler(int threads) : threads_(threads) {}

  void sample(const Simulation& simulation);
  /// The same for particles from elsewhere, at `time` (s): `gamma` and `gradients` (h grad gamma; empty: not
  /// known) are what the run took for each of `positions` (m).
  void sample(const Scene& scene, double time, std::span<const Float4> positions,
              std::span<const float> gamma, std::span<const Vec3f> gradients = {});
  ReferenceErrors result() const;

 private:
  int threads_;
  double gammaSum_ = 0, gammaMax_ = 0, gradientSum_ = 0, densitySum_ = 0, densityMax_ = 0;
  long nearWalls_ = 0, gradients_ = 0, particles_ = 0;
};

// "What if": the present state of a run goes on for a few frames with other settings, on a copy, and is
// judged by the reference that all methods share. What it says is of these frames alone: a method that lets
// water crowd a wall over seconds shows little of that in five frames.

struct WhatIfAnswer {
  double time = 0;         ///< of the state that was asked about (s)
  double stepSeconds = 0;  ///< wall time of a substep (s): the median over the frames but the first
  double iterations = 0;   ///< of a substep, mean
  double solverError = 0;  ///< mean density error that the run itself measures after the last substep
  ReferenceErrors errors;  ///< of the last frame's state
  std::string handling;    ///< how walls were handled, such as "gamma: product"
  std::string trouble;     ///< why it had to stop; empty: it did not
};

class WhatIf {
 public:
  /// The first frame after a change of settings evaluates gamma of all particles anew and does not count.
  static constexpr int kFrames = 5;

  /// Fills the scene and prepares its walls anew, which may take seconds. `threads` as for a Simulation.
  WhatIf(const Scene& scene, int threads);

  /// The scene that `state` was taken from must be this one.
  /// Goes on for so many frames, after each of which `eachFrame` is called.
  WhatIfAnswer ask(const StateImage& state, const Settings& settings, int frames = kFrames,
                   const std::function<void(const Simulation&)>& eachFrame = {});

 private:
  Simulation copy_;
};

// The order of convergence that a study measures.

struct ValueAndError {
  double value, error;  ///< takes part only where both are positive
};

/// The power of the value that the error follows: the slope of ln error over ln value, by least squares. Null
/// for fewer than three values.
std::optional<double> measuredOrder(std::span<const ValueAndError> points);

// How errors follow a setting that is a number, such as the particle spacing: lines over its values, with the
// order that they show.

/// Whether all values of an axis are numbers.
bool isNumeric(const StudyAxis& axis);
/// The axes along which an order can be measured: at least three values, all positive numbers.
std::vector<std::size_t> convergenceAxes(const StudyPlan& plan);

struct ConvergenceLine {
  std::string label;  ///< the values of the other axes, numbers with their names; empty if there are none
  std::vector<ValueAndError> points;
  std::optional<double> order;
};
/// One for each combination of the other axes' values. Runs without the measure, and those with an error of
/// 0, are not on it.
std::vector<ConvergenceLine> convergenceOf(const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                                           std::size_t axis, const AccuracyMeasure& measure);

// The Pareto front: what cannot be had more exactly for less.

struct CostAndError {
  std::optional<double> cost, error;  ///< both: less is better; null: takes no part
};

/// Indices of the points that no other beats: none is as good in both and better in one. By rising cost.
/// Points that are the same in both are on the front together or not at all.
std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points);

}  // namespace migiwa
