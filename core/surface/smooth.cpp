// Smoothing: the lattice of the particles shows as a ripple on c, which passes of a Laplacian take away. What
// they and the kernel move of a smooth surface is put back.
#include <algorithm>
#include <cmath>

#include "core/surface/grid.h"

namespace migiwa::surface {

namespace {

/// Share of the way to the mean of its neighbours that a vertex goes in a pass.
constexpr float kShare = 0.5F;
/// Passes over the displacement, so that no ripple is put back.
constexpr int kDisplacementPasses = 6;
/// Vertices stay this near to their cell, in cells.
constexpr float kLeash = 0.25F;
/// Where more would have to be put back, in particle spacings, the surface is that of a droplet or a thread:
/// from there to twice as much the vertex goes back to the level of c.
constexpr float kMostBack = 0.3F;

/// Edges are taken as at least so long, squared, in cells.
constexpr float kLeastEdge = 0.1F;

/// The vertices that pull at each vertex: all around it on the free surface, those along the contact line on
/// it.
class Neighbours {
 public:
  Neighbours(const RawMesh& mesh, ThreadPool& pool) : start_(mesh.positions.size() + 1, 0) {
    const std::size_t n = mesh.positions.size();
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) ++start_[v + 1];
    for (std::size_t v = 0; v < n; ++v) start_[v + 1] += start_[v];
    corners_.resize(start_[n]);
    std::vector<std::uint32_t> filled(start_.begin(), start_.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) corners_[filled[mesh.triangles[t][k]]++] = 3 * t + k;
    pulls_.resize(corners_.size());
    counts_.resize(n);
    parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) counts_[v] = pullsOf(mesh, v);
    });
  }

  std::span<const std::uint32_t> of(std::size_t v) const { return {&pulls_[start_[v]], counts_[v]}; }

 private:
  std::uint32_t pullsOf(const RawMesh& mesh, std::size_t v) {
    const Hold hold = mesh.holds[v];
    if (hold == Hold::still) return 0;
    const std::span<const std::uint32_t> corners(&corners_[start_[v]], start_[v + 1] - start_[v]);
    std::uint32_t* const out = &pulls_[start_[v]];
    std::uint32_t count = 0;
    for (const std::uint32_t corner : corners) {
      const std::uint32_t next = mesh.triangles[corner / 3][(corner % 3 + 1) % 3];
      if (hold == Hold::wall || hold == Hold::edge) {
        // An edge of the contact line has a free and a wet triangle.
        const auto other = std::find_if(corners.begin(), corners.end(), [&](std::uint32_t c) {
          return mesh.triangles[c / 3][(c % 3 + 2) % 3] == next;
        });
        if (other == corners.end() || mesh.wet[*other / 3] == mesh.wet[corner / 3]) continue;
      }
      out[count++] = next;
    }
    const bool line = hold == Hold::wall;
    return line && count != 2 ? 0 : count;
  }

  std::vector<std::uint32_t> start_, corners_, pulls_, counts_;
};

Vec3f meanOf(std::span<const std::uint32_t> neighbours, const std::vector<Vec3f>& values) {
  Vec3f sum = Vec3f::Zero();
  for (const std::uint32_t n : neighbours) sum += values[n];
  return sum / static_cast<float>(neighbours.size());
}

class Smoother {
 public:
  Smoother(RawMesh& mesh, const Grid& grid, ThreadPool& pool)
      : mesh_(mesh), grid_(grid), pool_(pool), neighbours_(mesh, pool), next_(mesh.positions.size()) {}

  void run(double kernelVariance, int passes) {
    const std::vector<Vec3f> start = mesh_.positions;
    for (int pass = 0; pass < passes; ++pass) {
      forAll([&](std::size_t v) {
        const auto around = neighbours_.of(v);
        const Vec3f& p = mesh_.positions[v];
        next_[v] = around.empty() ? p : held(v, p, p + kShare * (meanOf(around, mesh_.positions) - p));
      });
      mesh_.positions.swap(next_);
    }
    if (passes > 0) putBack(start, static_cast<float>(kernelVariance));
    stayInLiquid();
    untangle(mesh_, start, grid_, pool_);
  }

