// Cases with known answers: waves, oscillations, drops.
#include <cmath>
#include <numbers>

#include "core/study/truth.h"

namespace migiwa {

namespace {

/// A sine of known period and height about a level, from `start` on.
Series cosine(double level, double height, double period, double until) {
  Series series;
  for (int k = 0; k <= 400; ++k) {
    const double t = until * k / 400;
    series.times.push_back(t);
    series.values.push_back(level + height * std::cos(2 * std::numbers::pi * t / period));
  }
  return series;
}

double endOf(const Series& series) {
  return series.empty() ? 0 : series.times.back();
}

/// How a wave keeps its height and its period (s).
std::vector<TruthAnswer> keptWave(const Series& series, double period) {
  const WaveMeasures found = waveMeasures(series);
  return {{"height kept a period", 1, found.kept}, {"period (s)", period, found.period}};
}

/// Linear theory of a wave of wave number k (1/m) over the depth (m).
double linearPeriod(double k, double depth) {
  return 2 * std::numbers::pi / std::sqrt(kGravity * k * std::tanh(k * depth));
}

TruthFindings standingWave(const TruthRun& run) {
  const Series centre = run.gauge("centre");
  const double period = linearPeriod(std::numbers::pi, 0.5);
  // Half a wave H cos(pi x / L) over the depth d carries the centre of mass by -2 H L / (pi^2 d).
  return {keptWave(centre, period),
          {{"Standing wave", "centre of mass (m)", centre,
            cosine(0.5, -2 * 0.05 / (std::numbers::pi * std::numbers::pi * 0.5), period, endOf(centre))}}};
}

TruthFindings uTube(const TruthRun& run) {
  // Two arms and a bottom of 0.4 m each, and two corners, of which each counts as 0.559 of its width.
  const double length = 3 * 0.4 + 2 * 0.559 * 0.1;
  const double period = 2 * std::numbers::pi * std::sqrt(length / (2 * kGravity));
  const Series left = run.gauge("left"), centre = run.gauge("centre");
  // The centre of mass is in the middle when the levels are the same.
  constexpr double kMiddle = 0.3;  // (m)
  TruthAnswer swing{"first swing over the start", 1, {}};
  if (const auto farthest = peakBetween(centre, 0, 0.75 * period))
    swing.found = (farthest->value - kMiddle) / (kMiddle - centre.values.front());
  std::vector<TruthAnswer> answers = keptWave(centre, period);
  answers.insert(answers.begin(), swing);
  return {answers, {{"U-tube", "height in the left arm (m)", left, cosine(0.5, 0.05, period, endOf(left))}}};
}

constexpr double kSolitaryDepth = 0.3, kSolitaryHeight = 0.09, kCrest = 2;  // (m)

TruthFindings solitaryWave(const TruthRun& run) {
  const double speed = std::sqrt(kGravity * (kSolitaryDepth + kSolitaryHeight));
  const Series first = run.gauge("3.5 m"), second = run.gauge("5.5 m");
  const double end = endOf(second);
  const auto near = peakBetween(first, 0, end), far = peakBetween(second, 0, end);
  TruthAnswer travelled{"speed (m/s)", speed, {}}, crest{"crest after 3.5 m (m)", kSolitaryHeight, {}};
  if (near && far && far->time > near->time && far->time < end) {
    travelled.found = 2 / (far->time - near->time);
    crest.found = far->value - kSolitaryDepth;
  }
  Series known;
  const double k = std::sqrt(0.75 * kSolitaryHeight / kSolitaryDepth) / kSolitaryDepth;
  for (const double t : second.times) {
    const double c = std::cosh(k * (5.5 - kCrest - speed * t));
    known.times.push_back(t);
    known.values.push_back(kSolitaryDepth + kSolitaryHeight / (c * c));
  }
  return {{travelled, crest}, {{"Solitary wave after 3.5 m", "height of the surface (m)", second, known}}};
}

TruthFindings sloshing(const TruthRun& run) {
  // The tank rolls for three periods, and then the water swings by itself.
  constexpr double kStop = 3 * 1.63;
  const double period = linearPeriod(std::numbers::pi / 0.9, 0.093);
  const Series all = run.gauge("centre");
  Series after;
  for (std::size_t k = 0; k < all.times.size(); ++k)
    if (all.times[k] >= kStop) {
      after.times.push_back(all.times[k]);
      after.values.push_back(all.values[k]);
    }
  return {{{"period after the roll (s)", period, waveMeasures(after).period}},
          {{"Sloshing: pressure at the still level", "pressure (Pa)", run.gauge("sensor"), {}},
           {"Sloshing: centre of mass", "centre of mass (m)", all, {}}}};
}

constexpr double kDropRadius = 0.0035, kTension = 0.072;  // (m, N/m)

TruthFindings oscillatingDrop(const TruthRun& run) {
  const double period = 2 * std::numbers::pi * std::sqrt(1000 * std::pow(kDropRadius, 3) / (8 * kTension));
  const Series width = run.gauge("width");
  const WaveMeasures found = waveMeasures(width);
  return {{{"period (s)", period, found.period}}, {{"Oscillating drop", "width (m)", width, {}}}};
}

TruthFindings restingDrops(const TruthRun& run) {
  constexpr double kLarge = 0.0055;  // (m): radius of the other drop
  const double end = run.report.simulatedSeconds.value_or(0);
  Series more = run.gauge("small");
  const Series large = run.gauge("large");
  for (std::size_t k = 0; k < more.values.size() && k < large.values.size(); ++k)
    more.values[k] -= large.values[k];
  // Cohesion has a pressure of its own, the same in both.
  const double known = 2 * kTension / kDropRadius - 2 * kTension / kLarge;
  return {{{"more pressure in the small drop (Pa)", known, meanBetween(more, 0.5 * end, end)},
           {"width of the small drop (m)", 2 * kDropRadius, meanBetween(run.gauge("width"), 0.5 * end, end)},
           {"rms speed (m/s)", 0, meanBetween(run.gauge("speed"), 0.9 * end, end),
            std::sqrt(kTension / (1000 * kDropRadius))}},
          {{"Two resting drops", "more pressure in the small one (Pa)", more, {{0, end}, {known, known}}}}};
}

}  // namespace

std::vector<TruthCase> truthWaves() {
  return {
      {"standing_wave",
       "Linear theory of an inviscid liquid: T = 2π/√(gk tanh kd), and nothing is lost",
       {{"4 cm", {"/particle_spacing=0.04"}}, {"2 cm", {}}, {"1 cm", {"/particle_spacing=0.01"}}},
       standingWave},
      {"u_tube",
       "T = 2π√(L/2g); L is that of potential flow, in which a corner counts as 0.559 of its width",
       {{"2.5 cm", {"/particle_spacing=0.025"}}, {"1.25 cm", {}}},
       uTube},
      {"solitary_wave",
       "Boussinesq 1872: the form stays as it is and travels at √(g(d + H))",
       {{"3 cm", {"/particle_spacing=0.03"}}, {"2 cm", {}}},
       solitaryWave},
      {"sloshing",
       "Linear theory: T = 2π/√(gk tanh kd), for low waves; the tank is that of SPHERIC test 10",
       {{"1.5 cm", {"/particle_spacing=0.015"}},
        {"1.5 cm, roll of 0.3 degrees",
         {"/particle_spacing=0.015", "/boundary/surfaces/0/motion/oscillation/degrees=0.3"}},
        {"1 cm", {}}},
       sloshing},
      {"oscillating_drop", "Rayleigh 1879: T = 2π√(ρR³/8σ)", {{"0.5 mm", {}}}, oscillatingDrop},
      {"resting_drops",
       "Young and Laplace: p = 2σ/R, in a drop less that in another; speeds as a part of √(σ/ρR)",
       {{"0.5 mm", {}}},
       restingDrops},
  };
}

}  // namespace migiwa
