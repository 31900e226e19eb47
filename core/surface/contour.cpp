// From labelled nodes to a closed mesh, by duality: a vertex in every cell for each sheet of the surface
// through it, a face around every edge of the grid that leaves the water ([Gib], with the sheets of [Nie]).
#include <algorithm>
#include <array>
#include <memory>

#include "core/surface/cell.h"

namespace migiwa::surface {

namespace {

/// Two parts of the surface pass through the face above a cell, and connect the same two sheets: each has a
/// vertex on the face, so that no edge of the mesh is there twice.
struct SplitFace {
  int cell, axis;
  std::uint32_t first;  ///< vertex of the part about the lower corner; the other follows
};

/// What the cells of a block hold.
struct Cells {
  std::array<std::uint8_t, Block::kNodes> config;
  std::array<std::uint32_t, Block::kNodes> first;  ///< vertex of a cell's first sheet
  std::vector<Vertex> vertices;
  std::vector<SplitFace> splits;
  std::uint32_t base = 0;  ///< number of the first vertex in the mesh
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> wet;
};

class Contour {
 public:
  Contour(const Grid& grid, ThreadPool& pool) : grid_(grid), pool_(pool), cells_(grid.blocks().size()) {}

  RawMesh run() {
    pool_.run(cells_.size(), [&](std::size_t k) { findVertices(k); });
    pool_.run(cells_.size(), [&](std::size_t k) {
      if (cells_[k]) splitFaces(k);
    });
    std::uint32_t vertices = 0;
    for (const auto& cells : cells_) {
      if (!cells) continue;
      cells->base = vertices;
      vertices += static_cast<std::uint32_t>(cells->vertices.size());
    }
    pool_.run(cells_.size(), [&](std::size_t k) {
      if (cells_[k]) addFaces(k);
    });
    return gathered(vertices);
  }

 private:
  const Block& block(std::size_t k) const { return grid_.blocks()[k]; }

  void findVertices(std::size_t k) {
    const Block& of = block(k);
    const bool water = std::find(of.label.begin(), of.label.end(), Label::water) != of.label.end();
    thread_local Nodes nodes;
    // The block beside it may have water where this one has none.
    if (!water && std::none_of(of.around.begin(), of.around.end(), [](std::int32_t n) { return n >= 0; }))
      return;
    nodes.load(grid_, of);
    const bool some = std::find(nodes.label.begin(), nodes.label.end(), Label::water) != nodes.label.end();
    const bool others =
        std::any_of(nodes.label.begin(), nodes.label.end(), [](Label l) { return l != Label::water; });
    if (!some || !others) return;
    cells_[k] = std::make_unique<Cells>();
    Cells& cells = *cells_[k];
    CellSolver solver(grid_, nodes);
    for (int z = 0; z < Block::kSide; ++z) {
      for (int y = 0; y < Block::kSide; ++y) {
        for (int x = 0; x < Block::kSide; ++x) {
          int config = 0;
          for (int corner = 0; corner < kCorners; ++corner)
            if (nodes.label[Nodes::index(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1))] ==
                Label::water)
              config |= 1 << corner;
          const auto cell = static_cast<std::size_t>(Block::index(x, y, z));
          cells.config[cell] = static_cast<std::uint8_t>(config);
          cells.first[cell] = static_cast<std::uint32_t>(cells.vertices.size());
          const int sheets = kSheets.count[static_cast<std::size_t>(config)];
          if (sheets == 0) continue;
          solver.enter(x, y, z);
          for (int sheet = 0; sheet < sheets; ++sheet) cells.vertices.push_back(solver.sheet(config, sheet));
        }
      }
    }
  }

  /// A cell by its place from the first cell of block k, at most one block away.
  struct Found {
    const Cells* cells;
    std::size_t cell;
    int config() const { return cells->config[cell]; }
    std::uint32_t vertex(int edge) const {
      return cells->base + cells->first[cell] +
             kSheets.of[static_cast<std::size_t>(config())][static_cast<std::size_t>(edge)];
    }
  };
  Found find(std::size_t k, Index3 at) const {
    int around = 13;
    constexpr std::array<int, 3> kStride{1, 3, 9};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (at[axis] < 0) at[axis] += Block::kSide, around -= kStride[axis];
      if (at[axis] >= Block::kSide) at[axis] -= Block::kSide, around += kStride[axis];
    }
    const std::int32_t owner =
        around == 13 ? static_cast<std::int32_t>(k) : block(k).around[static_cast<std::size_t>(around)];
    if (owner < 0) return {nullptr, 0};
    return {cells_[static_cast<std::size_t>(owner)].get(),
            static_cast<std::size_t>(Block::index(at[0], at[1], at[2]))};
  }

