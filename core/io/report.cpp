// The report's JSON, written and read through one list of its keys.
#include "core/io/report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/json.h"

namespace migiwa {

namespace {

/// Calls visit(pointer, member) for every key in the order of the file.
template <class SomeReport, class Visit>
void visitReport(SomeReport& report, const Visit& visit) {
  visit("/scene", report.scene);
  visit("/overrides", report.overrides);
  visit("/boundary/handling", report.handling);
  visit("/boundary/gamma_method", report.gammaMethod);
  visit("/boundary/gamma_reason", report.gammaReason);
  visit("/steps", report.steps);
  visit("/simulated_s", report.simulatedSeconds);
  visit("/wall_s", report.wallSeconds);
  visit("/threads", report.threads);
  visit("/particles", report.particles);
  visit("/state_hash", report.stateHash);
  visit("/step_ms/median", report.stepMedian);
  visit("/step_ms/p95", report.stepP95);
  visit("/stages_ms", report.stages);
  visit("/ns_per_particle_iteration", report.nanosecondsPerParticleIteration);
  visit("/iterations/mean", report.iterationsMean);
  visit("/iterations/max", report.iterationsMax);
  visit("/iterations/pressure", report.pressureIterationsMean);
  visit("/density_error/mean", report.densityErrorMean);
  visit("/density_error/max", report.densityErrorMax);
  visit("/lost_particles", report.lostParticles);
  visit("/nonfinite_particles", report.nonfiniteParticles);
  visit("/totals/started", report.startedParticles);
  visit("/totals/emitted", report.emittedParticles);
  visit("/left/particles", report.leftParticles);
  visit("/left/volume", report.leftVolume);
  visit("/drained/particles", report.drainedParticles);
  visit("/drained/volume", report.drainedVolume);
  visit("/drained/drains", report.drains);
  visit("/gauges", report.gauges);
  visit("/max_penetration", report.maxPenetration);
  visit("/max_speed", report.maxSpeed);
  visit("/peak_memory_bytes", report.peakMemoryBytes);
  visit("/energy/start", report.energyStart);
  visit("/energy/kinetic", report.energyKinetic);
  visit("/energy/potential", report.energyPotential);
  visit("/energy/work/walls", report.energyWalls);
  visit("/energy/work/emitters", report.energyEmitters);
  visit("/energy/work/outflow", report.energyOutflow);
  visit("/energy/work/effects", report.energyEffects);
  visit("/energy/dissipated", report.energyDissipated);
  visit("/energy/largest_gain", report.energyGain);
  visit("/energy/stored_at_start", report.energyStored);
  visit("/trouble", report.trouble);
  visit("/settled/height", report.settled.height);
  visit("/settled/expected_height", report.settled.expectedHeight);
  visit("/settled/near_wall_spacing_p1", report.settled.nearWallSpacingP1);
  visit("/settled/bulk_spacing_p1", report.settled.bulkSpacingP1);
  visit("/settled/edge_crowding", report.settled.edgeCrowding);
  visit("/settled/rms_speed", report.settled.rmsSpeed);
}

/// Whole numbers without a fraction, so that counts look like counts.
Json toJson(const Measure& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  if (std::abs(*value) < 9e15 && std::trunc(*value) == *value) return static_cast<std::int64_t>(*value);
  return *value;
}

Json toJson(const std::string& value) {
  return value;
}

Json toJson(const std::vector<std::string>& value) {
  return value;
}

Json toJson(const std::vector<StageTime>& stages) {
  Json object = Json::object();
  for (const StageTime& stage : stages) object[stage.name] = toJson(1e3 * stage.seconds);
  return object;
}

Json toJson(const std::vector<DrainReport>& drains) {
  Json array = Json::array();
  for (const DrainReport& drain : drains)
    array.push_back({{"particles", toJson(drain.particles)},
                     {"volume", toJson(drain.volume)},
                     {"times", drain.times},
                     {"volumes", drain.volumes}});
  return array;
}

Json toJson(const std::vector<GaugeReport>& gauges) {
  Json array = Json::array();
  for (const GaugeReport& gauge : gauges)
    array.push_back({{"name", gauge.name},
                     {"kind", gauge.kind},
                     {"unit", gauge.unit},
                     {"times", gauge.times},
                     {"values", gauge.values}});
  return array;
}

Json toJson(const std::vector<Trouble>& trouble) {
  Json array = Json::array();
  for (const Trouble& item : trouble)
    array.push_back(
        {{"kind", item.kind}, {"step", item.step}, {"count", item.count}, {"detail", item.detail}});
  return array;
}

/// Reads one member; a fault where the file has something else there.
class MemberReader {
 public:
  MemberReader(const Json& root, FaultList& faults) : root_(root), faults_(faults) {}

