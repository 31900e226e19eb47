#include "core/scene/fault_list.h"

#include <algorithm>

namespace migiwa {

bool isBelow(std::string_view pointer, std::string_view ancestor) {
  return pointer.starts_with(ancestor) &&
         (pointer.size() == ancestor.size() || pointer[ancestor.size()] == '/');
}

FaultList::FaultList(std::string file, std::vector<std::string> overridden)
    : file_(std::move(file)), overridden_(std::move(overridden)) {}

void FaultList::add(std::string_view pointer, std::string message) {
  const bool fromOption =
      std::any_of(overridden_.begin(), overridden_.end(),
                  [&](const std::string& ancestor) { return isBelow(pointer, ancestor); });
  const std::string shown(pointer.empty() ? "/" : pointer);
  faults_.push_back({fromOption ? "--set " + shown : file_ + ":" + shown, std::move(message)});
  pointers_.emplace_back(pointer);
}

void FaultList::warn(std::string_view pointer, std::string_view message) {
  warnings_.push_back(std::string(pointer) + ": " + std::string(message));
}

bool FaultList::anyBelow(std::string_view pointer) const {
  return std::any_of(pointers_.begin(), pointers_.end(),
                     [&](const std::string& found) { return isBelow(found, pointer); });
}

}  // namespace migiwa
