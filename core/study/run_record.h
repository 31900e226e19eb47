// What one run of a study has shown, and the file that keeps it: DIR/runs/K.json. A record is written whole
// or not at all, so a study that was stopped goes on from the records that are there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/stage_times.h"
#include "core/simulation/energy_balance.h"
#include "core/study/pressure_profile.h"

namespace migiwa {

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
  /// Name of a column (core/study/table.h) and value, null where there is nothing to measure.
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

}  // namespace migiwa
