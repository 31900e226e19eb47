#include "app/viewer/scene_watch.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <sys/stat.h>

namespace migiwa {

namespace {

/// File systems keep times in steps, some in steps of two seconds.
constexpr std::chrono::nanoseconds kYoung = std::chrono::seconds(3);

}  // namespace

std::optional<SceneWatch::Stamp> SceneWatch::stampOf(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  const auto nanoseconds = [](const timespec& time) {
    return std::int64_t{1000000000} * time.tv_sec + time.tv_nsec;
  };
  return Stamp{nanoseconds(status.st_mtim), nanoseconds(status.st_ctim),
               static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_ino)};
}

void SceneWatch::setFiles(std::vector<std::filesystem::path> files) {
  files_.clear();
  for (std::filesystem::path& file : files) {
    Watched watched{std::move(file), {}, false, {}, {}};
    look(watched);
    watched.told = watched.content;
    files_.push_back(std::move(watched));
  }
}

void SceneWatch::follow(std::vector<std::filesystem::path> files) {
  const std::vector<Watched> before = std::exchange(files_, {});
  setFiles(std::move(files));
  for (Watched& watched : files_)
    for (const Watched& known : before)
      if (known.file == watched.file) watched = known;
}

bool SceneWatch::look(Watched& watched) {
  const std::optional<Stamp> stamp = stampOf(watched.file);
  if (stamp == watched.stamp && !watched.young) return false;
  std::optional<FileIdentity> content;
  // Files that this one refers to are watched by themselves.
  if (stamp) content = identityOf(std::vector{watched.file});
  watched.stamp = stamp;
  const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
  watched.young = stamp && now.count() - std::max(stamp->written, stamp->changed) < kYoung.count();
  return std::exchange(watched.content, content) != content;
}

bool SceneWatch::poll() {
  bool moving = false;
  for (Watched& watched : files_) moving |= look(watched);
  if (moving) return false;
  bool changed = false;
  for (Watched& watched : files_) {
    changed |= watched.told != watched.content;
    watched.told = watched.content;
  }
  return changed;
}

}  // namespace migiwa
