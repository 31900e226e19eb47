// A wall from a mesh file: a SLIM surface fitted to it when the scene is read.
#pragma once

#include "core/boundary/slim_surface.h"

namespace migiwa {

class MeshSurface final : public SlimSurface {
 public:
  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, MeshSurface>& self);
  FileName file_;
};

}  // namespace migiwa
