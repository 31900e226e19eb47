// Water that the wind drives against a ring: a wall and an effect of one's own, in a scene that names both.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <migiwa/effects.h>
#include <migiwa/scene.h>
#include <migiwa/simulation.h>
#include <migiwa/walls.h>

using namespace migiwa;

/// A ring about the x axis, in the plane x = 0.
struct Ring final : Described<Ring, DistanceSurface> {
  double radius = 0.3, thickness = 0.1;  // (m)

  static void fields(auto& visitor, auto& ring) {
    visitor.number("radius", ring.radius, Range::length(10), {"m", "Of the circle within the ring."});
    visitor.number("thickness", ring.thickness, Range::length(10), {"m", "Of the ring."});
  }
  double signedDistance(const Vec3d& p) const override {
    return std::hypot(p.x(), std::hypot(p.y(), p.z()) - radius) - thickness / 2;
  }
  Bounds bounds() const override {
    const Vec3d half = Vec3d(0, radius, radius).array() + thickness / 2;
    return {-half, half};
  }
};

/// The same acceleration everywhere.
struct Wind final : EffectOf<Wind> {
  Vec3d acceleration = Vec3d::Zero();  // (m/s^2)

  static void fields(auto& visitor, auto& wind) {
    visitor.vector("acceleration", wind.acceleration, {"m/s^2", "What the wind adds to all velocities."});
  }
  EffectStages stages() const override { return {.velocity = true}; }
  void changeVelocities(StepState& state, std::span<EffectBuffer>) const override {
    const Vec3f gain = state.timeStep * acceleration.cast<float>();
    for (Float4& velocity : state.particles.velocity) velocity.setXyz(velocity.xyz() + gain);
  }
};

int main() {
  registerSurface<Ring>("ring");
  registerEffect<Wind>("wind");
  Simulation simulation(parseScene(R"({
    "format": 1, "particle_spacing": 0.04, "gravity": [0, 0, 0],
    "fluid": [ { "shape": "box", "min": [-0.5, -0.4, -0.1], "max": [-0.3, 0.4, 0.1] } ],
    "boundary": { "surfaces": [ { "shape": "ring", "radius": 0.3 } ] },
    "effects": { "wind": { "acceleration": [4, 0, 0] } } })"));
  runUntil(simulation, 0.5);
  const FrameView water = simulation.view();
  double speed = 0, gap = 1;
  for (const Float4& v : water.velocities)
    speed += double{v.x} / static_cast<double>(water.velocities.size());
  for (const Float4& p : water.positions) gap = std::min(gap, Ring().signedDistance(p.xyz().cast<double>()));
  std::cout << water.positions.size() << " particles at " << speed << " m/s, " << gap
            << " m from the ring, hash " << hexDigits(simulation.stateHash()) << '\n';
}
