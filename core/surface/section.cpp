#include "core/surface/section.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "core/gamma/gamma_method.h"
#include "core/walls/boundary.h"

namespace migiwa {
namespace {

using surface::kSectionExtra;
using surface::NearPlane;

constexpr float kNoLiquid = std::numeric_limits<float>::quiet_NaN();
/// Of the sum of the weights over gamma at the surface of the liquid.
constexpr float kLiquidLevel = 0.5F;
/// Rows that one thread works on, and the sides of squares of cells that may all be far from the walls.
constexpr int kBandRows = 16;

/// What of the plane is within the bounds, as the corners of a polygon: where it cuts their edges.
std::vector<Vec3d> cutCorners(const Vec3d& normal, double offset, const Bounds& bounds) {
  std::vector<Vec3d> corners;
  const auto corner = [&](int k) {
    return Vec3d((k & 1) != 0 ? bounds.max.x() : bounds.min.x(),
                 (k & 2) != 0 ? bounds.max.y() : bounds.min.y(),
                 (k & 4) != 0 ? bounds.max.z() : bounds.min.z());
  };
  for (int k = 0; k < 8; ++k) {
    for (const int bit : {1, 2, 4}) {
      if ((k & bit) != 0) continue;
      const Vec3d from = corner(k), to = corner(k | bit);
      const double a = normal.dot(from) - offset, b = normal.dot(to) - offset;
      if (a == 0) corners.push_back(from);
      if (b == 0) corners.push_back(to);
      if ((a < 0) != (b < 0) && a != b) corners.emplace_back(from + a / (a - b) * (to - from));
    }
  }
  return corners;
}

/// Particles that reach the plane, in their order.
std::vector<NearPlane> nearPlane(const SectionPlane& plane, const SectionFluid& fluid, ThreadPool& pool) {
  const Vec3d normal = plane.normal();
  const auto support = static_cast<double>(fluid.supportRadius);
  const double reach = support / plane.cell;
  std::vector<std::vector<NearPlane>> parts(chunkCount(fluid.positions.size()));
  parallelFor(pool, fluid.positions.size(), [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d offset = fluid.positions[i].xyz().cast<double>() - plane.corner;
      const double height = offset.dot(normal) / support;
      const double column = offset.dot(plane.across) / plane.cell - 0.5,
                   row = offset.dot(plane.up) / plane.cell - 0.5;
      const bool reaches = std::abs(height) < 1 && column > -reach && column < plane.columns - 1 + reach &&
                           row > -reach && row < plane.rows - 1 + reach;
      if (!reaches) continue;  // nor what is not finite
      parts[chunk].push_back({static_cast<float>(column), static_cast<float>(row),
                              static_cast<float>(height * height), fluid.values[i]});
    }
  });
  std::vector<NearPlane> all;
  for (const std::vector<NearPlane>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

enum class Shown { overSum, overGamma, plain, gamma };

/// A band of rows of a section: sums, and where there is liquid.
class Band {
 public:
  Band(const SectionPlane& plane, const SectionFluid& fluid, const LiquidWalls& walls, int from)
      : plane_(plane),
        fluid_(fluid),
        walls_(walls),
        from_(from),
        to_(std::min(from + kBandRows, plane.rows)),
        stride_(static_cast<std::size_t>(plane.columns) + kSectionExtra),
        weights_(static_cast<std::size_t>(to_ - from_) * stride_),
        values_(weights_.size()) {}

  void add(std::span<const NearPlane> particles) {
    surface::addToRows(particles, fluid_.weight, fluid_.supportRadius / static_cast<float>(plane_.cell),
                       fluid_.kernel, {from_, to_, plane_.columns, stride_, weights_.data(), values_.data()});
  }

  /// `out`: the band's rows.
  void finish(Shown shown, float* out) {
    std::fill(out, out + static_cast<std::size_t>(to_ - from_) * columns(), kNoLiquid);
    for (int column = 0; column < plane_.columns; column += kBandRows)
      square(column, std::min(column + kBandRows, plane_.columns), shown, out);
    if (asked_.empty()) return;
    std::vector<GammaSample> samples(asked_.size());
    walls_.gamma->evaluate(points_, samples);
    for (std::size_t k = 0; k < asked_.size(); ++k) set(asked_[k], samples[k].gamma, shown, out);
  }

 private:
  struct Cell {
    int row, column;
  };
  std::size_t columns() const { return static_cast<std::size_t>(plane_.columns); }
  std::size_t sumAt(const Cell& cell) const {
    return static_cast<std::size_t>(cell.row - from_) * stride_ + static_cast<std::size_t>(cell.column);
  }

  /// Cells that are far from all walls are done; of the others those are asked for their gamma that need it.
  void square(int fromColumn, int toColumn, Shown shown, float* out) {
    bool near = walls_.boundary != nullptr && !walls_.boundary->empty();
    if (near && walls_.boundary->steady()) {
      const Vec3f middle =
          plane_.point(0.5 * (fromColumn + toColumn - 1), 0.5 * (from_ + to_ - 1)).cast<float>();
      const auto radius =
          static_cast<float>(0.5 * plane_.cell * portable::hypot(toColumn - fromColumn, to_ - from_));
      near =
          !(walls_.boundary->distance(middle) > walls_.boundary->steepness() * radius + fluid_.supportRadius);
    }
    for (int row = from_; row < to_; ++row) {
      for (int column = fromColumn; column < toColumn; ++column) {
        const Cell cell{row, column};
        const float weight = weights_[sumAt(cell)];
        if (!(weight > 0)) continue;
        if (!near) {
          set(cell, 1, shown, out);
          continue;
        }
        const Vec3f p = plane_.point(column, row).cast<float>();
        const float distance = walls_.boundary->distance(p);
        if (distance < 0) continue;
        // gamma is 1 at most: this is liquid whatever it is.
        const bool known = shown != Shown::overGamma && shown != Shown::gamma && weight >= kLiquidLevel;
        if (known || distance >= fluid_.supportRadius) {
          set(cell, 1, shown, out);
        } else {
          asked_.push_back(cell);
          points_.emplace_back(p);
        }
      }
    }
  }

  void set(const Cell& cell, float gamma, Shown shown, float* out) const {
    const float weight = weights_[sumAt(cell)], value = values_[sumAt(cell)];
    if (!(weight >= kLiquidLevel * gamma)) return;
    float& shownValue =
        out[static_cast<std::size_t>(cell.row - from_) * columns() + static_cast<std::size_t>(cell.column)];
    switch (shown) {
      case Shown::overSum:
        shownValue = value / weight;
        return;
      case Shown::overGamma:
        shownValue = value / gamma;
        return;
      case Shown::plain:
        shownValue = value;
        return;
      case Shown::gamma:
        shownValue = gamma;
    }
  }

  const SectionPlane& plane_;
  const SectionFluid& fluid_;
  const LiquidWalls& walls_;
  int from_, to_;
  std::size_t stride_;
  std::vector<float> weights_, values_;
  std::vector<Cell> asked_;
  std::vector<Float4> points_;
};

SectionRaster rasterOf(const SectionPlane& plane, const SectionFluid& fluid, const LiquidWalls& walls,
                       Shown shown, ThreadPool& pool) {
  SectionRaster raster{plane, std::vector<float>(plane.cells(), kNoLiquid)};
  if (plane.cells() == 0) return raster;
  const std::vector<NearPlane> near = nearPlane(plane, fluid, pool);
  const double reach = static_cast<double>(fluid.supportRadius) / plane.cell;
  const int bands = (plane.rows + kBandRows - 1) / kBandRows;
  std::vector<std::vector<NearPlane>> inBand(static_cast<std::size_t>(bands));
  for (const NearPlane& particle : near) {
    const auto row = static_cast<double>(particle.row);
    const int first = std::max(0, static_cast<int>(std::floor((row - reach) / kBandRows)));
    const int last = std::min(bands - 1, static_cast<int>(std::floor((row + reach) / kBandRows)));
    for (int band = first; band <= last; ++band) inBand[static_cast<std::size_t>(band)].push_back(particle);
  }
  pool.run(static_cast<std::size_t>(bands), [&](std::size_t k) {
    const int from = static_cast<int>(k) * kBandRows;
    Band band(plane, fluid, walls, from);
    band.add(inBand[k]);
    band.finish(shown, raster.values.data() +
                           static_cast<std::size_t>(from) * static_cast<std::size_t>(plane.columns));
  });
  return raster;
}

}  // namespace

Vec3d SectionPlane::normal() const {
  return across.cross(up);
}

std::optional<SectionPlane> sectionPlane(const Vec3d& normal, double offset, const Bounds& bounds,
                                         const Vec3d& up, int cells) {
  if (bounds.empty()) return std::nullopt;
  const Vec3d unit = normal.normalized();
  const std::vector<Vec3d> corners = cutCorners(unit, offset, bounds);
  SectionPlane plane;
  plane.up = up - up.dot(unit) * unit;
  if (plane.up.norm() < 1e-3 * up.norm()) {
    // Seen along the upright axis: another one is up, to the right of which is that before it.
    const Vec3d other = std::abs(unit.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d::UnitY();
    plane.up = other - other.dot(unit) * unit;
  }
  plane.up.normalize();
  plane.across = plane.up.cross(unit);
  Eigen::Index most = 0;
  plane.across.cwiseAbs().maxCoeff(&most);
  if (plane.across[most] < 0) plane.across = -plane.across;

  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const Vec3d& corner : corners) {
    const double along[2] = {corner.dot(plane.across), corner.dot(plane.up)};
    for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], along[k]), high[k] = std::max(high[k], along[k]);
  }
  const double width = high[0] - low[0], height = high[1] - low[1];
  if (corners.empty() || !(std::max(width, height) > 0)) return std::nullopt;
  plane.cell = std::max(width, height) / cells;
  plane.columns = std::max(1, static_cast<int>(std::ceil(width / plane.cell - 1e-6)));
  plane.rows = std::max(1, static_cast<int>(std::ceil(height / plane.cell - 1e-6)));
  plane.corner = offset * unit + low[0] * plane.across + low[1] * plane.up;
  return plane;
}

