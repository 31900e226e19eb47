#include "core/simulation/gauges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/simulation/state.h"
#include "core/simulation/statistics.h"
#include "core/walls/moving.h"

namespace migiwa {

namespace {

/// Places of a line for each spacing.
constexpr double kPlacesPerSpacing = 8;
/// gamma below this is that of a place in a wall, where density over gamma means nothing.
constexpr float kLeastGamma = 0.1F;

}  // namespace

GaugeReader::GaugeReader(const Scene& scene, const Boundary& boundary)
    : gauges_(scene.gauges),
      boundary_(boundary),
      gravity_(scene.gravity),
      spacing_(scene.particleSpacing),
      restDensity_(scene.solver.restDensity) {}

bool GaugeReader::readsPressure() const {
  return std::any_of(gauges_.begin(), gauges_.end(),
                     [](const Gauge& gauge) { return gauge.kind == GaugeKind::pressure; });
}

GaugeReader::Probe GaugeReader::probeOf(const Gauge& gauge) const {
  Probe probe{gauge.at, gauge.direction};
  if (probe.up.norm() < 1e-12) probe.up = gravity_.norm() > 0 ? Vec3d(-gravity_) : Vec3d(Vec3d::UnitY());
  probe.up.normalize();
  if (gauge.wall < 0) return probe;
  const auto& wall = boundary_.surfaces()[static_cast<std::size_t>(gauge.wall)];
  if (const auto* moving = dynamic_cast<const MovingSurface*>(wall.get())) {
    probe.at = moving->toWorld(probe.at.cast<float>()).cast<double>();
    probe.up = moving->directionToWorld(probe.up.cast<float>()).cast<double>();
  }
  return probe;
}

std::optional<double> GaugeReader::read(std::size_t k, const GaugedFluid& fluid, const GammaMethod* gamma,
                                        KernelType kernel, double supportRadius) const {
  const Gauge& gauge = gauges_[k];
  const auto count = static_cast<double>(fluid.positions.size());
  if (gauge.kind == GaugeKind::height) return wetLength(probeOf(gauge), fluid, gamma, kernel, supportRadius);
  if (gauge.kind == GaugeKind::pressure)
    return pressureAt(probeOf(gauge).at, gauge.radius > 0 ? gauge.radius : supportRadius, fluid, kernel);
  if (fluid.positions.empty()) return std::nullopt;
  if (gauge.kind == GaugeKind::speed) {
    double squares = 0;
    for (const Float4& v : fluid.velocities) squares += v.xyz().cast<double>().squaredNorm();
    return std::sqrt(squares / count);
  }
  const Vec3d direction = gauge.direction.normalized();
  double sum = 0, farthest = -std::numeric_limits<double>::infinity();
  for (const Float4& p : fluid.positions) {
    const double along = direction.dot(p.xyz().cast<double>() - gauge.at);
    sum += along;
    farthest = std::max(farthest, along);
  }
  return gauge.kind == GaugeKind::centre ? sum / count : farthest + 0.5 * spacing_;
}

double GaugeReader::wetLength(const Probe& line, const GaugedFluid& fluid, const GammaMethod* gamma,
                              KernelType kernel, double support) const {
  // Of what is in reach of the line: how far along it, and the squared distance from it.
  struct Near {
    double along, squared;
  };
  std::vector<Near> near;
  double top = 0;
  for (const Float4& p : fluid.positions) {
    const Vec3d offset = p.xyz().cast<double>() - line.at;
    const double along = line.up.dot(offset);
    const double squared = (offset - along * line.up).squaredNorm();
    if (squared >= support * support || along < -support) continue;
    near.push_back({along, squared});
    top = std::max(top, along + support);
  }
  const double step = spacing_ / kPlacesPerSpacing;
  const auto places = static_cast<std::size_t>(std::ceil(top / step)) + 1;
  std::vector<double> filled(places, 0);
  const double scale = spacing_ * spacing_ * spacing_ / (support * support * support);
  withKernel(kernel, [&](auto w) {
    for (const auto& [along, squared] : near) {
      const double half = std::sqrt(support * support - squared);
      const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil((along - half) / step)));
      for (std::size_t k = first; k < places; ++k) {
        const double away = static_cast<double>(k) * step - along;
        if (away >= half) break;
        const double distance = std::sqrt(squared + away * away);
        filled[k] += scale * static_cast<double>(decltype(w)::value(static_cast<float>(distance / support)));
      }
    }
  });
  if (gamma != nullptr) {
    for (std::size_t k = 0; k < places; ++k) {
      // gamma is 1 at most: these are wet, and those dry, whatever it is.
      if (filled[k] >= 0.5 || filled[k] < 0.5 * static_cast<double>(kLeastGamma)) continue;
      const Float4 place(Vec3f((line.at + static_cast<double>(k) * step * line.up).cast<float>()));
      GammaSample sample;
      gamma->evaluate({&place, 1}, {&sample, 1});
      if (gamma->form() == WallDensity::added)
        filled[k] += static_cast<double>(1 - sample.gamma);
      else
        filled[k] /= static_cast<double>(std::max(sample.gamma, kLeastGamma));
    }
  }
  double length = 0;
  for (std::size_t k = 0; k + 1 < places; ++k) {
    const double low = std::min(filled[k], filled[k + 1]), high = std::max(filled[k], filled[k + 1]);
    if (low >= 0.5)
      length += step;
    else if (high > 0.5)
      length += step * (high - 0.5) / (high - low);
  }
  return length;
}

