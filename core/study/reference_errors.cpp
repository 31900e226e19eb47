#include <algorithm>
#include <cmath>

#include "core/gamma/gamma_method.h"
#include "core/sph/kernels.h"
#include "core/sph/neighbours.h"
#include "core/study/study.h"
#include "core/walls/boundary.h"

namespace migiwa {

namespace {

/// The reference at all points; far from walls it is 1 at once.
std::vector<GammaSample> referenceGamma(const Scene& scene, double time, std::span<const Float4> positions,
                                        ThreadPool& pool) {
  Boundary boundary(wallsFor(scene.surfaces, static_cast<float>(scene.supportRadius())));
  boundary.moveTo(time, time);
  const std::span<const std::string_view> names = gammaMethodNames();
  const auto method = std::find(names.begin(), names.end(), "directions") - names.begin();
  GammaContext context{boundary, scene.solver.kernel, static_cast<float>(scene.supportRadius())};
  context.directions = ReferenceSampler::kDirections;
  const PickedGamma reference = makeGammaMethod(static_cast<int>(method), context);
  std::vector<GammaSample> samples(positions.size());
  parallelFor(pool, positions.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    const std::span<GammaSample> all(samples);
    reference.method->evaluate(positions.subspan(begin, end - begin), all.subspan(begin, end - begin));
  });
  return samples;
}

/// rho/rho0 before any correction.
std::vector<double> densities(const Scene& scene, std::span<const Float4> positions, ThreadPool& pool) {
  const auto support = static_cast<float>(scene.supportRadius());
  const double massRatio =
      static_cast<double>(restingLattice(scene.solver.kernel, scene.solver.supportRatio).massRatio);
  CellGrid grid;
  grid.build(positions, support, pool);
  const std::vector<std::uint32_t>& order = grid.order();
  std::vector<double> result(positions.size());
  withKernel(scene.solver.kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    parallelFor(pool, positions.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3f at = positions[i].xyz();
        const CellGrid::Cell cell = grid.cellOf(positions[i]);
        double sum = 0;
        for (int row = 0; row < 9; ++row) {
          const auto [from, to] =
              grid.row(cell.x - 1, cell.x + 1, cell.y + row % 3 - 1, cell.z + row / 3 - 1);
          for (std::uint32_t j = from; j < to; ++j) {
            const float q = (at - positions[order[j]].xyz()).norm() / support;
            if (q < 1) sum += static_cast<double>(Kernel::value(q));
          }
        }
        result[i] = massRatio * sum;
      }
    });
  });
  return result;
}

}  // namespace

void ReferenceSampler::sample(const Simulation& simulation) {
  const FrameView view = simulation.view();
  sample(simulation.scene(), simulation.time(), view.positions, view.gamma, simulation.gammaGradients());
}

void ReferenceSampler::sample(const Scene& scene, double time, std::span<const Float4> positions,
                              std::span<const float> gamma, std::span<const Vec3f> gradients) {
  if (positions.empty()) return;
  ThreadPool pool(threads_);
  const std::vector<GammaSample> reference = referenceGamma(scene, time, positions, pool);
  const std::vector<double> density = densities(scene, positions, pool);
  const auto support = static_cast<float>(scene.supportRadius());
  const RestingLattice lattice = restingLattice(scene.solver.kernel, scene.solver.supportRatio);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto truth = static_cast<double>(reference[i].gamma);
    // What fluid at rest has beside walls is no error to those that reckon with it.
    const float atRest = scene.solver.takesPressure() ? lattice.besideWalls(reference[i].gamma) : 1;
    const double compression = std::max(density[i] / (truth * static_cast<double>(atRest)) - 1, 0.0);
    densitySum_ += compression;
    densityMax_ = std::max(densityMax_, compression);
    ++particles_;
    if (reference[i].distance >= support) continue;
    const double error = std::abs(static_cast<double>(gamma[i]) - truth);
    gammaSum_ += error;
    gammaMax_ = std::max(gammaMax_, error);
    ++nearWalls_;
    if (gradients.empty()) continue;
    gradientSum_ += static_cast<double>((gradients[i] - reference[i].gradient).norm());
    ++gradients_;
  }
}

ReferenceErrors ReferenceSampler::result() const {
  ReferenceErrors errors;
  if (nearWalls_ > 0) {
    errors.gammaMean = gammaSum_ / static_cast<double>(nearWalls_);
    errors.gammaMax = gammaMax_;
  }
  if (gradients_ > 0) errors.gradientMean = gradientSum_ / static_cast<double>(gradients_);
  if (particles_ > 0) {
    errors.densityMean = densitySum_ / static_cast<double>(particles_);
    errors.densityMax = densityMax_;
  }
  return errors;
}

}  // namespace migiwa
