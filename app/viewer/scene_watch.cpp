#include "app/viewer/scene_watch.h"

#include <chrono>
#include <fstream>
#include <utility>

#include "core/base/checksum.h"

namespace migiwa {

namespace {

/// File systems keep times in steps, some in steps of two seconds.
constexpr std::chrono::seconds kYoung{3};

std::uint64_t contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::uint64_t sum = kEmptyChecksum;
  std::vector<char> piece(std::size_t{1} << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    sum = checksum(sum, piece.data(), static_cast<std::size_t>(in.gcount()));
  return sum;
}

}  // namespace

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
  std::error_code error;
  std::optional<Stamp> stamp;
  if (std::filesystem::is_regular_file(watched.file, error)) {
    stamp = Stamp{std::filesystem::last_write_time(watched.file, error), 0};
    stamp->size = std::filesystem::file_size(watched.file, error);
    if (error) stamp.reset();
  }
  if (stamp == watched.stamp && !watched.young) return false;
  std::optional<std::uint64_t> content;
  if (stamp) content = contentOf(watched.file);
  watched.stamp = stamp;
  watched.young = stamp && std::filesystem::file_time_type::clock::now() - stamp->time < kYoung;
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
