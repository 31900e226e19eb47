#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"
#include "core/study/study.h"

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
  const std::string text = compactJson(identity);
  return hexDigits(checksum(kEmptyChecksum, text.data(), text.size()));
}

std::string runFingerprint(const StudyPlan& plan, std::size_t run) {
  return runFingerprint(readScene(plan.scene, plan.overrides(run)), plan.until);
}

namespace {

Json toJson(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

RunTiming timingOf(const Json& json) {
  RunTiming timing{json.at("wall_ms_per_s").get<double>(),
                   json.at("ms_per_step").get<double>(),
                   {},
                   json.at("step_us").get<std::vector<int>>()};
  for (const auto& [name, value] : json.at("stages_ms").items())
    timing.stages.push_back({name, 1e-3 * value.get<double>()});
  return timing;
}

}  // namespace

std::optional<double> RunRecord::measure(const std::string& name) const {
  for (const auto& [known, value] : measures)
    if (known == name) return value;
  return std::nullopt;
}

std::filesystem::path recordFile(const std::filesystem::path& study, std::size_t run) {
  return study / "runs" / (std::to_string(run) + ".json");
}

void writeRecord(const std::filesystem::path& file, const RunRecord& record) {
  Json root = Json::object();
  root["fingerprint"] = record.fingerprint;
  root["overrides"] = record.overrides;
  root["state_hash"] = record.stateHash;
  root["gamma_method"] = record.gammaMethod;
  root["trouble"] = record.trouble;
  root["threads"] = record.threads;
  root["measures"] = Json::object();
  for (const auto& [name, value] : record.measures) root["measures"][name] = toJson(value);
  root["pressure"] = Json::array();
  for (const PressureLayer& layer : record.pressure)
    root["pressure"].push_back({layer.depth, layer.pressure, layer.particles});
  root["energy"] = Json::array();
  for (const EnergySample& sample : record.energy)
    root["energy"].push_back({sample.time, sample.kinetic, sample.potential, sample.source});
  root["timings"] = Json::array();
  for (const RunTiming& timing : record.timings) {
    Json stages = Json::object();
    for (const StageTime& stage : timing.stages) stages[stage.name] = 1e3 * stage.seconds;
    root["timings"].push_back({{"wall_ms_per_s", timing.wallMsPerSecond},
                               {"ms_per_step", timing.msPerStep},
                               {"stages_ms", stages},
                               {"step_us", timing.stepMicroseconds}});
  }
  writeTextFile(file, prettyJson(root));
}

std::optional<RunRecord> readRecord(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  try {
    const Json root = readJson(readTextFile(file, "the record of a study's run"));
    RunRecord record;
    record.fingerprint = root.at("fingerprint").get<std::string>();
    record.overrides = root.at("overrides").get<std::vector<std::string>>();
    record.stateHash = root.at("state_hash").get<std::string>();
    record.gammaMethod = root.at("gamma_method").get<std::string>();
    record.trouble = root.at("trouble").get<std::string>();
    record.threads = root.at("threads").get<int>();
    for (const auto& [name, value] : root.at("measures").items())
      record.measures.emplace_back(
          name, value.is_null() ? std::nullopt : std::optional<double>(value.get<double>()));
    for (const auto& [depth, pressure, particles] :
         root.at("pressure").get<std::vector<std::array<double, 3>>>())
      record.pressure.push_back({depth, pressure, particles});
    for (const auto& [time, kinetic, potential, source] :
         root.at("energy").get<std::vector<std::array<double, 4>>>())
      record.energy.push_back({time, kinetic, potential, source});
    for (const Json& timing : root.at("timings")) record.timings.push_back(timingOf(timing));
    return record;
  } catch (const Json::exception& error) {
    throw InputError(file.string(), "expected the record of a study's run, found something else (" +
                                        std::string(error.what()) + "); remove it, or take another --out");
  }
}

}  // namespace migiwa
