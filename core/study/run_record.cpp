#include "core/study/run_record.h"

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/io/output_file.h"
#include "core/scene/json_document.h"

namespace migiwa {

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
    const Json root = Json::parse(readTextFile(file, "the record of a study's run"));
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