  void operator()(const char* pointer, Measure& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (found->is_number()) {
      value = found->get<double>();
    } else {
      wrong(pointer, "a number or null", *found);
    }
  }
  void operator()(const char* pointer, std::string& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (found->is_string()) {
      value = found->get<std::string>();
    } else {
      wrong(pointer, "a text", *found);
    }
  }
  void operator()(const char* pointer, std::vector<std::string>& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (!found->is_array()) return wrong(pointer, "an array of texts", *found);
    for (const Json& entry : *found) {
      if (entry.is_string()) {
        value.push_back(entry.get<std::string>());
      } else {
        wrong(pointer, "an array of texts", entry);
      }
    }
  }
  void operator()(const char* pointer, std::vector<StageTime>& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (!found->is_object()) return wrong(pointer, "an object", *found);
    for (const auto& item : found->items()) {
      if (item.value().is_number()) {
        value.push_back({item.key(), 1e-3 * item.value().get<double>()});
      } else if (!item.value().is_null()) {
        wrong(childPointer(pointer, item.key()), "a number or null", item.value());
      }
    }
  }
  void operator()(const char* pointer, std::vector<Trouble>& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (!found->is_array()) return wrong(pointer, "an array of objects", *found);
    for (std::size_t k = 0; k < found->size(); ++k) {
      const Json& entry = (*found)[k];
      Trouble item;
      if (take(entry, "kind", item.kind) && take(entry, "step", item.step) &&
          take(entry, "count", item.count) && take(entry, "detail", item.detail)) {
        value.push_back(std::move(item));
      } else {
        wrong(childPointer(pointer, k), "an object with kind, step, count and detail", entry);
      }
    }
  }
  void operator()(const char* pointer, std::vector<DrainReport>& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (!found->is_array()) return wrong(pointer, "an array of objects", *found);
    for (std::size_t k = 0; k < found->size(); ++k) {
      const Json& entry = (*found)[k];
      DrainReport drain;
      if (take(entry, "particles", drain.particles) && take(entry, "volume", drain.volume) &&
          take(entry, "times", drain.times) && take(entry, "volumes", drain.volumes)) {
        value.push_back(std::move(drain));
      } else {
        wrong(childPointer(pointer, k), "an object with particles, volume, times and volumes", entry);
      }
    }
  }
  void operator()(const char* pointer, std::vector<GaugeReport>& value) const {
    const Json* const found = find(pointer);
    if (found == nullptr) return;
    if (!found->is_array()) return wrong(pointer, "an array of objects", *found);
    for (std::size_t k = 0; k < found->size(); ++k) {
      const Json& entry = (*found)[k];
      GaugeReport gauge;
      if (take(entry, "name", gauge.name) && take(entry, "kind", gauge.kind) &&
          take(entry, "unit", gauge.unit) && take(entry, "times", gauge.times) &&
          take(entry, "values", gauge.values)) {
        value.push_back(std::move(gauge));
      } else {
        wrong(childPointer(pointer, k), "an object with name, kind, unit, times and values", entry);
      }
    }
  }

