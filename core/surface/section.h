// A plane through the liquid with a field on it, as a raster: sums of kernels over the particles, divided so
// that they are right up to the walls.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/sph/kernels.h"
#include "core/surface/liquid_surface.h"

namespace migiwa {

/// A rectangle of a plane in square cells.
struct SectionPlane {
  Vec3d corner = Vec3d::Zero();                        ///< of the first cell (m)
  Vec3d across = Vec3d::UnitX(), up = Vec3d::UnitY();  ///< unit, at right angles
  double cell = 1;                                     ///< width of a cell (m)
  int columns = 0, rows = 0;

  /// Of the middle of a cell (m).
  Vec3d point(double column, double row) const {
    return corner + cell * ((column + 0.5) * across + (row + 0.5) * up);
  }
  Vec3d normal() const;
  std::size_t cells() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  bool operator==(const SectionPlane&) const = default;
};

/// The smallest rectangle about what the plane normal . x = offset (m; `normal` of any length but zero, the
/// offset along the unit normal) has in common with the bounds, with so many cells along its longer side:
/// upright where `up` is not along the normal, and seen with the axis that it has most of to the right.
/// Nothing where the plane misses them.
std::optional<SectionPlane> sectionPlane(const Vec3d& normal, double offset, const Bounds& bounds,
                                         const Vec3d& up, int cells);

/// What the sum over the particles is divided by.
enum class SectionDivisor {
  sum,    ///< by that of the weights alone, so that a constant stays what it is
  gamma,  ///< by gamma, [FM] Eq. 5
  none,   ///< not at all: short of what walls take
};
inline constexpr std::array<std::string_view, 3> kSectionDivisorNames{"sum", "gamma", "none"};

struct SectionFluid {
  std::span<const Float4> positions;  ///< (m)
  std::span<const float> values;      ///< of each particle, in the field's unit
  float weight = 0;                   ///< volume of a particle over the support radius cubed
  float supportRadius = 0;            ///< (m)
  KernelType kernel = KernelType::poly6;
};

struct SectionRaster {
  SectionPlane plane;
  std::vector<float> values;  ///< row by row from the corner; NaN where there is no liquid

  float value(int column, int row) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(plane.columns) +
                  static_cast<std::size_t>(column)];
  }
  /// How much the field changes from a cell of the liquid to the next, in the direction in which it changes
  /// most.
  double steepness(int column, int row) const;
  /// Nothing outside the raster or the liquid.
  std::optional<float> at(const Vec3d& p) const;
  /// Of what is not NaN; nothing where all is.
  std::optional<std::array<float, 2>> range() const;
};

/// A field that changes by less than a step between lines of equal values over so many cells has no line
/// there: it would show rounding.
inline constexpr double kFlattestLines = 400;

/// The field A with the values A_j: sum_j V A_j W(x - x_j) over the divisor. Liquid is where sum_j V W is at
/// least half of gamma, on the fluid's side of the walls: as where liquidSurface() has its surface. Through
/// thin walls it sees both sides. The same for any number of threads.
SectionRaster section(const SectionPlane& plane, const SectionFluid& fluid, const LiquidWalls& walls,
                      SectionDivisor divisor, ThreadPool& pool);
/// Gamma itself, where there is liquid.
SectionRaster gammaSection(const SectionPlane& plane, const SectionFluid& fluid, const LiquidWalls& walls,
                           ThreadPool& pool);

/// The cells of the liquid as a table x,y,z,`name`, with what positions are relative to (m) added.
std::string sectionCsv(const SectionRaster& raster, const Vec3d& origin, std::string_view name);

namespace surface {

/// A particle near the plane: its place in cells, the squared distance from the plane in squared support
/// radii, and its value.
struct NearPlane {
  float column, row, squared, value;
};
/// Adds V W and V A W to rows [from, to) of two rasters whose rows are `stride` apart, which leaves room for
/// kSectionExtra cells beyond the last column.
inline constexpr std::size_t kSectionExtra = 16;
struct SectionRows {
  int from, to, columns;
  std::size_t stride;
  float *weights, *values;  ///< of the row `from`
};
/// `reach`: the support radius in cells.
void addToRows(std::span<const NearPlane> particles, float weight, float reach, KernelType kernel,
               const SectionRows& rows);

}  // namespace surface
}  // namespace migiwa
