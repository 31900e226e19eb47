// Cases with known answers: falling, flowing, standing and turning water.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/messages.h"
#include "core/study/truth.h"

namespace migiwa {

namespace {

constexpr double kPerMetre = 9810;  // rho0 g (Pa/m)

double endOf(const TruthRun& run) {
  return run.report.simulatedSeconds.value_or(0);
}

/// Mean over the last part of a run, from `part` of its time on.
std::optional<double> settled(const TruthRun& run, const std::string& gauge, double part = 0.9) {
  return meanBetween(run.gauge(gauge), part * endOf(run), endOf(run));
}

/// Values of a formula at the times of a series.
template <class Formula>
Series along(const Series& series, const Formula& formula) {
  Series known;
  for (const double t : series.times) {
    known.times.push_back(t);
    known.values.push_back(formula(t));
  }
  return known;
}

TruthFindings hydrostatics(const TruthRun& run) {
  constexpr double kLevel = 0.75;  // (m)
  const Series floor = run.gauge("floor");
  return {{{"pressure on the floor (Pa)", kPerMetre * kLevel, settled(run, "floor")},
           {"pressure at mid-depth (Pa)", kPerMetre * kLevel / 2, settled(run, "middle")},
           {"height (m)", kLevel, settled(run, "height")},
           {"height in a corner (m)", kLevel, settled(run, "corner")},
           {"rms speed (m/s)", 0, settled(run, "speed"), std::sqrt(kGravity * kLevel)}},
          {{"Water at rest", "pressure on the floor (Pa)", floor,
            along(floor, [](double) { return kPerMetre * kLevel; })}}};
}

TruthFindings freeFall(const TruthRun& run) {
  const Series centre = run.gauge("centre");
  const double end = endOf(run);
  const auto fallen = [](double t) { return -0.5 * kGravity * t * t; };
  return {{{"fallen at the end (m)", fallen(end), valueAt(centre, end)}},
          {{"Free fall", "centre of mass (m)", centre, along(centre, fallen)}}};
}

TruthFindings torricelli(const TruthRun& run) {
  // Below a gate a jet contracts to pi / (pi + 2) of the opening (Kirchhoff 1869), and flows as fast as it
  // would fall from the level.
  constexpr double kLength = 1, kStart = 0.6, kHigh = 0.5, kLow = 0.3;  // (m)
  constexpr double kJet = 0.08 * std::numbers::pi / (std::numbers::pi + 2);
  const auto timeBetween = [&](double high, double low) {
    return 2 * kLength / (kJet * std::sqrt(2 * kGravity)) * (std::sqrt(high - kJet) - std::sqrt(low - kJet));
  };
  const Series level = run.gauge("level");
  Series fallen = level;  // rises, as timeOf() asks
  for (double& value : fallen.values) value = -value;
  const auto high = timeOf(fallen, -kHigh), low = timeOf(fallen, -kLow);
  std::optional<double> taken;
  if (high && low) taken = *low - *high;
  const Series known = along(level, [&](double t) {
    const double root = std::sqrt(kStart - kJet) - t * kJet * std::sqrt(2 * kGravity) / (2 * kLength);
    return kJet + std::pow(std::max(root, 0.0), 2);
  });
  return {{{"time from 0.5 to 0.3 m (s)", timeBetween(kHigh, kLow), taken}},
          {{"Outflow below a gate", "level (m)", level, known}}};
}

TruthFindings piston(const TruthRun& run) {
  // A wall has moved 0.3 m into 1 m of water, 0.4 m deep.
  constexpr double kSpeed = 0.1, kStop = 3, kDepth = 0.4;
  const auto level = [](double t) { return kDepth / (1 - kSpeed * (t < kStop ? t : kStop)); };
  const Series height = run.gauge("level");
  return {{{"level at the end (m)", level(kStop), settled(run, "level")},
           {"pressure on the floor (Pa)", kPerMetre * level(kStop), settled(run, "floor")}},
          {{"Piston", "level (m)", height, along(height, level)}}};
}

TruthFindings vortex(const TruthRun& run, const char* title, double rate) {
  const Series speed = run.gauge("speed");
  const double start = speed.empty() ? 0 : speed.values.front();
  const auto kept = [&](double t) { return start * std::exp(-rate * t); };
  std::vector<TruthAnswer> answers;
  for (const double t : {0.5, 1.0}) {
    const auto now = valueAt(speed, t);
    answers.push_back({"speed kept after " + std::string(t < 1 ? "0.5" : "1") + " s", kept(t) / start,
                       now ? std::optional(*now / start) : std::nullopt});
  }
  return {answers, {{title, "rms speed (m/s)", speed, along(speed, kept)}}};
}

TruthFindings inviscidVortex(const TruthRun& run) {
  return vortex(run, "Vortex in a box", 0);
}

/// Taylor and Green 1937: exp(-2 nu k^2 t).
TruthFindings viscousVortex(const TruthRun& run) {
  return vortex(run, "Vortex in a box of oil", 2 * 0.02 * std::numbers::pi * std::numbers::pi);
}

TruthFindings bucket(const TruthRun& run) {
  constexpr double kTurn = 2 * std::numbers::pi, kRadius = 0.22;  // (rad/s, m): of the rim's gauge
  const double known = kTurn * kTurn * kRadius * kRadius / (2 * kGravity);
  const Series middle = run.gauge("middle"), rim = run.gauge("rim");
  Series rise = rim;
  for (std::size_t k = 0; k < rise.values.size() && k < middle.values.size(); ++k)
    rise.values[k] -= middle.values[k];
  const double end = endOf(run);
  return {{{"rim over middle, first turn (m)", known, meanBetween(rise, 0, 1)},
           {"rim over middle, third turn (m)", known, meanBetween(rise, 2, end)}},
          {{"Turning bucket", "rim over middle (m)", rise, along(rise, [&](double) { return known; })}}};
}

TruthFindings damBreak(const TruthRun& run) {
  constexpr double kColumn = 0.05715;  // (m)
  const double unit = std::sqrt(kColumn / (2 * kGravity));
  // Martin and Moyce 1952, n^2 = 2: T = t sqrt(2 g / a), Z the front over a.
  constexpr double kTimes[]{1.22, 2.00, 2.55, 3.35, 4.42, 5.69, 6.31};
  constexpr double kFronts[]{1.47, 2.29, 3.00, 4.13, 5.88, 7.95, 8.97};
  const Series front = run.gauge("front");
  Series scaled, known;
  for (std::size_t k = 0; k < front.times.size(); ++k) {
    scaled.times.push_back(front.times[k] / unit);
    scaled.values.push_back(front.values[k] / kColumn);
  }
  std::vector<TruthAnswer> answers;
  double squares = 0, count = 0;
  for (std::size_t k = 0; k < std::size(kTimes); ++k) {
    known.times.push_back(kTimes[k]);
    known.values.push_back(kFronts[k]);
    const auto found = valueAt(scaled, kTimes[k]);
    if (!found) continue;
    squares += std::pow(*found / kFronts[k] - 1, 2);
    count += 1;
  }
  const auto found = [&](std::size_t k) { return valueAt(scaled, kTimes[k]); };
  for (const std::size_t k : {1UL, 3UL, 5UL})
    answers.push_back({"front/a at T = " + formatNumber("%.2f", kTimes[k]), kFronts[k], found(k)});
  answers.push_back({"front, rms error of all", 0,
                     count > 0 ? std::optional(std::sqrt(squares / count)) : std::nullopt, 1});
  return {answers, {{"Dam break", "front / a", scaled, known, true, "T = t √(2g/a)"}}};
}

TruthFindings kleefsman(const TruthRun& run) {
  constexpr double kTimes[]{0.5, 1, 1.5, 2}, kHeights[]{0.426, 0.279, 0.182, 0.130};
  struct Peak {
    const char* gauge;
    double pressure;
  };
  constexpr Peak kPeaks[]{{"P1", 11200}, {"P2", 8100}, {"P3", 6600}, {"P4", 7200}};
  const Series height = run.gauge("H4");
  TruthFindings findings;
  Series known;
  for (std::size_t k = 0; k < std::size(kTimes); ++k) {
    known.times.push_back(kTimes[k]);
    known.values.push_back(kHeights[k]);
    findings.answers.push_back(
        {"H4 at " + formatNumber("%.1f", kTimes[k]) + " s (m)", kHeights[k], valueAt(height, kTimes[k])});
  }
  findings.curves.push_back({"Dam break onto a box: H4", "height (m)", height, known, true});
  for (const auto& [gauge, pressure] : kPeaks) {
    const Series series = run.gauge(gauge);
    // Of the first impact.
    const auto peak = peakBetween(series, 0.3, 0.6);
    findings.answers.push_back(
        {std::string(gauge) + " peak (Pa)", pressure, peak ? std::optional(peak->value) : std::nullopt});
    if (gauge == kPeaks[0].gauge) {
      findings.curves.push_back(
          {"Dam break onto a box: P1", "pressure (Pa)", series, {{0.437}, {pressure}}, true});
      findings.answers.push_back({"P1 peak at (s)", 0.437, peak ? std::optional(peak->time) : std::nullopt});
    }
  }
  return findings;
}

}  // namespace

std::vector<TruthCase> truthFlows() {
  return {
      {"hydrostatics",
       "p = ρgz, and nothing moves; speeds as a part of √(gH)",
       {{"5 cm", {}}, {"5 cm, tolerance 0.001", {"/solver/tolerance=0.001", "/solver/max_iterations=60"}}},
       hydrostatics},
      {"free_fall", "y = -gt²/2", {{"5 cm", {}}}, freeFall},
      {"torricelli",
       "Torricelli's speed, and Kirchhoff's contraction π/(π + 2) of a jet below a gate",
       {{"4 cm", {"/particle_spacing=0.04"}}, {"2 cm", {}}},
       torricelli},
      {"piston", "Volume is kept: h = h₀L/(L - Vt)", {{"2 cm", {}}}, piston},
      {"vortex",
       "Taylor and Green 1937, inviscid: the vortex turns for ever",
       {{"2 cm", {}}},
       inviscidVortex},
      {"viscous_vortex", "Taylor and Green 1937: exp(-2νk²t)", {{"2 cm", {}}}, viscousVortex},
      {"bucket", "Newton's bucket: h = ω²r²/2g over the middle", {{"2 cm", {}}}, bucket},
      {"dam_break",
       "Martin and Moyce 1952, n² = 2 (experiment)",
       {{"a/10", {"/particle_spacing=0.005715"}}, {"a/20", {}}},
       damBreak},
      {"kleefsman",
       "Kleefsman and others 2005, SPHERIC test 2 (experiment); the peak of P1 is between 0.415 and 0.459 s",
       {{"5 cm", {"/particle_spacing=0.05"}}, {"2.5 cm", {}}},
       kleefsman},
  };
}

}  // namespace migiwa