 private:
  /// Null where the key is missing or null itself.
  const Json* find(const char* pointer) const {
    const Json::json_pointer place(pointer);
    if (!root_.contains(place)) return nullptr;
    const Json& found = root_.at(place);
    return found.is_null() ? nullptr : &found;
  }
  static bool take(const Json& object, const char* key, std::string& value) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return false;
    value = object[key].get<std::string>();
    return true;
  }
  static bool take(const Json& object, const char* key, long& value) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_number_integer()) return false;
    value = object[key].get<long>();
    return true;
  }
  static bool take(const Json& object, const char* key, Measure& value) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_number()) return false;
    value = object[key].get<double>();
    return true;
  }
  static bool take(const Json& object, const char* key, std::vector<double>& values) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_array()) return false;
    for (const Json& entry : object[key]) {
      if (!entry.is_number()) return false;
      values.push_back(entry.get<double>());
    }
    return true;
  }
  void wrong(std::string_view pointer, const std::string& expected, const Json& found) const {
    faults_.add(pointer, "expected " + expected + ", found " + describeJson(found));
  }

  const Json& root_;
  FaultList& faults_;
};

}  // namespace

std::string reportText(const Report& report) {
  Json root = Json::object();
  visitReport(report, [&](const char* pointer, const auto& value) {
    root[Json::json_pointer(pointer)] = toJson(value);
  });
  return prettyJson(root);
}

std::string gaugesCsv(const Report& report) {
  std::string text = "time (s)";
  std::map<double, std::vector<Measure>> rows;
  const std::size_t columns = report.gauges.size();
  for (std::size_t k = 0; k < columns; ++k) {
    const GaugeReport& gauge = report.gauges[k];
    text += "," + gauge.name + " (" + gauge.unit + ")";
    for (std::size_t row = 0; row < gauge.times.size(); ++row)
      rows.try_emplace(gauge.times[row], columns).first->second[k] = gauge.values[row];
  }
  text += '\n';
  for (const auto& [time, values] : rows) {
    text += formatNumber("%.9g", time);
    for (const Measure& value : values) text += "," + (value ? formatNumber("%.9g", *value) : "");
    text += '\n';
  }
  return text;
}

Report readReport(const std::filesystem::path& file) {
  const JsonDocument document = parseJson(readTextFile(file, "a report"));
  if (document.broken)
    throw InputError(file.string() + ":" + document.faults.front().pointer, document.faults.front().message);
  FaultList faults(file.string());
  for (const DocumentFault& fault : document.faults) faults.add(fault.pointer, fault.message);

  Report report;
  if (document.root.is_object() && document.root.contains("steps") && document.root.contains("particles")) {
    const MemberReader read(document.root, faults);
    visitReport(report, [&](const char* pointer, auto& member) { read(pointer, member); });
  } else {
    faults.add("", "expected a report, which has the keys steps and particles, found " +
                       describeJson(document.root) + " without them");
  }
  if (!faults.empty()) throw InputError(faults.faults());
  return report;
}

// From what a run counted to what a report says.

