#include "core/scene/fault_list.h"

#include <algorithm>

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

}  // namespace migiwa
