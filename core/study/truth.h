// Cases whose answer is known, from a closed form or from an experiment: does the water move like water?
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/io/report.h"
#include "core/scene/scene_file.h"
#include "core/study/series.h"

namespace migiwa {

/// Of every case's scene (m/s^2).
inline constexpr double kGravity = 9.81;

/// A run of a case's scene.
struct TruthRun {
  Scene scene;
  Report report;

  /// What a gauge of that name has shown; empty where there is none.
  Series gauge(const std::string& name) const;
};

/// A number that is known, and what a run finds in its place.
struct TruthAnswer {
  std::string quantity;         ///< with its unit, such as "period (s)"
  double known = 0;             ///< closed form or published
  std::optional<double> found;  ///< null where the run does not show it
  double scale = 0;             ///< what the error is a part of; 0: of what is known

  /// found - known as a part of the scale.
  std::optional<double> error() const;
};

/// A curve of a run beside the one that is known.
struct TruthCurve {
  std::string title, axis;  ///< of the picture and of what it shows, with its unit
  Series found, known;
  bool points = false;              ///< the known ones are single values, as an experiment has them
  std::string across = "time (s)";  ///< what it is shown over
};

struct TruthFindings {
  std::vector<TruthAnswer> answers;
  std::vector<TruthCurve> curves;
};

/// One way to run a case.
struct TruthSetting {
  std::string label;                   ///< in tables and pictures
  std::vector<std::string> overrides;  ///< as --set takes them
};

/// The setting with velocities from positions, what goes with them, and XSPH 0.05 against their noise; "from
/// positions" in its label.
TruthSetting fromPositions(TruthSetting setting);

struct TruthCase {
  std::string name;   ///< of the scene in scenes/truth, without .json
  std::string known;  ///< what is known, and from where
  std::vector<TruthSetting> settings;
  /// Reads off a run what is known of it. The numbers of the scene stand in its file and here.
  TruthFindings (*judge)(const TruthRun& run);
};

/// All cases: waves and oscillations first, then flows.
const std::vector<TruthCase>& truthCases();
/// Those of core/study/truth_waves.cpp and core/study/truth_flows.cpp.
std::vector<TruthCase> truthWaves();
std::vector<TruthCase> truthFlows();
/// The case of that name. Throws InputError for none.
const TruthCase& truthCase(const std::string& name);

/// Runs a case of the folder `scenes` with a setting and then `more`. `eachFrame` is called after every
/// frame.
TruthRun runTruth(const TruthCase& which, const std::filesystem::path& scenes, const TruthSetting& setting,
                  const std::vector<Override>& more, int threads,
                  const std::function<void(const Simulation&)>& eachFrame = {});

}  // namespace migiwa