 private:
  template <class Body>
  void forAll(const Body& body) {
    parallelFor(pool_, mesh_.positions.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) body(v);
    });
  }

  /// Where a vertex may go that wants to get from one place to another.
  Vec3f held(std::size_t v, const Vec3f& from, Vec3f to) const {
    if (mesh_.holds[v] == Hold::edge) to = from + mesh_.along[v].dot(to - from) * mesh_.along[v];
    const Vec3f low = mesh_.cells[v] - Vec3f::Constant(kLeash * grid_.cell()),
                high = mesh_.cells[v] + Vec3f::Constant((1 + kLeash) * grid_.cell());
    to = to.cwiseMax(low).cwiseMin(high);
    if (mesh_.holds[v] != Hold::none) grid_.ontoWall(to);
    return to;
  }

  /// What the passes have moved the surface as a whole goes back, and so does what the kernel has: one with
  /// the variance s^2 along each axis moves a smooth surface by s^2 / 2 times its Laplacian, which is 4 / e^2
  /// times the way to the mean of a vertex's neighbours, e^2 being the mean square of their distances.
  void putBack(const std::vector<Vec3f>& start, float kernelVariance) {
    std::vector<Vec3f> back(start.size());
    std::vector<float> lengths(start.size()), nextLengths(start.size());
    forAll([&](std::size_t v) {
      const auto around = neighbours_.of(v);
      const Vec3f& p = mesh_.positions[v];
      back[v] = start[v] - p;
      if (!around.empty()) {
        float squares = 0;
        for (const std::uint32_t n : around) squares += (mesh_.positions[n] - p).squaredNorm();
        squares /= static_cast<float>(around.size());
        back[v] -= 2 * kernelVariance / std::max(squares, kLeastEdge * grid_.cell() * grid_.cell()) *
                   (meanOf(around, mesh_.positions) - p);
      }
      lengths[v] = back[v].norm();
    });
    for (int pass = 0; pass < kDisplacementPasses; ++pass) {
      forAll([&](std::size_t v) {
        const auto around = neighbours_.of(v);
        float sum = 0;
        for (const std::uint32_t n : around) sum += lengths[n];
        next_[v] = around.empty() ? back[v] : Vec3f(0.5F * (back[v] + meanOf(around, back)));
        nextLengths[v] =
            around.empty() ? lengths[v] : 0.5F * (lengths[v] + sum / static_cast<float>(around.size()));
      });
      back.swap(next_);
      lengths.swap(nextLengths);
    }
    const float most = kMostBack * grid_.spacing();
    forAll([&](std::size_t v) {
      const Vec3f p = mesh_.positions[v];
      next_[v] = p;
      if (neighbours_.of(v).empty()) return;
      const float smooth = std::clamp(2 - lengths[v] / most, 0.0F, 1.0F);
      next_[v] = p + back[v];
      if (smooth < 1) {
        const Vec3f own = mesh_.holds[v] == Hold::none ? grid_.onLevel(start[v]) : start[v];
        next_[v] = own + smooth * (next_[v] - own);
      }
      next_[v] = held(v, p, next_[v]);
    });
    mesh_.positions.swap(next_);
  }

  void stayInLiquid() {
    if (grid_.boundary() == nullptr) return;
    const float margin = 0.01F * grid_.cell();
    forAll([&](std::size_t v) {
      if (mesh_.holds[v] != Hold::none) return;
      Vec3f& p = mesh_.positions[v];
      Vec3f normal;
      if (const float distance = grid_.boundary()->distance(p, normal); distance < margin)
        p += (margin - distance) * normal;
    });
  }

  RawMesh& mesh_;
  const Grid& grid_;
  ThreadPool& pool_;
  const Neighbours neighbours_;
  std::vector<Vec3f> next_;
};

}  // namespace

void smooth(RawMesh& mesh, const Grid& grid, double kernelVariance, int passes, ThreadPool& pool) {
  Smoother(mesh, grid, pool).run(kernelVariance, passes);
}

}  // namespace migiwa::surface
