#include "core/scene/origins.h"

#include <algorithm>

namespace migiwa {

bool isBelow(std::string_view pointer, std::string_view ancestor) {
  return pointer.starts_with(ancestor) &&
         (pointer.size() == ancestor.size() || pointer[ancestor.size()] == '/');
}

std::string Origin::text() const {
  const std::string shown = pointer.empty() ? "/" : pointer;
  return file.empty() ? "--set " + shown : file + ":" + shown;
}

Origins::Origins(std::string file) : file_(std::move(file)) {
  parts_.push_back({"", {file_, ""}});
}

void Origins::add(std::string pointer, Origin origin) {
  parts_.push_back({std::move(pointer), std::move(origin)});
}

Origin Origins::of(std::string_view pointer) const {
  // The last one covers what lay below it.
  const auto part = std::find_if(parts_.rbegin(), parts_.rend(),
                                 [&](const Part& candidate) { return isBelow(pointer, candidate.pointer); });
  Origin origin = part->origin;
  if (!origin.whole) origin.pointer += pointer.substr(part->pointer.size());
  return origin;
}

std::filesystem::path Origins::folder(std::string_view pointer) const {
  const std::string file = of(pointer).file;
  return file.empty() ? sceneFolder() : std::filesystem::path(file).parent_path();
}

std::filesystem::path Origins::sceneFolder() const {
  return std::filesystem::path(file_).parent_path();
}

}  // namespace migiwa
