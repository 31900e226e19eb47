#include "core/scene/gauge.h"

namespace migiwa {

namespace {

constexpr std::string_view kKindKey = "kind";
constexpr FieldDoc kKindDoc{
    "",
    "height: of the free surface over a place, as long as its line is wet; pressure: of the fluid about a "
    "point; centre: of mass, along a direction; front: the farthest fluid along a direction; speed: root "
    "mean square of all.",
    Presence::required};

}  // namespace

template <class Visitor>
void Gauge::fields(Visitor& visitor, Visited<Visitor, Gauge>& self) {
  const bool probe = self.kind == GaugeKind::height || self.kind == GaugeKind::pressure;
  if (probe) {
    visitor.place("at", self.at,
                  {"m", "Where it stands; of a height, the floor below it.", Presence::required});
  } else if (self.kind != GaugeKind::speed) {
    if constexpr (Visitor::kChanges) self.at = Vec3d::Zero() - visitor.origin();
    visitor.place("at", self.at, {"m", "What it counts from."});
  }
  if (self.kind == GaugeKind::height)
    visitor.vector("direction", self.direction, {"1", "Of the line; [0, 0, 0]: against gravity."});
  if (self.kind == GaugeKind::centre || self.kind == GaugeKind::front)
    visitor.vector("direction", self.direction,
                   {"1", "Along which it measures; any length but zero.", Presence::required});
  if (self.kind == GaugeKind::pressure)
    visitor.number("radius", self.radius, Range::closed(0, kLargestCoordinate),
                   {"m", "Of the ball whose particles count, the nearer the more; 0: the support radius."});
  if (probe)
    visitor.integer("wall", self.wall, Range::closed(-1, 1e6),
                    {"1", "Number of the surface, from 0, that it goes along with; -1: it stands still."});
  visitor.text("name", self.name, {"", "Of its series; left out: its kind and its number in the list."});
}

void Gauge::describe(FieldWriter& visitor) const {
  visitor.variant(kKindKey, static_cast<int>(kind), kGaugeKindNames, kKindDoc,
                  [this](FieldWriter& own, int) { fields(own, *this); });
}

void Gauge::describe(FieldVisitor& visitor, std::size_t number) {
  int picked = static_cast<int>(kind);
  visitor.variant(kKindKey, picked, kGaugeKindNames, kKindDoc, [&](FieldVisitor& own, int index) {
    kind = static_cast<GaugeKind>(index);
    fields(own, *this);
    const bool directed = kind == GaugeKind::centre || kind == GaugeKind::front;
    if (directed && own.valid({"direction"}) && direction.norm() < 1e-12)
      own.fault("direction", "expected a vector that is not zero, found [0, 0, 0]");
    if (name.find_first_of(",\"\n\r") != std::string::npos)
      own.fault("name",
                "expected a name without commas, quotes and line ends, which files of series cannot "
                "hold, found one with them");
    if (name.empty())
      name = std::string(kGaugeKindNames[static_cast<std::size_t>(index)]) + "_" + std::to_string(number);
  });
}

std::string_view Gauge::unit() const {
  switch (kind) {
    case GaugeKind::pressure:
      return "Pa";
    case GaugeKind::speed:
      return "m/s";
    case GaugeKind::height:
    case GaugeKind::centre:
    case GaugeKind::front:
      break;
  }
  return "m";
}

}  // namespace migiwa
