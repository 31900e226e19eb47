// Rays against triangles, by Embree: version 3 or 4, whichever the system has. Nothing else of the program
// sees that library; without it everything builds, and only what needs a TriangleRays says so.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "core/slim/points.h"

namespace migiwa {

/// Whether this program was built with Embree.
bool raysAvailable();
/// What to do where it was not.
const char* raysMissingAdvice();

class TriangleRays {
 public:
  struct Hit {
    float distance = std::numeric_limits<float>::infinity();  ///< along the ray (m)
    std::uint32_t triangle = 0;
    float u = 0, v = 0;             ///< barycentric, of the second and the third corner
    Vec3f normal = Vec3f::UnitY();  ///< unit, of the triangle's front
  };

  /// None: no ray hits.
  TriangleRays() = default;
  /// Throws MissingError in a program that was built without Embree, where there are triangles.
  explicit TriangleRays(const TriangleMesh& mesh);

  bool empty() const { return scene_ == nullptr; }
  /// The nearest triangle at a distance in [from, to] (m); `direction` has unit length. A ray that meets an
  /// edge between two triangles meets one of them.
  bool first(const Vec3f& origin, const Vec3f& direction, float from, float to, Hit& hit) const;
  bool any(const Vec3f& origin, const Vec3f& direction, float from, float to) const;

 private:
  std::shared_ptr<void> scene_;  ///< Embree's
};

}  // namespace migiwa
