// Where each value of a scene was written. A scene is put together from a file, the files that it includes,
// their "set" and the options --set; a fault has to name the one that a person has to change.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

/// Whether `pointer` is `ancestor` or lies below it.
bool isBelow(std::string_view pointer, std::string_view ancestor);

/// The place of a value.
struct Origin {
  std::string file;     ///< as it was named; empty for the option --set
  std::string pointer;  ///< in that file, or behind --set
  bool whole = false;   ///< made on the way to this place: what is below it has no place of its own

  /// `FILE:/pointer` or `--set /pointer`.
  std::string text() const;
};

class Origins {
 public:
  /// All values were written in `file`, at the pointer that they have.
  explicit Origins(std::string file);

  /// The value at `pointer` of the whole scene, and all below it, now comes from `origin`.
  void add(std::string pointer, Origin origin);
  /// Of the value at `pointer`, which need not exist: then of the object that lacks it.
  Origin of(std::string_view pointer) const;
  /// Where relative file names begin that were written at `pointer`: the folder of the file that holds them.
  /// What an option names is relative to the scene itself.
  std::filesystem::path folder(std::string_view pointer) const;
  /// The folder of the scene itself.
  std::filesystem::path sceneFolder() const;

 private:
  struct Part {
    std::string pointer;
    Origin origin;
  };

  std::string file_;
  std::vector<Part> parts_;  ///< in the order in which they were put over each other
};

}  // namespace migiwa
