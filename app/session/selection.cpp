#include "app/session/selection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace migiwa {
namespace {

std::uint32_t idOf(const FrameView& frame, std::size_t particle) {
  return frame.ids.empty() ? static_cast<std::uint32_t>(particle) : frame.ids[particle];
}

}  // namespace

std::string_view unitOf(ParticleValue field) {
  switch (field) {
    case ParticleValue::pressure:
      return "Pa";
    case ParticleValue::x:
    case ParticleValue::y:
    case ParticleValue::z:
      return "m";
    case ParticleValue::speed:
    case ParticleValue::vx:
    case ParticleValue::vy:
    case ParticleValue::vz:
      return "m/s";
    default:
      return "1";
  }
}

std::vector<std::size_t> selectedIn(const FrameView& frame, std::span<const std::uint32_t> ids) {
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < frame.positions.size(); ++k)
    if (ids.empty() || std::binary_search(ids.begin(), ids.end(), idOf(frame, k))) places.push_back(k);
  return places;
}

double fieldValue(const FrameView& frame, std::size_t particle, ParticleValue field, const Vec3d& origin) {
  const auto along = [&](ParticleValue first) {
    return static_cast<Eigen::Index>(field) - static_cast<Eigen::Index>(first);
  };
  const Vec3d position = frame.positions[particle].xyz().cast<double>(),
              velocity = frame.velocities[particle].xyz().cast<double>();
  switch (field) {
    case ParticleValue::density:
      return static_cast<double>(frame.density[particle]);
    case ParticleValue::pressure:
      return frame.pressure.empty() ? std::numeric_limits<double>::quiet_NaN()
                                    : static_cast<double>(frame.pressure[particle]);
    case ParticleValue::speed:
      return velocity.norm();
    case ParticleValue::gamma:
      return static_cast<double>(frame.gamma[particle]);
    case ParticleValue::x:
    case ParticleValue::y:
    case ParticleValue::z:
      return position[along(ParticleValue::x)] + origin[along(ParticleValue::x)];
    case ParticleValue::vx:
    case ParticleValue::vy:
    case ParticleValue::vz:
      return velocity[along(ParticleValue::vx)];
    case ParticleValue::lambda:
      return static_cast<double>(frame.lambda[particle]);
    default:
      return static_cast<double>(frame.neighbours[particle]);
  }
}

FieldSpread spreadOf(std::span<const double> values) {
  FieldSpread spread;
  double sum = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    spread.least = spread.count == 0 ? value : std::min(spread.least, value);
    spread.largest = spread.count == 0 ? value : std::max(spread.largest, value);
    sum += value;
    ++spread.count;
  }
  if (spread.count == 0) return spread;
  spread.mean = sum / static_cast<double>(spread.count);
  const double width = (spread.largest - spread.least) / FieldSpread::kBins;
  double squares = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    squares += (value - spread.mean) * (value - spread.mean);
    const double bin = width > 0 ? (value - spread.least) / width : 0;
    ++spread.bins[std::min(static_cast<std::size_t>(bin), FieldSpread::kBins - 1)];
  }
  spread.deviation = std::sqrt(squares / static_cast<double>(spread.count));
  return spread;
}

std::string particlesCsv(const FrameView& frame, std::span<const std::uint32_t> ids, const Vec3d& origin) {
  std::vector<ParticleValue> fields{ParticleValue::x,      ParticleValue::y,         ParticleValue::z,
                                    ParticleValue::vx,     ParticleValue::vy,        ParticleValue::vz,
                                    ParticleValue::speed,  ParticleValue::density,   ParticleValue::gamma,
                                    ParticleValue::lambda, ParticleValue::neighbours};
  if (!frame.pressure.empty()) fields.push_back(ParticleValue::pressure);
  std::string text = "id";
  for (const ParticleValue field : fields)
    text += "," + std::string(kParticleValueNames[static_cast<std::size_t>(field)]) + " (" +
            std::string(unitOf(field)) + ")";
  text += '\n';
  std::vector<std::size_t> places = selectedIn(frame, ids);
  std::sort(places.begin(), places.end(),
            [&](std::size_t a, std::size_t b) { return idOf(frame, a) < idOf(frame, b); });
  // What is no sum or square root is a float.
  const int digits = origin.isZero(0) ? 9 : 17;
  for (const std::size_t place : places) {
    text += std::to_string(idOf(frame, place));
    for (const ParticleValue field : fields) {
      char number[32];
      std::snprintf(number, sizeof number, ",%.*g", digits, fieldValue(frame, place, field, origin));
      text += number;
    }
    text += '\n';
  }
  return text;
}

}  // namespace migiwa