  static std::uint8_t sheetOf(int config, int edge) {
    return kSheets.of[static_cast<std::size_t>(config)][static_cast<std::size_t>(edge)];
  }
  /// Whether both parts of the surface through the face above `lower` join the same sheets.
  static bool joinsTwice(int lower, int upper, int axis) {
    const Face face = faceOf(axis, 1);
    if (!ambiguous(lower, face)) return false;
    const std::size_t first = inside(lower, face.corners[0]) ? 0 : 1;
    const int p = face.corners[first], q = face.corners[first + 2];
    const int across = (axis + 1) % 3, below = ~(1 << axis);
    return sheetOf(lower, edgeAt(across, p)) == sheetOf(lower, edgeAt(across, q)) &&
           sheetOf(upper, edgeAt(across, p & below)) == sheetOf(upper, edgeAt(across, q & below));
  }

  void splitFaces(std::size_t k) {
    Cells& cells = *cells_[k];
    thread_local Nodes nodes;
    bool loaded = false;
    for (int cell = 0; cell < Block::kNodes; ++cell) {
      const int config = cells.config[static_cast<std::size_t>(cell)];
      if (config == 0 || config == 255) continue;
      const Index3 at{cell % Block::kSide, cell / Block::kSide % Block::kSide,
                      cell / (Block::kSide * Block::kSide)};
      for (int axis = 0; axis < 3; ++axis) {
        const Face face = faceOf(axis, 1);
        if (!ambiguous(config, face)) continue;
        Index3 above = at;
        ++above[static_cast<std::size_t>(axis)];
        const Found upper = find(k, above);
        if (upper.cells == nullptr || !joinsTwice(config, upper.config(), axis)) continue;
        if (!loaded) nodes.load(grid_, block(k));
        loaded = true;
        CellSolver solver(grid_, nodes);
        solver.enter(at[0], at[1], at[2]);
        cells.splits.push_back({cell, axis, static_cast<std::uint32_t>(cells.vertices.size())});
        for (const int corner : face.corners)
          if (inside(config, corner))
            cells.vertices.push_back(solver.part(corner, (axis + 1) % 3, (axis + 2) % 3));
      }
    }
  }

  /// The vertex on the face above `lower` along the axis, of the part about `corner` of that cell, if there
  /// is one.
  static std::int64_t splitVertex(const Found& lower, int axis, int corner) {
    for (const SplitFace& split : lower.cells->splits) {
      if (split.cell != static_cast<int>(lower.cell) || split.axis != axis) continue;
      const Face face = faceOf(axis, 1);
      const bool second = corner == face.corners[2] || corner == face.corners[3];
      return lower.cells->base + split.first + (second ? 1 : 0);
    }
    return -1;
  }

  void addFaces(std::size_t k) {
    Cells& cells = *cells_[k];
    for (int cell = 0; cell < Block::kNodes; ++cell) {
      const int config = cells.config[static_cast<std::size_t>(cell)];
      if (config == 0 || config == 255) continue;
      for (int axis = 0; axis < 3; ++axis)
        if (inside(config, 0) != inside(config, 1 << axis)) addFace(k, cell, axis);
    }
  }

