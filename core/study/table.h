// study.csv: one row a run. First the columns that people script against, in this order:
// - run: number, from 1
// - /pointer: each varied value
// - wall_ms_per_s: wall time a simulated second (ms/s; runCost)
// - ms_per_step: of a substep (ms, median over the repetitions)
// - iterations: of a substep, mean
// - gamma_error, density_error_mean, density_error_max: by the reference (core/study/reference_errors.h)
// - height_error: settled height over the expected one, less 1 (core/simulation/measures.h)
// - edge_crowding, near_wall_spacing_p1, rms_speed (m/s): as there
// - lost (particles), memory_bytes (peak)
// Then more:
// - gamma_error_max, gamma_gradient_error: by the reference
// - solver_density_error_mean: with the run's own gamma
// - pressure_error: core/study/pressure_profile.h
// - energy_gained, energy_stored (J/kg): the most that the solver has ever added, and what it found at the
//   start (core/simulation/energy_balance.h)
// - wall_error (m): of walls that are fitted, mean distance from their shape
// - precomputation_ms: what is made once, as if for the first time: reading, fits, grids, filling
// - bulk_spacing_p1, particles, steps, nonfinite, repeats, threads, gamma_method, state_hash
// - wall_ms_per_s_min, _max: spread over the repetitions
// - on_front: of density_error_mean
// - share_STAGE: of the stages' sum, medians
// A cell is empty where there is nothing to measure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/study/plan.h"
#include "core/study/run_record.h"

namespace migiwa {

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

}  // namespace migiwa
