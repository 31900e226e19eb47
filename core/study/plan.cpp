#include "core/study/plan.h"

#include <algorithm>
#include <limits>

#include "core/base/checksum.h"
#include "core/base/state_hash.h"
#include "core/scene/scene_identity.h"

namespace migiwa {

namespace {

std::vector<std::string> partsAtColons(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

std::vector<Override> StudyAxis::overrides(const std::string& value) const {
  const std::vector<std::string> pointers = partsAtColons(pointer);
  if (pointers.size() == 1) return {{pointer, value}};
  const std::vector<std::string> parts = partsAtColons(value);
  std::vector<Override> result;
  for (std::size_t k = 0; k < std::min(pointers.size(), parts.size()); ++k)
    result.push_back({pointers[k], parts[k]});
  return result;
}

std::string StudyAxis::label(const std::string& value) const {
  const std::vector<Override> set = overrides(value);
  return set.back().value;
}

std::size_t StudyPlan::size() const {
  constexpr std::size_t kLargest = std::numeric_limits<std::size_t>::max();
  std::size_t count = 1;
  for (const StudyAxis& axis : axes) {
    const std::size_t values = axis.values.size();
    if (values > 0 && count > kLargest / values) return kLargest;
    count *= values;
  }
  return count;
}

std::vector<std::string> StudyPlan::values(std::size_t run) const {
  std::vector<std::string> result(axes.size());
  std::size_t rest = run - 1;
  for (std::size_t k = axes.size(); k-- > 0;) {
    result[k] = axes[k].values[rest % axes[k].values.size()];
    rest /= axes[k].values.size();
  }
  return result;
}

std::string StudyPlan::describe(const std::vector<std::string>& values, std::size_t first) const {
  std::string text;
  for (std::size_t k = first; k < axes.size(); ++k)
    text += (k > first ? ", " : "") + axes[k].name() + " " + axes[k].label(values[k]);
  return text;
}

std::vector<Override> StudyPlan::overrides(std::size_t run) const {
  std::vector<Override> result = common;
  const std::vector<std::string> chosen = values(run);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const std::vector<Override> set = axes[k].overrides(chosen[k]);
    result.insert(result.end(), set.begin(), set.end());
  }
  return result;
}

std::string runFingerprint(const Scene& scene, double until) {
  Json identity = sceneIdentity(scene);
  identity["until"] = until;
  const std::string text = identity.dump(-1, ' ', false, Json::error_handler_t::replace);
  return hexDigits(checksum(kEmptyChecksum, text.data(), text.size()));
}

std::string runFingerprint(const StudyPlan& plan, std::size_t run) {
  return runFingerprint(readScene(plan.scene, plan.overrides(run)), plan.until);
}

}  // namespace migiwa