std::optional<double> GaugeReader::pressureAt(const Vec3d& at, double radius, const GaugedFluid& fluid,
                                              KernelType kernel) const {
  if (fluid.pressures.size() != fluid.positions.size() || fluid.positions.empty()) return std::nullopt;
  double weights = 0, pressures = 0;
  Vec3d offsets = Vec3d::Zero();
  withKernel(kernel, [&](auto w) {
    for (std::size_t i = 0; i < fluid.positions.size(); ++i) {
      const Vec3d offset = fluid.positions[i].xyz().cast<double>() - at;
      const double squared = offset.squaredNorm();
      if (squared >= radius * radius) continue;
      const auto weight =
          static_cast<double>(decltype(w)::value(static_cast<float>(std::sqrt(squared) / radius)));
      weights += weight;
      pressures += weight * static_cast<double>(fluid.pressures[i]);
      offsets += weight * offset;
    }
  });
  if (weights <= 0) return 0.0;
  return std::max(0.0, (pressures - restDensity_ * gravity_.dot(offsets)) / weights);
}

std::vector<GaugeSample> GaugeSeries::few() const {
  const std::size_t stride = history.size() / Thinning::kMostSamples + 1;
  std::vector<GaugeSample> samples;
  for (std::size_t k = history.empty() ? 0 : (history.size() - 1) % stride; k < history.size(); k += stride)
    samples.push_back(history[k]);
  return samples;
}

void GaugeSeries::visit(StateVisitor& visitor, const std::string& name) {
  visitor.array(name.substr(1), history);
  thinning.visit(visitor, name);
}

GammaContext gammaContextOf(const Scene& scene, const Boundary& boundary, ThreadPool& pool) {
  return {boundary,
          scene.solver.kernel,
          static_cast<float>(scene.supportRadius()),
          scene.boundary.directions,
          scene.boundary.samples,
          scene.bounds(),
          &pool,
          scene.file.string() + ":/boundary/gamma/method",
          static_cast<float>(scene.particleSpacing)};
}

PickedGamma gammaMethodOf(const Scene& scene, const GammaContext& context) {
  PickedGamma picked = makeHandling(scene.boundary.handling, scene.boundary.gammaMethod, context);
  return picked.method ? std::move(picked) : makeGammaMethod(scene.boundary.gammaMethod, context);
}

WallQuery::WallQuery(const Scene& scene, int threads)
    : origin_(scene.origin),
      supportRadius_(static_cast<float>(scene.supportRadius())),
      pool_(threads),
      boundary_(wallsFor(scene.surfaces, supportRadius_)),
      picked_(gammaMethodOf(scene, gammaContextOf(scene, boundary_, pool_))) {}

std::vector<WallAnswer> WallQuery::answers(std::span<const Vec3d> points) {
  std::vector<WallAnswer> answers(points.size());
  parallelFor(pool_, points.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Float4> at;
    for (std::size_t i = begin; i < end; ++i) at.emplace_back(Vec3f((points[i] - origin_).cast<float>()));
    std::vector<GammaSample> samples(at.size());
    picked_.method->evaluate(at, samples);
    for (std::size_t i = begin; i < end; ++i) {
      const GammaSample& sample = samples[i - begin];
      answers[i] = {static_cast<double>(sample.gamma), (sample.gradient / supportRadius_).cast<double>(),
                    static_cast<double>(sample.distance)};
    }
  });
  return answers;
}

std::vector<Vec3d> WallQuery::normals(std::span<const Vec3d> points) {
  std::vector<Vec3d> normals(points.size());
  parallelFor(pool_, points.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3f normal;
      boundary_.distance((points[i] - origin_).cast<float>(), normal);
      normals[i] = normal.cast<double>();
    }
  });
  return normals;
}

}  // namespace migiwa
