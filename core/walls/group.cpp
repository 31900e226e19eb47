#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/walls/mesh_wall.h"

namespace migiwa {

namespace {

/// What may be in a group: shapes that enclose something.
constexpr std::array<std::string_view, 3> kVessels{"box", "sphere", "mesh"};

std::unique_ptr<Surface> makeVessel(int vessel) {
  const std::span<const std::string_view> shapes = surfaceShapes();
  const auto shape = std::find(shapes.begin(), shapes.end(), kVessels.at(static_cast<std::size_t>(vessel)));
  return makeSurface(static_cast<int>(shape - shapes.begin()));
}

/// Whether the fluid is on the inside of a mesh that `vessel` encloses, from its triangle `face` on.
bool holdsFluid(const Surface& vessel, const TriangleMesh& mesh, std::size_t face) {
  // From the middle of a face a little inwards.
  const auto& [a, b, c] = mesh.triangles[face];
  const Vec3f &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  const Vec3f across = (q - p).cross(r - p);
  Vec3f ignored;
  return vessel.distance((p + q + r) / 3 - 1e-3F * across / std::sqrt(across.norm()), ignored) > 0;
}

}  // namespace

template <class Visitor>
void GroupSurface::fields(Visitor& visitor, Visited<Visitor, GroupSurface>& self) {
  const auto nothing = [](auto&, auto&) {};
  describeShapes<Surface>(visitor, "surfaces",
                          {"", "Vessels with the fluid inside, which overlap or touch.", Presence::required},
                          self.vessels_, {kVessels, makeVessel}, nothing, nothing);
}

void GroupSurface::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void GroupSurface::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (visitor.valid({"surfaces"})) unite(visitor);
}

void GroupSurface::unite(FieldVisitor& visitor) {
  const Activity activity("joining vessels");
  TriangleMesh all;
  for (std::size_t k = 0; k < vessels_.size(); ++k) {
    const std::size_t first = all.triangles.size();
    const std::string vessel = "surfaces/" + std::to_string(k);
    if (vessels_[k]->bounds().empty() || !vessels_[k]->enclosed(all)) {
      visitor.fault(vessel, "expected a closed vessel, found one that encloses nothing");
    } else if (!holdsFluid(*vessels_[k], all, first)) {
      visitor.fault(vessel,
                    "expected \"fluid\": \"inside\", for a group is a union of vessels, found \"outside\"");
    }
  }
  if (all.triangles.empty()) {
    visitor.fault("surfaces", "expected at least one vessel, found none");
    return;
  }
  try {
    shape_ = std::make_shared<const TriangleWall>(
        std::make_shared<const TriangleTree>(wallFaces(all, true, "surfaces")), true);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults()) visitor.fault("surfaces", fault.message);
  }
}

std::shared_ptr<const Surface> GroupSurface::forSupport(float supportRadius) const {
  return standFor(*shape_, motion, supportRadius);
}

}  // namespace migiwa
