// Where a shape from a file stands in a scene: scaled, then turned about the origin, then moved.
#pragma once

#include "core/base/fields.h"
#include "core/base/rotation.h"

namespace migiwa {

struct Transform {
  double scale = 1;
  Rotation rotate;
  Vec3d translate = Vec3d::Zero();  ///< (m)

  bool operator==(const Transform& other) const {
    return scale == other.scale && rotate.axis == other.rotate.axis &&
           rotate.degrees == other.rotate.degrees && translate == other.translate;
  }
  template <class Visitor>
  static void describe(Visitor& visitor, Visited<Visitor, Transform>& self) {
    visitor.number("scale", self.scale, Range::closed(1e-9, 1e6),
                   {"1", "Factor on all lengths of the file: metres per its unit."});
    visitor.object("rotate",
                   {"", "Turns it about the origin; a file whose z axis is up needs [1, 0, 0] and -90."},
                   [&](auto& fields) { Rotation::describe(fields, self.rotate); });
    visitor.vector("translate", self.translate, {"m", "Moves it, at last."});
  }
  Vec3f point(const Vec3f& p) const {
    return (rotate.matrix() * (scale * p.cast<double>()) + translate).cast<float>();
  }
  Vec3f direction(const Vec3f& n) const {
    return (rotate.matrix() * n.cast<double>()).normalized().cast<float>();
  }
};

}  // namespace migiwa
