#include "core/study/pressure_profile.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/upright_tank.h"

namespace migiwa {

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
