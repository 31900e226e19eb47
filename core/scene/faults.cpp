#include <algorithm>

#include "core/scene/json.h"

namespace migiwa {

void FaultList::add(std::string_view pointer, std::string message) {
  const Origin origin = origins_.of(pointer);
  // Under "set" the pointer is a key, with its slashes escaped: the plain one says more.
  if (!origin.file.empty() && origin.pointer != pointer) message += " (" + std::string(pointer) + ")";
  addAt(origin, std::move(message));
  pointers_.emplace_back(pointer);
}

void FaultList::addAt(const Origin& origin, std::string message) {
  faults_.push_back({origin.text(), std::move(message)});
}

void FaultList::warn(std::string_view pointer, std::string_view message) {
  warnings_.push_back(std::string(pointer) + ": " + std::string(message));
}

bool FaultList::anyBelow(std::string_view pointer) const {
  return std::any_of(pointers_.begin(), pointers_.end(),
                     [&](const std::string& found) { return isBelow(found, pointer); });
}

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