  void addFace(std::size_t k, int cell, int axis) {
    Cells& cells = *cells_[k];
    const Index3 at{cell % Block::kSide, cell / Block::kSide % Block::kSide,
                    cell / (Block::kSide * Block::kSide)};
    const auto b = static_cast<std::size_t>((axis + 1) % 3), c = static_cast<std::size_t>((axis + 2) % 3);
    const bool leaves = inside(cells.config[static_cast<std::size_t>(cell)], 0);  // the water, along the axis
    // The cells around the edge, counter-clockwise seen from where it leads.
    constexpr std::array<std::array<int, 2>, 4> kBack{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    std::array<Found, 4> around;
    for (std::size_t n = 0; n < 4; ++n) {
      Index3 place = at;
      place[b] -= kBack[n][0], place[c] -= kBack[n][1];
      around[n] = find(k, place);
    }
    std::array<std::int64_t, 8> ring;
    std::size_t count = 0, from = 0;
    bool split = false;
    for (std::size_t n = 0; n < 4; ++n) {
      const auto [backB, backC] = kBack[n];
      ring[count++] = around[n].vertex(axis * 4 + backB + 2 * backC);
      // The next cell is on the other side of a face across b or c; the lower of both has it above itself.
      const std::size_t next = (n + 1) % 4;
      const bool acrossB = n % 2 == 0;
      const std::size_t lower = acrossB ? (kBack[n][0] == 1 ? n : next) : (kBack[n][1] == 1 ? n : next);
      if (around[lower].cells->splits.empty()) continue;
      int corner = kBack[lower][0] << b | kBack[lower][1] << c;  // of the lower cell: the edge's first end
      if (!leaves) corner |= 1 << axis;
      const std::int64_t vertex = splitVertex(around[lower], static_cast<int>(acrossB ? b : c), corner);
      if (vertex < 0) continue;
      if (!split) from = count;
      split = true;
      ring[count++] = vertex;
    }
    const bool wet = otherLabel(k, at, axis, leaves) == Label::solid;
    if (!split) from = shorterDiagonal(around, ring) ? 1 : 0;
    for (std::size_t n = 1; n + 1 < count; ++n) {
      auto vertex = [&](std::size_t m) { return static_cast<std::uint32_t>(ring[(from + m) % count]); };
      if (leaves) {
        cells.triangles.push_back({vertex(0), vertex(n), vertex(n + 1)});
      } else {
        cells.triangles.push_back({vertex(0), vertex(n + 1), vertex(n)});
      }
      cells.wet.push_back(wet ? 1 : 0);
    }
  }

  Label otherLabel(std::size_t k, Index3 at, int axis, bool leaves) const {
    if (leaves) ++at[static_cast<std::size_t>(axis)];
    std::size_t owner = k;
    if (at[static_cast<std::size_t>(axis)] == Block::kSide) {
      constexpr std::array<std::size_t, 3> kAbove{14, 16, 22};
      at[static_cast<std::size_t>(axis)] = 0;
      const std::int32_t above = block(k).around[kAbove[static_cast<std::size_t>(axis)]];
      if (above < 0) return Label::air;
      owner = static_cast<std::size_t>(above);
    }
    return block(owner).label[static_cast<std::size_t>(Block::index(at[0], at[1], at[2]))];
  }

  /// Whether the second diagonal of a face is the shorter one.
  static bool shorterDiagonal(const std::array<Found, 4>& around, const std::array<std::int64_t, 8>& ring) {
    const auto position = [&](std::size_t n) {
      return around[n].cells->vertices[static_cast<std::size_t>(ring[n]) - around[n].cells->base].position;
    };
    return (position(1) - position(3)).squaredNorm() < (position(0) - position(2)).squaredNorm();
  }

  RawMesh gathered(std::uint32_t vertices) {
    RawMesh mesh;
    std::vector<std::size_t> firstTriangle(cells_.size() + 1, 0);
    for (std::size_t k = 0; k < cells_.size(); ++k)
      firstTriangle[k + 1] = firstTriangle[k] + (cells_[k] ? cells_[k]->triangles.size() : 0);
    mesh.positions.resize(vertices), mesh.cells.resize(vertices), mesh.along.resize(vertices),
        mesh.holds.resize(vertices);
    mesh.triangles.resize(firstTriangle.back()), mesh.wet.resize(firstTriangle.back());
    pool_.run(cells_.size(), [&](std::size_t k) {
      if (!cells_[k]) return;
      const Cells& cells = *cells_[k];
      std::size_t v = cells.base;
      for (const Vertex& vertex : cells.vertices) {
        mesh.positions[v] = vertex.position, mesh.cells[v] = vertex.cell;
        mesh.along[v] = vertex.along, mesh.holds[v] = vertex.hold;
        ++v;
      }
      std::copy(cells.triangles.begin(), cells.triangles.end(), &mesh.triangles[firstTriangle[k]]);
      std::copy(cells.wet.begin(), cells.wet.end(), &mesh.wet[firstTriangle[k]]);
    });
    return mesh;
  }

  const Grid& grid_;
  ThreadPool& pool_;
  std::vector<std::unique_ptr<Cells>> cells_;
};

}  // namespace

RawMesh contour(const Grid& grid, ThreadPool& pool) {
  return Contour(grid, pool).run();
}

}  // namespace migiwa::surface
