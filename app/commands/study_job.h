// What `migiwa study` was asked for, looked at and understood before anything is simulated or written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "core/study/plan.h"

namespace migiwa {

struct StudyOptions {
  std::string scene, out;
  std::vector<std::string> vary, merge;
  std::optional<double> until;  ///< (s)
  int repeat = 3;
  bool list = false;
  std::optional<long> run;
};

struct StudyJob {
  StudyPlan plan;
  std::filesystem::path folder;
};

/// Throws InputError with every fault found.
StudyJob checkedStudyJob(const StudyOptions& options, const CommonOptions& common);

}  // namespace migiwa
