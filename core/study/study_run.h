// One repetition of one run of a study: simulates it and measures what it costs and, the first time, how
// wrong it is.
#pragma once

#include <functional>

#include "core/study/plan.h"
#include "core/study/run_record.h"

namespace migiwa {

/// States of a run that are judged by the reference (core/study/reference_errors.h): its fifths, the end
/// included.
inline constexpr int kJudgedStates = 5;

/// Takes the run's first repetition into a new record. `eachFrame` is told the simulated time (s).
RunRecord firstRepetition(const StudyPlan& plan, std::size_t run, int threads,
                          const std::function<void(double)>& eachFrame);
/// Takes one more repetition's time into the record. Throws InputError if it ends in another state than the
/// first: then its time would not be that of the same run.
void repeatRun(const StudyPlan& plan, std::size_t run, int threads,
               const std::function<void(double)>& eachFrame, RunRecord& record);

}  // namespace migiwa
