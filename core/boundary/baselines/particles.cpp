// Akinci, Ihmsen, Akinci, Solenthaler, Teschner 2012, "Versatile Rigid-Fluid Coupling for Incompressible
// SPH": walls are sampled with one layer of particles, whose volumes make up for uneven sampling, and
// rho_i = S_i + sum_b Psi_b W_ib (Eq. 6). A wall pushes by the fluid particle's own pressure (Eq. 9): here
// by its own lambda, through the gradient of the same sum.
// Deviation: the paper puts the particles on the surface and lets the fluid come to rest where it will. Here
// centres of fluid particles stay half a spacing in front of the wall, and boundary particles lie as far
// behind it as lets a lattice that rests on a flat wall read the density at rest: the depth at which the
// method does best. Walls have no friction of their own.
#include <cmath>
#include <optional>

#include "core/base/portable_math.h"
#include "core/boundary/baselines/baselines.h"
#include "core/boundary/baselines/boundary_particles.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

/// How far behind a flat wall a square lattice of boundary particles lies (m) that makes up for what a fluid
/// lattice half a spacing in front of it lacks, on the mean over places along the wall.
template <class Kernel>
float restingDepth(double spacing, double support) {
  const double ratio = support / spacing;
  const int reach = static_cast<int>(std::ceil(ratio));
  const auto layer = [&](double height, double x, double z) {
    double sum = 0;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach - 1; i <= reach; ++i)
        sum += static_cast<double>(
            Kernel::value(static_cast<float>(portable::hypot(height, i + x, j + z) / ratio)));
    return sum;
  };
  double lacking = 0, whole = layer(0, 0, 0);
  for (int k = 1; k <= reach; ++k) lacking += layer(k, 0, 0);
  whole += 2 * lacking;
  const auto added = [&](double height) {
    constexpr int kPlaces = 4;
    double sum = 0;
    for (int z = 0; z < kPlaces; ++z)
      for (int x = 0; x < kPlaces; ++x) sum += layer(height, x / double{kPlaces}, z / double{kPlaces});
    return sum / (kPlaces * kPlaces * layer(0, 0, 0));
  };
  double near = 0.5, far = ratio;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (near + far);
    (added(middle) > lacking / whole ? near : far) = middle;
  }
  return static_cast<float>((near - 0.5) * spacing);
}

/// Walls that move as one, with their particles where the walls are described.
struct Body {
  const MovingSurface* mover;  ///< one of them; null: they stand still
  BoundaryParticles particles;
};

template <class Kernel>
class ParticleWalls final : public GammaMethod {
 public:
  explicit ParticleWalls(const GammaContext& context)
      : GammaMethod(WallDensity::added), boundary_(context.boundary) {
    std::vector<std::shared_ptr<const Surface>> still;
    for (const auto& surface : boundary_.surfaces())
      if (dynamic_cast<const MovingSurface*>(surface.get()) == nullptr) still.push_back(surface);
    addBody(context, nullptr, std::move(still));
    for (int group = 0; group < static_cast<int>(boundary_.moving().size()); ++group) {
      const MovingSurface* mover = nullptr;
      std::vector<std::shared_ptr<const Surface>> rest;
      for (const auto& wall : boundary_.moving()) {
        if (wall->group() != group) continue;
        mover = wall.get();
        rest.push_back(wall->rest());
      }
      addBody(context, mover, std::move(rest));
    }
  }

  GammaChoice choice() const override {
    std::size_t count = 0;
    for (const Body& body : bodies_) count += body.particles.particles().size();
    return {"particles", std::to_string(count) + " boundary particles"};
  }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p);
      for (const Body& body : bodies_) add(body, p, out[i]);
    }
  }

 private:
  static void add(const Body& body, const Vec3f& p, GammaSample& sample) {
    float density = 0;
    Vec3f gradient = Vec3f::Zero(), pairGradient = Vec3f::Zero();
    body.particles.around(body.mover != nullptr ? body.mover->toRest(p) : p,
                          [&](const Vec3f& offset, float q, float volume) {
                            density += volume * Kernel::value(q);
                            if (q <= 0) return;
                            gradient += volume * Kernel::derivative(q) / q * offset;
                            pairGradient += volume * PairKernel<Kernel>::derivative(q) / q * offset;
                          });
    sample.gamma -= density;
    if (body.mover != nullptr) {
      gradient = body.mover->directionToWorld(gradient);
      pairGradient = body.mover->directionToWorld(pairGradient);
    }
    sample.gradient -= gradient;
    sample.pairGradient -= pairGradient;
  }

  void addBody(const GammaContext& context, const MovingSurface* mover,
               std::vector<std::shared_ptr<const Surface>> surfaces) {
    if (surfaces.empty()) return;
    Bounds region;
    bool endless = false;
    for (const auto& surface : surfaces) {
      const Bounds own = surface->bounds();
      endless = endless || own.empty();
      region.include(own);
    }
    // A wall without end has particles as far around the scene as the scene is wide.
    if (endless) region.include(context.region.grown(context.region.size().norm()));
    const Boundary boundary = Boundary::atRest(std::move(surfaces));
    std::optional<ThreadPool> own;
    ThreadPool& pool = context.pool != nullptr ? *context.pool : own.emplace(1);
    bodies_.push_back({mover,
                       {sampleWalls(boundary, region, context.spacing,
                                    restingDepth<Kernel>(static_cast<double>(context.spacing),
                                                         static_cast<double>(context.supportRadius)),
                                    pool, context.place),
                        context.kernel, context.supportRadius, pool}});
  }

  const Boundary& boundary_;
  std::vector<Body> bodies_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeBoundaryParticles(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<ParticleWalls<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
