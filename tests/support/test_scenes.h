// Scenes put together in code, for tests that need nothing of a file.
#pragma once

#include <memory>

#include "core/scene/scene.h"
#include "core/scene/sources.h"
#include "core/walls/shapes.h"
#include "tests/support/test_effects.h"

namespace migiwa::testing {

inline constexpr double kSpacing = 0.05;

/// An empty scene without walls and gravity, at the spacing of the shipped scenes. Velocities are from
/// positions: what a test of the constraint sees is then the constraint's doing alone.
inline Scene emptyScene() {
  Scene scene;
  scene.file = "test.json";
  scene.solver.takeVelocities(VelocityStep::positions);
  scene.particleSpacing = kSpacing;
  scene.gravity = Vec3d::Zero();
  return scene;
}

inline void addFluid(Scene& scene, const Vec3d& min, const Vec3d& max, const Vec3d& velocity = Vec3d::Zero(),
                     bool trim = true) {
  auto source = std::make_shared<BoxSource>(min, max);
  source->velocity = velocity;
  source->trim = trim;
  scene.fluid.push_back(source);
}

inline void addTank(Scene& scene, const Vec3d& min, const Vec3d& max, const Rotation& rotation = {}) {
  scene.surfaces.push_back(std::make_shared<Box>(min, max, Box::Fluid::inside, rotation));
}

inline void addViscosity(Scene& scene) {
  scene.effects = effectsOf(R"({"viscosity": {}})");
}

/// A tank filled with cells[0] x cells[1] x cells[2] particles from its floor, in rest, under gravity.
inline Scene stillTank(const Eigen::Vector3i& cells) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  const Vec3d size = kSpacing * cells.cast<double>();
  addFluid(scene, Vec3d::Zero(), size);
  addTank(scene, Vec3d::Zero(), {size.x(), 2 * size.y(), size.z()});
  addViscosity(scene);
  return scene;
}

/// A block of 6 x 8 x 6 particles that falls over in a tank.
inline Scene smallDamBreak() {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.3, 0.4, 0.3});
  addTank(scene, Vec3d::Zero(), {0.9, 0.8, 0.3});
  addViscosity(scene);
  return scene;
}

/// Thirty mouths at nearly one place: without guards, one step throws their fluid apart at speeds that
/// nothing has given.
inline Scene blowUp() {
  Scene scene = emptyScene();
  scene.domain = {true, {-3, -3, -3}, {3, 3, 3}};
  for (int k = 0; k < 30; ++k) {
    Emitter emitter;
    emitter.shape = MouthShape::rectangle;
    emitter.center = {1e-3 * k, 0, 0};
    emitter.size = {0.3, 0.3};
    emitter.speed = 1;
    scene.emitters.push_back(emitter);
  }
  scene.solver.cfl = 0;
  scene.solver.timeStep = 0.001;
  scene.solver.maxIterations = 50;
  return scene;
}

}  // namespace migiwa::testing
