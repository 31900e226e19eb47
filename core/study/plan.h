// The grid of runs of a study: every combination of the values that are varied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/scene_reader.h"

namespace migiwa {

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

}  // namespace migiwa
