// The grid that the surface is found on, and the steps from particles to a mesh; for core/surface alone.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/sph/neighbours.h"
#include "core/surface/liquid_surface.h"

namespace migiwa::surface {

enum class Label : std::uint8_t { air, water, solid };

using Index3 = std::array<int, 3>;

/// The particles in the order of a cell grid. The last lane of a position is what the particle adds to the
/// sum per value of the kernel of support 1: its volume over the support radius cubed.
struct SortedParticles {
  CellGrid cells;
  std::vector<Float4> positions, velocities;
  float supportRadius = 0;
  KernelType kernel = KernelType::poly6;
};

/// What all nodes of a block sum to: node (i, j, k) is at `first` + step * (i, j, k), in support radii.
struct BlockFrame {
  Vec3d first;  ///< (m)
  double step;  ///< (m)
};

/// A cube of nodes. A node is the lowest corner of its cell.
struct Block {
  static constexpr int kSide = 8, kNodes = kSide * kSide * kSide;
  static constexpr int index(int x, int y, int z) { return (z * kSide + y) * kSide + x; }

  Index3 at;                            ///< in blocks
  std::array<std::int32_t, 27> around;  ///< blocks beside it, x fastest; -1: none
  std::array<float, kNodes> value;      ///< c less the level of the surface
  std::array<float, kNodes> distance;   ///< to the walls (m); infinite where none is near
  std::array<Label, kNodes> label;
  bool walls = false;  ///< whether some node has a finite distance
};

/// Nodes at (i + 1/2) cells from the origin, in blocks where particles are. Walls at multiples of the cell so
/// lie midway between nodes.
class Grid {
 public:
  Grid(const SortedParticles& particles, const LiquidWalls& walls, double spacing, double cell,
       const std::string& place, ThreadPool& pool);

  /// c at any point of the fluid's side, less the level.
  float valueAt(const Vec3f& p) const;
  /// The point near p (m) where c is at the level, by c itself instead of between nodes: for drops of a few
  /// cells.
  Vec3f onLevel(Vec3f p) const;
  /// Moves p (m) onto the nearest wall, and returns the wall's normal there.
  Vec3f ontoWall(Vec3f& p) const;
  Vec3d place(const Block& block, int x, int y, int z) const;

  std::span<const Block> blocks() const { return blocks_; }
  float cell() const { return static_cast<float>(cell_); }
  float spacing() const { return static_cast<float>(spacing_); }
  const Boundary* boundary() const { return walls_.boundary; }
  const SortedParticles& particles() const { return particles_; }

 private:
  void findBlocks(const std::string& place, ThreadPool& pool);
  void sum(Block& block) const;
  void measure(Block& block) const;
  void correct(Block& block) const;
  std::int32_t find(const Index3& at) const;

  const SortedParticles& particles_;
  LiquidWalls walls_;
  double spacing_, cell_;
  std::vector<Block> blocks_;
};

/// The sum over the particles of weight * W at one point.
float kernelSum(const SortedParticles& particles, const Vec3f& p);
/// The same for all nodes of a block.
void addKernelSums(const SortedParticles& particles, std::span<const CellGrid::Places> rows,
                   const BlockFrame& frame, std::span<float, Block::kNodes> sums);

/// What holds a vertex.
enum class Hold : std::uint8_t {
  none,   ///< on the free surface
  wall,   ///< on the contact line: it stays on its wall
  edge,   ///< on the contact line where two walls meet: it moves along their edge
  still,  ///< on walls alone, or where three of them meet
};

/// The mesh before it is smoothed.
struct RawMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> cells;  ///< lowest corner of each vertex's cell (m)
  std::vector<Hold> holds;
  std::vector<Vec3f> along;  ///< unit, of Hold::edge
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> wet;
};

RawMesh contour(const Grid& grid, ThreadPool& pool);

/// Moves vertices of triangles that pass through each other back to where the contour had them, and on to the
/// middle of their cells, until none do.
void untangle(RawMesh& mesh, const std::vector<Vec3f>& found, const Grid& grid, ThreadPool& pool);

/// Moves the vertices; see docs/surface.md.
void smooth(RawMesh& mesh, const Grid& grid, double kernelVariance, int passes, ThreadPool& pool);

}  // namespace migiwa::surface
