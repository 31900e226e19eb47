// What is measured at a place, or of all of the fluid, over the time of a run.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/base/fields.h"
#include "core/base/math.h"

namespace migiwa {

enum class GaugeKind { height, pressure, centre, front, speed };
inline constexpr std::array<std::string_view, 5> kGaugeKindNames{"height", "pressure", "centre", "front",
                                                                 "speed"};

struct Gauge {
  GaugeKind kind = GaugeKind::height;
  std::string name;                 ///< of its series; empty: by its kind and its place in the list
  Vec3d at = Vec3d::Zero();         ///< where it stands, or what it counts from (unit: m)
  Vec3d direction = Vec3d::Zero();  ///< of its line; zero: against gravity
  double radius = 0;                ///< of a pressure probe (unit: m); zero: the support radius
  int wall = -1;                    ///< it goes along with this wall; negative: it stands still

  /// Visits the fields of the scene file's object, which is entry `number` of the list.
  void describe(FieldVisitor& visitor, std::size_t number);
  void describe(FieldWriter& visitor) const;

  /// Unit of what it measures.
  std::string_view unit() const;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Gauge>& self);
};

}  // namespace migiwa