double SectionRaster::steepness(int column, int row) const {
  // Between the cells on either side; at a border of the liquid from the cell itself.
  const auto along = [here = value(column, row)](float before, float after) {
    const int ways = (std::isnan(before) ? 0 : 1) + (std::isnan(after) ? 0 : 1);
    const float low = std::isnan(before) ? here : before, high = std::isnan(after) ? here : after;
    const double slope = (static_cast<double>(high) - static_cast<double>(low)) / std::max(ways, 1);
    return std::isfinite(slope) ? slope : 0;
  };
  const auto near = [&](int c, int r) {
    const bool inside = c >= 0 && r >= 0 && c < plane.columns && r < plane.rows;
    return inside ? value(c, r) : std::numeric_limits<float>::quiet_NaN();
  };
  return portable::hypot(along(near(column - 1, row), near(column + 1, row)),
                         along(near(column, row - 1), near(column, row + 1)));
}

std::optional<float> SectionRaster::at(const Vec3d& p) const {
  const Vec3d offset = p - plane.corner;
  const double column = std::floor(offset.dot(plane.across) / plane.cell),
               row = std::floor(offset.dot(plane.up) / plane.cell);
  if (!(column >= 0 && row >= 0 && column < plane.columns && row < plane.rows)) return std::nullopt;
  const float there = value(static_cast<int>(column), static_cast<int>(row));
  if (std::isnan(there)) return std::nullopt;
  return there;
}

