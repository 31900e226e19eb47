// Notices that files have changed, however they were written: in place, or anew and renamed over the old one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/file_identity.h"

namespace migiwa {

class SceneWatch {
 public:
  explicit SceneWatch(std::vector<std::filesystem::path> files) { setFiles(std::move(files)); }

  /// Watches these from now on, and takes them as known.
  void setFiles(std::vector<std::filesystem::path> files);

  /// Watches these from now on; a change to one that was watched before is still told.
  void follow(std::vector<std::filesystem::path> files);

  /// Whether what is in the files has changed, and has been the same in the last two calls: while a file is
  /// still being written, or is missing for a moment, there is nothing to be had. Cheap when nothing
  /// happened; a few calls a second are meant. A change is told once.
  bool poll();

 private:
  /// What changes with every change to a file, also where its time of writing was set back.
  struct Stamp {
    std::int64_t written = 0, changed = 0;  ///< since the epoch (ns)
    std::uint64_t size = 0, number = 0;     ///< the file's own in its file system
    bool operator==(const Stamp&) const = default;
  };
  struct Watched {
    std::filesystem::path file;
    std::optional<Stamp> stamp;  ///< when it was last read
    bool young = false;          ///< then it was so new that another change may bear the same time
    /// Of its bytes, which may be those of a large mesh; nothing: no file.
    std::optional<FileIdentity> content;
    std::optional<FileIdentity> told;  ///< the same, when a change was last told
  };

  /// Nothing: no ordinary file.
  static std::optional<Stamp> stampOf(const std::filesystem::path& file);
  /// Reads the file if it seems to have changed; returns whether its content did.
  static bool look(Watched& watched);

  std::vector<Watched> files_;
};

}  // namespace migiwa
