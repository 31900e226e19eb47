// Water whose surface is not level at the start: standing and travelling waves.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/math.h"
#include "core/scene/sources.h"

namespace migiwa {

template <class Visitor>
void WaveSource::fields(Visitor& visitor, Visited<Visitor, WaveSource>& self) {
  visitor.place("min", self.min_,
                {"m", "Corner with the smallest coordinates, on the floor; y is up.", Presence::required});
  visitor.place("max", self.max_, {"m", "The opposite corner, at the still level.", Presence::required});
  visitor.choice("form", self.form_, kWaveFormNames,
                 {"", "Of the surface along x: cosine, or solitary, a single hump.", Presence::required});
  visitor.number("height", self.height_, Range::closed(-kLargestCoordinate, kLargestCoordinate),
                 {"m", "Of the crest over the still level.", Presence::required});
  visitor.number("wavelength", self.wavelength_, Range::length(kLargestCoordinate),
                 {"m", "From crest to crest of a cosine."});
  visitor.coordinate("crest", self.crest_, 0, {"m", "The x of a crest."});
  visitor.number("speed", self.speed_, kCoordinateRange,
                 {"m/s", "At which the wave travels along x; the water moves as that takes. 0: at rest."});
}

void WaveSource::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void WaveSource::describe(FieldVisitor& visitor) {
  crest_ = -visitor.origin().x();
  fields(visitor, *this);
  if (!visitor.valid({"min", "max"})) return;
  if ((max_.array() <= min_.array()).any()) {
    visitor.fault("max", "expected every coordinate to be larger than that of min, found one that is not");
    max_ = min_ + Vec3d::Ones();
  }
  if (!visitor.valid({"height", "form"})) return;
  if (std::abs(height_) >= max_.y() - min_.y())
    visitor.fault("height", "expected less than the depth of the still water, found more");
  if (form_ == WaveForm::solitary && height_ <= 0)
    visitor.fault("height", "expected more than 0 of a solitary wave, found less");
}

WaveSource::Surface WaveSource::surfaceAt(double x) const {
  const double from = x - crest_;
  if (form_ == WaveForm::cosine) {
    const double k = 2 * std::numbers::pi / wavelength_;
    return {height_ * portable::cos(k * from), -height_ * k * portable::sin(k * from)};
  }
  const double depth = max_.y() - min_.y();
  const double k = std::sqrt(0.75 * height_ / depth) / depth;
  const double decayed = portable::exp(-2 * k * std::abs(from));
  const double eta = height_ * 4 * decayed / ((1 + decayed) * (1 + decayed));
  const double tanh = std::copysign((1 - decayed) / (1 + decayed), from);
  return {eta, -2 * k * tanh * eta};
}

double WaveSource::count(double spacing) const {
  Vec3d size = max_ - min_;
  size.y() += std::abs(height_);
  return ((size.array() / spacing) - kCellTolerance).ceil().prod();
}

void WaveSource::fill(double spacing, std::vector<Vec3d>& out) const {
  const Vec3d size = max_ - min_;
  const auto cells = [&](double length) { return static_cast<std::int64_t>(wholeCells(length, spacing)); };
  const std::int64_t columns = cells(size.x()), rows = cells(size.y() + std::abs(height_)) + 1,
                     slices = cells(size.z());
  for (std::int64_t k = 0; k < slices; ++k)
    for (std::int64_t i = 0; i < columns; ++i) {
      const Vec3d foot = min_ + spacing * (Eigen::Array3d(double(i), 0, double(k)) + 0.5).matrix();
      const double top = max_.y() + surfaceAt(foot.x()).eta;
      for (std::int64_t j = 0; j < rows; ++j) {
        const Vec3d center = foot + Vec3d(0, spacing * double(j), 0);
        if (center.y() >= top) break;
        out.push_back(center);
      }
    }
}

Bounds WaveSource::bounds() const {
  Bounds bounds;
  bounds.include(min_);
  bounds.include(max_ + Vec3d(0, std::abs(height_), 0));
  return bounds;
}

Vec3d WaveSource::ownVelocity(const Vec3d& p) const {
  if (speed_ == 0) return Vec3d::Zero();
  const double depth = max_.y() - min_.y();
  const auto [eta, slope] = surfaceAt(p.x());
  const double whole = depth + eta;
  return {speed_ * eta / whole, -(p.y() - min_.y()) * speed_ * depth * slope / (whole * whole), 0};
}

double WaveSource::ownSpeed() const {
  const double depth = max_.y() - min_.y(), height = std::abs(height_);
  // In the trough of a cosine the water is shallowest; the slope is at most 2 k H.
  const double least = form_ == WaveForm::cosine ? depth - height : depth;
  const double k =
      form_ == WaveForm::cosine ? 2 * std::numbers::pi / wavelength_ : std::sqrt(3 * height / depth) / depth;
  return std::abs(speed_) * (height / least) * (1 + k * depth * (depth + height) / least);
}

}  // namespace migiwa
