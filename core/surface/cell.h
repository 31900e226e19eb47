// A cell of the grid: its corners, edges and faces, the sheets of the surface through it, and the vertex of
// each.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/surface/grid.h"

namespace migiwa::surface {

// A corner of a cell is a number with a bit for each axis; an edge is its axis and the bits of the two
// others.

inline constexpr int kCorners = 8, kEdges = 12;
inline constexpr std::uint8_t kNoSheet = 255;

constexpr int edgeAt(int axis, int corner) {
  return axis * 4 + (corner >> (axis + 1) % 3 & 1) + 2 * (corner >> (axis + 2) % 3 & 1);
}
constexpr int lowerEnd(int edge) {
  const int axis = edge / 4;
  return (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
}
constexpr bool inside(int config, int corner) {
  return (config >> corner & 1) != 0;
}

/// A cell's face: the four corners in a circle.
struct Face {
  std::array<int, 4> corners;
};
constexpr Face faceOf(int axis, int side) {
  const int a = 1 << (axis + 1) % 3, b = 1 << (axis + 2) % 3, from = side << axis;
  return {{from, from | a, from | a | b, from | b}};
}
/// Both diagonals of the face have their own side of the surface: two parts of it pass through the face.
constexpr bool ambiguous(int config, const Face& face) {
  const auto& [p, q, r, s] = face.corners;
  return inside(config, p) == inside(config, r) && inside(config, q) == inside(config, s) &&
         inside(config, p) != inside(config, q);
}

/// Which sheet of the surface crosses each edge, for all sides that the corners can be on. Where a face
/// leaves a choice, the corners in the water are apart.
struct Sheets {
  std::array<std::array<std::uint8_t, kEdges>, 256> of;
  std::array<std::uint8_t, 256> count;
};

extern const Sheets kSheets;

/// A vertex that is not in the mesh yet.
struct Vertex {
  Vec3f position;
  Vec3f cell;
  Vec3f along = Vec3f::Zero();
  Hold hold = Hold::none;
};

/// The nodes of a block and the first ones of those above it.
class Nodes {
 public:
  static constexpr int kSide = Block::kSide + 1, kCount = kSide * kSide * kSide;
  static constexpr std::size_t index(int x, int y, int z) {
    const int node = (z * kSide + y) * kSide + x;
    return static_cast<std::size_t>(node);
  }

  void load(const Grid& grid, const Block& block);
  Vec3f place(int x, int y, int z) const { return grid_->place(*block_, x, y, z).cast<float>(); }
  /// The wall's normal at a node that has a distance.
  const Vec3f& normal(int x, int y, int z);
  /// c as it goes on behind the wall: there it is that of the wall's nearest point.
  float extended(int x, int y, int z);

  std::array<Label, kCount> label;
  std::array<float, kCount> value, distance;

 private:
  const Grid* grid_ = nullptr;
  const Block* block_ = nullptr;
  std::array<Vec3f, kCount> normal_;
  std::array<std::uint8_t, kCount> known_;  ///< bits: the normal, the value behind the wall
};

/// Finds the vertex of each sheet. Places are in cells from the cell's lowest corner.
class CellSolver {
 public:
  CellSolver(const Grid& grid, Nodes& nodes) : grid_(grid), nodes_(nodes) {}

  /// Turns to a cell of the nodes' block.
  void enter(int x, int y, int z);
  /// The vertex of a sheet of the cell.
  Vertex sheet(int config, int which);
  /// The vertex of the part of the surface on a face that cuts off a corner in the water: between the edges
  /// from there along two axes.
  Vertex part(int corner, int across, int up);

 private:
  struct Crossing {
    Vec3f place;
    int water, other;  ///< corners
    bool wet;
  };
  /// A wall's tangent plane: normal * p = offset.
  struct Plane {
    Vec3f normal;
    float offset;
  };
  /// What crosses the edges of a sheet.
  struct Crossings {
    Vec3f sum = Vec3f::Zero();
    int free = 0, wet = 0;
  };

  std::size_t nodeOf(int corner) const {
    return Nodes::index(x_ + (corner & 1), y_ + (corner >> 1 & 1), z_ + (corner >> 2 & 1));
  }
  Label labelOf(int corner) const { return nodes_.label[nodeOf(corner)]; }
  Crossing cross(int config, int edge) const;
  void take(const Crossing& crossing, Crossings& crossings);
  void addPlane(int corner);
  Vertex solve(const Crossings& crossings);
  void solveAtWalls(Vec3f& p, bool contact, Vertex& vertex);
  int toWalls(Vec3f& p, Vec3f& along);
  Vec3f ontoWall(Vec3f& p) const;
  float sample(const Vec3f& p, Vec3f& gradient);
  void toLevel(Vec3f& p);
  void toLevelAlongWall(Vec3f& p, const Vec3f& normal);
  void toLevelAlong(Vec3f& p, const Vec3f& along);

  const Grid& grid_;
  Nodes& nodes_;
  std::vector<Plane> planes_;
  int x_ = 0, y_ = 0, z_ = 0;
  Vec3f low_ = Vec3f::Zero();
  bool mixed_ = false;  ///< air and solid both
};

}  // namespace migiwa::surface
