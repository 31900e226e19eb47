// What holds of the sources themselves: which part of the program may include which, and some plain habits.
// The rules are data in source_rules.cpp. They work on texts in memory, so that they can be tested on sources
// that break them.
#pragma once

#include <string>
#include <vector>

namespace migiwa::structure {

struct SourceFile {
  std::string path;  ///< relative to the repository, with forward slashes
  std::string text;
};

/// Every function below returns one readable line for each violation.
using Violations = std::vector<std::string>;

/// Lower rooms never include higher ones, and no two rooms include each other.
Violations checkLayers(const std::vector<SourceFile>& files);

/// Narrower borders: the renderer never sees the solver, a library only shows where it is wrapped.
Violations checkBorders(const std::vector<SourceFile>& files);

/// Quoted includes name a file of ours from the repository's root; anything else is in angle brackets.
Violations checkIncludeStyle(const std::vector<SourceFile>& files);

/// Nothing in the physics calls what differs in its last digit between machines.
Violations checkPortability(const std::vector<SourceFile>& files);

/// A file is a chapter: the median of a room's files is long enough, and a header has two readers at least.
Violations checkChapters(const std::vector<SourceFile>& files);

/// Headers say what they are for and are guarded; no file is too long or keeps notes about unfinished work.
Violations checkHabits(const std::vector<SourceFile>& files);

}  // namespace migiwa::structure
