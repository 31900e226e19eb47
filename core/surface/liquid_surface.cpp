#include "core/surface/liquid_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/math.h"
#include "core/surface/grid.h"

namespace migiwa {

namespace {

using surface::Grid;
using surface::Hold;
using surface::RawMesh;
using surface::SortedParticles;

/// What the particles of a drop sum to is less than within the liquid, and of one alone it stays below the
/// level of the surface everywhere. So they count for more: by the power of the missing part for which a
/// particle alone gets its own volume, and a layer of particles what it has.
class DropWeight {
 public:
  DropWeight(KernelType kernel, double supportRatio) {
    const double mass = static_cast<double>(restingLattice(kernel, supportRatio).massRatio);
    withKernel(kernel, [&](auto type) {
      using Kernel = decltype(type);
      const auto at = [](double q) { return static_cast<double>(Kernel::value(static_cast<float>(q))); };
      const double radius = portable::cbrt(3 / (4 * std::numbers::pi)) / supportRatio;
      double layer = at(0);
      const int reach = static_cast<int>(std::ceil(supportRatio));
      for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i)
          if (i != 0 || j != 0) layer += at(std::sqrt(static_cast<double>(i * i + j * j)) / supportRatio);
      layer_ = mass * layer;
      const double alone = mass * at(0), wanted = 0.5 / (mass * at(radius));
      if (wanted > 1 && layer_ > alone) power_ = portable::log(wanted) / portable::log(layer_ / alone);
    });
  }
  bool applies(float sum) const { return static_cast<double>(sum) < layer_ && power_ > 0; }
  float factor(float sum) const {
    return applies(sum)
               ? static_cast<float>(portable::exp(power_ * portable::log(layer_ / static_cast<double>(sum))))
               : 1;
  }

 private:
  double layer_ = 0, power_ = 0;
};

/// Of the kernel of support 1, along one axis.
double varianceOf(KernelType kernel) {
  return withKernel(kernel, [](auto type) {
    constexpr int kSteps = 1000;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double q = (k + 0.5) / kSteps;
      sum += static_cast<double>(decltype(type)::value(static_cast<float>(q))) * q * q * q * q;
    }
    return 4 * std::numbers::pi / 3 * sum / kSteps;
  });
}

/// Along cells, and by their coordinates within each: the sums are then the same in whatever order particles
/// come.
std::vector<std::uint32_t> orderOf(const CellGrid& cells, std::span<const Float4> positions) {
  std::vector<std::uint32_t> order = cells.order();
  const auto key = [&](std::uint32_t i) {
    return std::array{positions[i].x, positions[i].y, positions[i].z};
  };
  for (std::size_t from = 0; from < order.size();) {
    const CellGrid::Places cell = cells.places(cells.cellOf(positions[order[from]]));
    std::sort(&order[from], &order[from] + (cell.to - cell.from),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    from = cell.to;
  }
  return order;
}

SortedParticles sorted(const LiquidParticles& particles, const LiquidWalls& walls, ThreadPool& pool) {
  SortedParticles result;
  result.supportRadius = particles.supportRadius, result.kernel = particles.kernel;
  result.cells.build(particles.positions, particles.supportRadius, pool);
  const std::vector<std::uint32_t> order = orderOf(result.cells, particles.positions);
  const double ratio = static_cast<double>(particles.supportRadius) / static_cast<double>(particles.spacing);
  const float weight = restingLattice(particles.kernel, ratio).massRatio;
  result.positions.resize(order.size());
  if (!particles.velocities.empty()) result.velocities.resize(order.size());
  parallelFor(pool, order.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) {
      result.positions[k] = particles.positions[order[k]];
      result.positions[k].w = weight;
      if (!particles.velocities.empty()) result.velocities[k] = particles.velocities[order[k]];
    }
  });

  const DropWeight drops(particles.kernel, ratio);
  std::vector<float> weights(order.size(), weight);
  parallelFor(pool, order.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) {
      const Float4& p = result.positions[k];
      float sum = surface::kernelSum(result, p.xyz());
      if (!drops.applies(sum)) continue;
      if (walls.gamma != nullptr) {
        const std::array<Float4, 1> point{Float4(p.xyz())};
        std::array<GammaSample, 1> sample;
        walls.gamma->evaluate(point, sample);
        sum /= std::max(sample[0].gamma, 0.02F);
      }
      weights[k] = weight * drops.factor(sum);
    }
  });
  for (std::size_t k = 0; k < weights.size(); ++k) result.positions[k].w = weights[k];
  return result;
}

std::vector<Vec3f> normalsOf(const RawMesh& mesh) {
  // Weighted by the triangles' areas; where free and wet triangles meet the free ones alone count.
  std::vector<Vec3f> normals(mesh.positions.size(), Vec3f::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3f area = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t v : mesh.triangles[t])
      if (mesh.wet[t] == 0 || mesh.holds[v] == Hold::still) normals[v] += area;
  }
  for (Vec3f& normal : normals) {
    const float size = normal.norm();
    normal = size > 0 ? Vec3f(normal / size) : Vec3f(Vec3f::UnitY());
  }
  return normals;
}

