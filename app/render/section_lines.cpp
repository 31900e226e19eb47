#include "app/render/section_lines.h"

namespace migiwa {

std::vector<LineSegment> sectionLines(std::span<const WallMesh> meshes, Eigen::Index axis, float at) {
  std::vector<LineSegment> lines;
  for (const WallMesh& mesh : meshes) {
    for (const auto& corners : mesh.surface.triangles) {
      std::array<Vec3f, 2> ends;
      std::size_t found = 0;
      for (std::size_t k = 0; k < 3 && found < 2; ++k) {
        const Vec3f& from = mesh.surface.vertices[corners[k]];
        const Vec3f& to = mesh.surface.vertices[corners[(k + 1) % 3]];
        if ((from[axis] < at) == (to[axis] < at)) continue;
        Vec3f p = from + (at - from[axis]) / (to[axis] - from[axis]) * (to - from);
        p[axis] = at;
        ends[found++] = p;
      }
      if (found == 2) lines.push_back({ends[0], ends[1]});
    }
  }
  return lines;
}

}  // namespace migiwa
