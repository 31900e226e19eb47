// A wall from a mesh file: a SLIM surface fitted to it when the scene is read.
#pragma once

#include "core/boundary/slim_surface.h"

namespace migiwa {

class MeshSurface final : public SlimSurface {
 public:
  void describe(FieldVisitor& visitor) override;

 private:
  FileName file_;
};

}  // namespace migiwa