/// The particles' velocities about each vertex, weighted by the kernel.
std::vector<Vec3f> velocitiesOf(const std::vector<Vec3f>& positions, const SortedParticles& particles,
                                ThreadPool& pool) {
  std::vector<Vec3f> velocities(positions.size(), Vec3f::Zero());
  if (particles.velocities.empty()) return velocities;
  const float inverse = 1 / particles.supportRadius;
  const Vec3f reach = Vec3f::Constant(particles.supportRadius);
  parallelFor(pool, positions.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) {
      const CellGrid::Cell low = particles.cells.cellOf(Float4(Vec3f(positions[v] - reach))),
                           high = particles.cells.cellOf(Float4(Vec3f(positions[v] + reach)));
      float weights = 0;
      for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
          const auto row = particles.cells.row(low.x, high.x, y, z);
          for (std::uint32_t k = row.from; k < row.to; ++k) {
            const float q2 = ((particles.positions[k].xyz() - positions[v]) * inverse).squaredNorm();
            if (q2 >= 1) continue;
            const float weight = particles.positions[k].w * (1 - q2) * (1 - q2) * (1 - q2);
            weights += weight;
            velocities[v] += weight * particles.velocities[k].xyz();
          }
        }
      }
      if (weights > 0) velocities[v] /= weights;
    }
  });
  return velocities;
}

/// Leaves out pieces that enclose less than `least` (m^3), and their vertices.
void dropSmallPieces(RawMesh& mesh, double least) {
  std::vector<std::uint32_t> piece(mesh.positions.size());
  std::iota(piece.begin(), piece.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (piece[v] != v) v = piece[v] = piece[piece[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t least3 = std::min({root(a), root(b), root(c)});
    piece[root(a)] = piece[root(b)] = piece[root(c)] = least3;
  }
  std::vector<double> volume(piece.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles)
    volume[root(a)] +=
        static_cast<double>(mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c]))) / 6;
  const auto kept = [&](std::uint32_t v) { return std::abs(volume[root(v)]) >= least; };
  RawMesh rest;
  std::vector<std::uint32_t> place(piece.size(), 0);
  for (std::uint32_t v = 0; v < piece.size(); ++v) {
    if (!kept(v)) continue;
    place[v] = static_cast<std::uint32_t>(rest.positions.size());
    rest.positions.push_back(mesh.positions[v]);
    rest.holds.push_back(mesh.holds[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (!kept(a)) continue;
    rest.triangles.push_back({place[a], place[b], place[c]});
    rest.wet.push_back(mesh.wet[t]);
  }
  std::swap(mesh, rest);
}

}  // namespace

SurfaceMesh liquidSurface(const LiquidParticles& particles, const LiquidWalls& walls,
                          const SurfaceOptions& options, ThreadPool& pool, StageTimes* times) {
  StageTimes ignored;
  StageTimes& stages = times != nullptr ? *times : ignored;
  SurfaceMesh mesh;
  const auto finite = [](const Float4& p) { return p.xyz().allFinite(); };
  if (!std::all_of(particles.positions.begin(), particles.positions.end(), finite)) {
    std::vector<Float4> positions, velocities;
    for (std::size_t k = 0; k < particles.positions.size(); ++k) {
      if (!finite(particles.positions[k])) continue;
      positions.push_back(particles.positions[k]);
      if (!particles.velocities.empty()) velocities.push_back(particles.velocities[k]);
    }
    return liquidSurface(
        {positions, velocities, particles.spacing, particles.supportRadius, particles.kernel}, walls, options,
        pool, times);
  }
  if (particles.positions.empty()) return mesh;
  LiquidWalls kept = walls;
  if (kept.boundary != nullptr && kept.boundary->empty()) kept = {};
  const auto spacing = static_cast<double>(particles.spacing);
  SortedParticles liquid;
  stages.time("sort", [&] { liquid = sorted(particles, kept, pool); });
  RawMesh raw;
  std::optional<Grid> grid;
  stages.time("grid", [&] {
    grid.emplace(liquid, kept, spacing, options.resolution * spacing, options.place, pool);
  });
  stages.time("contour", [&] { raw = surface::contour(*grid, pool); });
  const auto support = static_cast<double>(particles.supportRadius);
  stages.time("smooth", [&] {
    surface::smooth(raw, *grid, varianceOf(particles.kernel) * support * support, options.smoothing, pool);
  });
  if (options.smallest > 0) dropSmallPieces(raw, options.smallest * spacing * spacing * spacing);
  stages.time("normals", [&] { mesh.normals = normalsOf(raw); });
  stages.time("velocities", [&] { mesh.velocities = velocitiesOf(raw.positions, liquid, pool); });
  mesh.positions = std::move(raw.positions);
  mesh.triangles = std::move(raw.triangles);
  mesh.wet = std::move(raw.wet);
  return mesh;
}

double enclosedVolume(const SurfaceMesh& mesh) {
  double sum = 0;
  if (mesh.positions.empty()) return sum;
  const Vec3d origin = mesh.positions.front().cast<double>();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d p = mesh.positions[a].cast<double>() - origin, q = mesh.positions[b].cast<double>() - origin,
                r = mesh.positions[c].cast<double>() - origin;
    sum += p.dot(q.cross(r)) / 6;
  }
  return sum;
}

}  // namespace migiwa