namespace {

/// In joules; `mass` of a particle (kg).
void reportEnergy(const EnergyBalance& energy, double mass, Report& report) {
  report.energyStart = mass * energy.start;
  report.energyKinetic = mass * energy.kinetic;
  report.energyPotential = mass * energy.potential;
  report.energyWalls = mass * energy.walls;
  report.energyEmitters = mass * energy.emitters;
  report.energyOutflow = mass * energy.outflow;
  report.energyEffects = mass * energy.effects;
  report.energyDissipated = -mass * energy.solver;
  report.energyGain = energy.mostGained;
  report.energyStored = energy.stored;
}

/// `volume` of a particle (m^3).
void reportFluid(const FluidBalance& fluid, double volume, Report& report) {
  const auto volumeOf = [&](std::int64_t particles) { return volume * static_cast<double>(particles); };
  report.startedParticles = static_cast<double>(fluid.started);
  report.emittedParticles = static_cast<double>(fluid.emitted);
  report.leftParticles = static_cast<double>(fluid.left);
  report.leftVolume = volumeOf(fluid.left);
  report.drainedParticles = static_cast<double>(fluid.drained());
  report.drainedVolume = volumeOf(fluid.drained());
  for (const DrainTally& drain : fluid.drains) {
    DrainReport& taken = report.drains.emplace_back();
    taken.particles = static_cast<double>(drain.particles);
    taken.volume = volumeOf(drain.particles);
    for (const DrainSample& sample : drain.history) {
      taken.times.push_back(sample.time);
      taken.volumes.push_back(volumeOf(sample.particles));
    }
  }
}

std::vector<GaugeReport> reportGauges(const std::vector<Gauge>& gauges,
                                      const std::vector<GaugeSeries>& series) {
  std::vector<GaugeReport> reports;
  for (std::size_t k = 0; k < std::min(gauges.size(), series.size()); ++k) {
    const auto kind = static_cast<std::size_t>(gauges[k].kind);
    GaugeReport& own = reports.emplace_back(GaugeReport{
        gauges[k].name, std::string(kGaugeKindNames[kind]), std::string(gauges[k].unit()), {}, {}});
    for (const GaugeSample& sample : series[k].history) {
      own.times.push_back(sample.time);
      own.values.push_back(sample.value);
    }
  }
  return reports;
}

/// The value that a fraction `q` of all values does not exceed (nearest rank).
Measure quantile(std::vector<float> values, double q) {
  if (values.empty()) return std::nullopt;
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  const std::size_t at = std::max<std::size_t>(rank, 1) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

Measure ratio(double value, double over) {
  return over > 0 ? Measure(value / over) : std::nullopt;
}

Measure milliseconds(Measure seconds) {
  return seconds ? Measure(1e3 * *seconds) : std::nullopt;
}

double iterationSeconds(const StageTimes& stages, SolverMethod method) {
  if (method != SolverMethod::pbf) return stages.seconds("pressure");
  return stages.seconds("lambda") + stages.seconds("position") + stages.seconds("projection") +
         stages.seconds("gamma_refresh");
}

}  // namespace

Report makeReport(const Simulation& simulation, const SettledMeasures& settled,
                  const std::vector<Override>& overrides) {
  const RunStatistics& run = simulation.statistics();
  const auto steps = static_cast<double>(run.steps);
  const auto particles = static_cast<double>(simulation.view().positions.size());
  const BoundaryParameters boundary = simulation.settings().boundary;

  Report report;
  report.scene = simulation.scene().file.string();
  for (const Override& override : overrides)
    report.overrides.push_back(override.pointer + "=" + override.value);
  report.steps = steps;
  report.simulatedSeconds = run.simulatedSeconds;
  report.wallSeconds = run.wallSeconds;
  report.threads = simulation.threads();
  report.particles = particles;
  report.stateHash = hexDigits(simulation.stateHash());
  report.handling = handlingNames()[static_cast<std::size_t>(boundary.handling)];
  report.gammaMethod = run.gammaPicked;
  report.gammaReason = run.gammaReason;
  report.stepMedian = milliseconds(quantile(run.stepSeconds, 0.5));
  report.stepP95 = milliseconds(quantile(run.stepSeconds, 0.95));
  for (const StageTime& stage : run.stages.stages())
    report.stages.push_back({stage.name, stage.seconds / std::max(steps, 1.0)});
  report.nanosecondsPerParticleIteration = ratio(
      1e9 * iterationSeconds(run.stages, simulation.settings().solver.method), run.particleIterationSum);
  report.iterationsMean = ratio(run.iterationSum, steps);
  report.iterationsMax = run.iterationMax;
  if (simulation.settings().solver.solvesDivergence())
    report.pressureIterationsMean = ratio(run.pressureIterationSum, steps);
  report.densityErrorMean = ratio(run.densityErrorSum, steps);
  report.densityErrorMax = run.densityErrorMax;
  report.lostParticles = static_cast<double>(run.lostParticles);
  report.nonfiniteParticles = static_cast<double>(run.nonfiniteParticles);
  report.maxPenetration = run.maxPenetration;
  report.maxSpeed = run.maxSpeed;
  report.peakMemoryBytes = peakMemory();
  const double spacing = simulation.scene().particleSpacing;
  const double volume = spacing * spacing * spacing;
  reportFluid(run.fluid, volume, report);
  reportEnergy(run.energy, simulation.settings().solver.restDensity * volume, report);
  report.gauges = reportGauges(simulation.scene().gauges, run.gauges);
  report.trouble = run.trouble;
  report.settled = settled;
  return report;
}

}  // namespace migiwa