std::optional<std::array<float, 2>> SectionRaster::range() const {
  std::optional<std::array<float, 2>> range;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    if (!range) range = {value, value};
    (*range)[0] = std::min((*range)[0], value);
    (*range)[1] = std::max((*range)[1], value);
  }
  return range;
}

SectionRaster section(const SectionPlane& plane, const SectionFluid& fluid, const LiquidWalls& walls,
                      SectionDivisor divisor, ThreadPool& pool) {
  constexpr std::array kShown{Shown::overSum, Shown::overGamma, Shown::plain};
  return rasterOf(plane, fluid, walls, kShown[static_cast<std::size_t>(divisor)], pool);
}

SectionRaster gammaSection(const SectionPlane& plane, const SectionFluid& fluid, const LiquidWalls& walls,
                           ThreadPool& pool) {
  return rasterOf(plane, fluid, walls, Shown::gamma, pool);
}

std::string sectionCsv(const SectionRaster& raster, const Vec3d& origin, std::string_view name) {
  // More digits where a scene is far from zero.
  const int digits = origin.isZero(0) ? 7 : 15;
  std::string text = "x,y,z," + std::string(name) + "\n";
  std::size_t k = 0;
  for (int row = 0; row < raster.plane.rows; ++row) {
    for (int column = 0; column < raster.plane.columns; ++column, ++k) {
      if (std::isnan(raster.values[k])) continue;
      const Vec3d p = raster.plane.point(column, row) + origin;
      char line[128];
      std::snprintf(line, sizeof line, "%.*g,%.*g,%.*g,%.7g\n", digits, p.x(), digits, p.y(), digits, p.z(),
                    static_cast<double>(raster.values[k]));
      text += line;
    }
  }
  return text;
}

}  // namespace migiwa
