// Water that the wind drives through a ring: a wall and an effect of one's own, in a scene that names both.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <migiwa/effects.h>
#include <migiwa/scene.h>
#include <migiwa/simulation.h>
#include <migiwa/walls.h>

using namespace migiwa;

/// A ring about the x axis through the origin.
class Ring final : public DistanceSurface {
 public:
  void describe(FieldVisitor& visitor) override { fields(visitor, *this); }
  void describe(FieldWriter& visitor) const override { fields(visitor, *this); }
  float distance(const Vec3f& p, Vec3f& normal) const override {
    const float around = std::hypot(p.y(), p.z()), away = around - static_cast<float>(radius_);
    const float out = away / std::max(around, 1e-6F), length = std::hypot(p.x(), away);
    normal = Vec3f(p.x(), out * p.y(), out * p.z()) / std::max(length, 1e-6F);
    return length - static_cast<float>(thickness_) / 2;
  }
  Bounds bounds() const override {
    const double r = radius_ + thickness_ / 2;
    return {{-thickness_ / 2, -r, -r}, {thickness_ / 2, r, r}};
  }

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Ring>& self) {
    visitor.number("radius", self.radius_, Range::length(10), {"m", "Of the circle within the ring."});
    visitor.number("thickness", self.thickness_, Range::length(10), {"m", "Of the ring."});
  }
  double radius_ = 0.3, thickness_ = 0.1;
};

/// The same acceleration everywhere.
class Wind final : public Effect {
 public:
  void describe(FieldVisitor& visitor) override { visitor.vector("acceleration", acceleration_, kDoc); }
  void describe(FieldWriter& visitor) const override { visitor.vector("acceleration", acceleration_, kDoc); }
  std::unique_ptr<Effect> clone() const override { return std::make_unique<Wind>(*this); }
  EffectStages stages() const override { return {.velocity = true}; }
  void changeVelocities(StepState& state, std::span<EffectBuffer>) const override {
    const Vec3f gain = state.timeStep * acceleration_.cast<float>();
    for (Float4& velocity : state.particles.velocity) velocity.setXyz(velocity.xyz() + gain);
  }

 private:
  static constexpr FieldDoc kDoc{"m/s^2", "What the wind adds to the velocity of all water."};
  Vec3d acceleration_ = Vec3d::Zero();
};

int main() try {
  registerSurface("ring", [] { return std::make_unique<Ring>(); });
  registerEffect("wind", [] { return std::make_unique<Wind>(); });
  Simulation simulation(parseScene(R"({
    "format": 1, "duration": 0.5, "particle_spacing": 0.04, "gravity": [0, 0, 0],
    "fluid": [ { "shape": "box", "min": [-0.6, -0.1, -0.1], "max": [-0.3, 0.1, 0.1] } ],
    "boundary": { "surfaces": [ { "shape": "ring", "radius": 0.3, "thickness": 0.1 } ] },
    "effects": { "wind": { "acceleration": [4, 0, 0] } } })",
                                   "ring.json"));
  runUntil(simulation, simulation.scene().duration);
  double speed = 0;
  float clearance = 1;
  for (const Float4& velocity : simulation.view().velocities) speed += static_cast<double>(velocity.x);
  for (const Float4& p : simulation.view().positions) {
    Vec3f normal;
    clearance = std::min(clearance, simulation.scene().surfaces.front()->distance(p.xyz(), normal));
  }
  const std::size_t count = simulation.view().positions.size();
  std::printf("%zu particles, mean speed %.4f m/s, clearance %.4f m, hash %016llx\n", count,
              speed / static_cast<double>(count), static_cast<double>(clearance),
              static_cast<unsigned long long>(simulation.stateHash()));
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
