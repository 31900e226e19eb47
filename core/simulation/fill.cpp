#include "core/simulation/fill.h"

#include "core/base/available_memory.h"

namespace migiwa {

namespace {

/// What filling takes for a particle (bytes): a centre and the particle itself, in arrays that grow by
/// doubling.
constexpr double kBytesWhileFilling = 200;

}  // namespace

void fillScene(Scene& scene, const Boundary& boundary, Particles& particles) {
  // A lattice that fills a tank to its walls has its first layer at exactly half a spacing, give or take
  // rounding.
  const auto margin = static_cast<float>((0.5 - 1e-3) * scene.particleSpacing);
  double most = 0;
  for (const auto& source : scene.fluid) most += source->count(scene.particleSpacing);
  requireMemory(kBytesWhileFilling * most, "particles", scene.file.string() + ":/particle_spacing");
  std::vector<Vec3d> centers;
  for (std::size_t k = 0; k < scene.fluid.size(); ++k) {
    const FluidSource& source = *scene.fluid[k];
    centers.clear();
    source.fill(scene.particleSpacing, centers);
    const std::size_t before = particles.size();
    for (const Vec3d& center : centers) {
      const Vec3f p = center.cast<float>();
      if (source.trim && boundary.distance(p) < margin) continue;
      particles.position.emplace_back(p);
      particles.velocity.emplace_back(Vec3f(source.velocity.cast<float>()));
      particles.id.push_back(static_cast<std::uint32_t>(particles.size()));
    }
    if (particles.size() == before) {
      scene.warnings.push_back("/fluid/" + std::to_string(k) +
                               ": no particle is left of this source; it lies within or too near the walls");
    }
  }
}

}  // namespace migiwa
