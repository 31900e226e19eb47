#include "core/scene/scene_identity.h"

#include "core/base/state_hash.h"
#include "core/scene/json_writer.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

namespace {

Json fileIdentity(const FileName& name) {
  return {{"name", name.written},
          {"bytes", name.identity.bytes},
          {"checksum", hexDigits(name.identity.checksum)}};
}

std::string shown(const Json* value) {
  return value == nullptr ? "none" : describeJson(*value);
}

void compare(const Json* expected, const Json* found, const std::string& pointer,
             std::vector<DocumentFault>& faults) {
  if (expected != nullptr && found != nullptr) {
    if (*expected == *found) return;
    if (expected->is_object() && found->is_object()) {
      for (const auto& [key, value] : expected->items())
        compare(&value, found->contains(key) ? &(*found)[key] : nullptr, childPointer(pointer, key), faults);
      for (const auto& [key, value] : found->items())
        if (!expected->contains(key)) compare(nullptr, &value, childPointer(pointer, key), faults);
      return;
    }
    // Of vectors, all is said by showing them whole.
    const bool lists = expected->is_array() && found->is_array() && expected->size() == found->size() &&
                       !expected->empty() && expected->front().is_structured();
    if (lists) {
      for (std::size_t k = 0; k < expected->size(); ++k)
        compare(&(*expected)[k], &(*found)[k], childPointer(pointer, k), faults);
      return;
    }
    if (expected->is_array() && found->is_array() && expected->size() == found->size()) {
      faults.push_back({pointer, "expected " + expected->dump() + ", found " + found->dump()});
      return;
    }
  }
  faults.push_back({pointer, "expected " + shown(expected) + ", found " + shown(found)});
}

}  // namespace

Json sceneIdentity(const Scene& scene) {
  Json identity = JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); }, fileIdentity);
  for (const char* key : {"name", "description", "duration", "view"}) identity.erase(key);
  return identity;
}

std::vector<DocumentFault> identityFaults(const Json& expected, const Json& found) {
  std::vector<DocumentFault> faults;
  compare(&expected, &found, "", faults);
  return faults;
}

}  // namespace migiwa
