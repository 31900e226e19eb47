// Faults of one scene while it is read: JSON pointers in, places that the user wrote out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/scene/origins.h"

namespace migiwa {

class FaultList {
 public:
  explicit FaultList(std::string file) : origins_(std::move(file)) {}

  /// At the value that has this pointer in the whole scene.
  void add(std::string_view pointer, std::string message);
  /// At a place of one of the files, before the scene is put together.
  void addAt(const Origin& origin, std::string message);
  /// What is valid and probably not meant: `/pointer: message`.
  void warn(std::string_view pointer, std::string_view message);
  const std::vector<std::string>& warnings() const { return warnings_; }
  std::size_t size() const { return faults_.size(); }
  bool empty() const { return faults_.empty(); }
  /// Whether there is a fault at the pointer or below it.
  bool anyBelow(std::string_view pointer) const;
  const std::vector<Fault>& faults() const { return faults_; }

  /// A file that the scene names, whether there is anything wrong with it or not.
  void noteFile(std::filesystem::path file) { files_.push_back(std::move(file)); }
  const std::vector<std::filesystem::path>& files() const { return files_; }

  Origins& origins() { return origins_; }
  const Origins& origins() const { return origins_; }

 private:
  Origins origins_;
  std::vector<std::string> pointers_;
  std::vector<Fault> faults_;
  std::vector<std::string> warnings_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace migiwa
