// A region that is filled with fluid at the start. A source is one file that implements this interface and
// one line in fluid_source_registry.cpp.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/fields.h"

namespace migiwa {

class FluidSource {
 public:
  virtual ~FluidSource() = default;

  /// Visits the shape's own fields of the scene file's object, then checks and prepares what follows from
  /// them.
  virtual void describe(FieldVisitor& visitor) = 0;
  /// Visits the same fields, and changes nothing.
  virtual void describe(FieldWriter& visitor) const = 0;
  /// How many particles fill() makes at most, without making them.
  virtual double count(double spacing) const = 0;
  /// Appends the centres of a cell-centred lattice of the given spacing (m) that lie in the region.
  virtual void fill(double spacing, std::vector<Vec3d>& out) const = 0;
  virtual Bounds bounds() const = 0;

  /// Fields that every source has.
  Vec3d velocity = Vec3d::Zero();  ///< initial velocity (unit: m/s)
  bool trim = true;  ///< leave out centres that are less than half a spacing inside the fluid side
};

/// Names for the scene's "shape" key, in the order of makeFluidSource's index.
std::span<const std::string_view> fluidShapes();
std::unique_ptr<FluidSource> makeFluidSource(int shape);

}  // namespace migiwa
