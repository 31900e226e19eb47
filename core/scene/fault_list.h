// Faults of one scene while it is read: JSON pointers in, places that the user wrote out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

namespace migiwa {

class FaultList {
 public:
  /// `overridden` are the JSON pointers that came from --set: faults there and below name the option, not the
  /// file.
  FaultList(std::string file, std::vector<std::string> overridden);

  void add(std::string_view pointer, std::string message);
  /// What is valid and probably not meant: `/pointer: message`.
  void warn(std::string_view pointer, std::string_view message);
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Where relative file names start: the folder of the scene.
  std::filesystem::path folder() const { return std::filesystem::path(file_).parent_path(); }
  std::size_t size() const { return faults_.size(); }
  bool empty() const { return faults_.empty(); }
  /// Whether there is a fault at the pointer or below it.
  bool anyBelow(std::string_view pointer) const;
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::string file_;
  std::vector<std::string> overridden_;
  std::vector<std::string> pointers_;
  std::vector<Fault> faults_;
  std::vector<std::string> warnings_;
};

/// Whether `pointer` is `ancestor` or lies below it.
bool isBelow(std::string_view pointer, std::string_view ancestor);

}  // namespace migiwa
