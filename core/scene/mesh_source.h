// The inside of a closed mesh, full of fluid.
#pragma once

#include "core/scene/fluid_source.h"
#include "core/slim/transform.h"
#include "core/slim/triangle_mesh.h"

namespace migiwa {

/// The lattice has round(length / spacing) cells along each axis of the mesh's bounds, centred on them; the
/// cells whose centres lie in the mesh are filled.
class MeshSource final : public FluidSource {
 public:
  MeshSource() = default;
  explicit MeshSource(TriangleMesh mesh);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override { return mesh_.bounds(); }

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, MeshSource>& self);
  void measure();

  FileName file_;
  Transform transform_;
  TriangleMesh mesh_;
  double volume_ = 0, area_ = 0;  ///< (m^3, m^2)
};

}  // namespace migiwa
