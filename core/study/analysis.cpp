#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>

#include "core/simulation/measures.h"
#include "core/study/study.h"

namespace migiwa {

namespace {

/// NaN for what is no number.
double numberOf(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' ? number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

bool isNumeric(const StudyAxis& axis) {
  return std::all_of(axis.values.begin(), axis.values.end(),
                     [](const std::string& value) { return !std::isnan(numberOf(value)); });
}

std::vector<std::size_t> convergenceAxes(const StudyPlan& plan) {
  std::vector<std::size_t> axes;
  for (std::size_t k = 0; k < plan.axes.size(); ++k) {
    const std::vector<std::string>& values = plan.axes[k].values;
    if (values.size() >= 3 && std::all_of(values.begin(), values.end(),
                                          [](const std::string& value) { return numberOf(value) > 0; }))
      axes.push_back(k);
  }
  return axes;
}

std::vector<ConvergenceLine> convergenceOf(const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                                           std::size_t axis, const AccuracyMeasure& measure) {
  std::vector<ConvergenceLine> lines;
  for (const FinishedRun& run : runs) {
    std::string label;
    for (std::size_t k = 0; k < plan.axes.size(); ++k)
      if (k != axis)
        label += (label.empty() ? "" : ", ") + (isNumeric(plan.axes[k]) ? plan.axes[k].name() + " " : "") +
                 plan.axes[k].label(run.values[k]);
    auto line =
        std::find_if(lines.begin(), lines.end(), [&](const auto& known) { return known.label == label; });
    if (line == lines.end()) line = lines.insert(lines.end(), {label, {}, {}});
    const std::optional<double> error = measure.error(run.record);
    if (error && *error > 0) line->points.push_back({numberOf(run.values[axis]), *error});
  }
  for (ConvergenceLine& line : lines) line.order = measuredOrder(line.points);
  return lines;
}

std::optional<double> measuredOrder(std::span<const ValueAndError> points) {
  double count = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  std::set<double> values;
  for (const auto& [value, error] : points) {
    if (!(value > 0 && error > 0)) continue;
    const double x = std::log(value), y = std::log(error);
    count += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    values.insert(value);
  }
  if (values.size() < 3) return std::nullopt;
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points) {
  struct Point {
    double cost, error;
    std::size_t index;
  };
  std::vector<Point> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].cost && points[i].error) order.push_back({*points[i].cost, *points[i].error, i});
  std::sort(order.begin(), order.end(), [](const Point& a, const Point& b) {
    return std::pair(a.cost, a.error) != std::pair(b.cost, b.error)
               ? std::pair(a.cost, a.error) < std::pair(b.cost, b.error)
               : a.index < b.index;
  });
  std::vector<std::size_t> front;
  const Point* best = nullptr;  // the last that was taken: by now the most exact
  for (const Point& point : order) {
    const bool same = best != nullptr && point.cost == best->cost && point.error == best->error;
    if (best != nullptr && !same && point.error >= best->error) continue;
    front.push_back(point.index);
    best = &point;
  }
  return front;
}

void PressureProfile::sample(const Simulation& simulation) {
  const FrameView view = simulation.view();
  sample(simulation.scene(), view.positions, view.pressure);
}

void PressureProfile::sample(const Scene& scene, std::span<const Float4> positions,
                             std::span<const float> pressures) {
  const std::optional<UprightTank> tank = uprightTank(scene);
  if (!tank || positions.empty() || pressures.size() != positions.size()) return;
  const double a = scene.particleSpacing;
  perDepth_ = scene.solver.restDensity * scene.gravity.norm();
  level_ = tank->levelOf(static_cast<double>(positions.size()) * a * a * a);
  ++samples_;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double depth = std::max(level_ - tank->heightOf(positions[i].xyz().cast<double>()), 0.0);
    // What has fallen out of the tank is in no layer of its water.
    constexpr double kMostLayers = 1e6;
    if (!(depth / a < kMostLayers)) continue;
    const auto layer = static_cast<std::size_t>(depth / a);
    if (layer >= sums_.size()) sums_.resize(layer + 1);
    sums_[layer].depth += depth;
    sums_[layer].pressure += static_cast<double>(pressures[i]);
    ++sums_[layer].particles;
  }
}

std::vector<PressureLayer> PressureProfile::layers() const {
  std::vector<PressureLayer> result;
  for (const Sums& sums : sums_) {
    if (sums.particles == 0) continue;
    const auto count = static_cast<double>(sums.particles);
    result.push_back({sums.depth / count, sums.pressure / count, count / static_cast<double>(samples_)});
  }
  return result;
}

std::optional<double> PressureProfile::error() const {
  double squares = 0, particles = 0;
  for (const PressureLayer& layer : layers()) {
    const double off = layer.pressure - perDepth_ * layer.depth;
    squares += layer.particles * off * off;
    particles += layer.particles;
  }
  if (particles <= 0 || level_ <= 0) return std::nullopt;
  return std::sqrt(squares / particles) / (perDepth_ * level_);
}

}  // namespace migiwa
