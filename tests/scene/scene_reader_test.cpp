// Scenes in, values out.
#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace scene_reader_test {

constexpr std::string_view kFull = R"({
  "$schema": "scene.schema.json",
  "format": 1,
  "name": "Everything",
  "description": "Each key once.",
  "duration": 2.5,
  "particle_spacing": 0.1,
  "gravity": [0.5, -1, 2],
  "fluid": [
    { "shape": "box", "min": [0, 0, 0], "max": [0.4, 0.5, 0.6], "velocity": [1, 2, 3], "trim": false,
      "rotation": { "axis": [0, 0, 1], "degrees": 90 } },
    { "shape": "sphere", "center": [3, 0, 0], "radius": 0.5 }
  ],
  "boundary": {
    "handling": "none",
    "gamma": { "method": "mean" },
    "surfaces": [
      { "shape": "plane", "point": [0, -2, 0], "normal": [0, 1, 0] },
      { "shape": "box", "fluid": "inside", "min": [-5, -5, -5], "max": [5, 5, 5] }
    ]
  },
  "solver": { "time_step": 0.01, "substeps": 2, "cfl": 0, "min_iterations": 3, "max_iterations": 7, "tolerance": 0.5,
    "cfm_epsilon": 2, "kernel": "cubic_spline", "support_ratio": 2.5, "position_step": "paper", "rest_density": 900 },
  "effects": { "viscosity": {} },
  "view": { "camera": { "eye": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 1], "fov_degrees": 30 },
    "clip": { "axis": "x", "at": 0.25 }, "nodes": true, "color": "speed", "color_range": [0, 3] }
})";

TEST(SceneReader, ReadsEveryKey) {
  const Scene scene = parseScene(kFull, "folder/everything.json");
  EXPECT_EQ(scene.stem(), "everything");
  EXPECT_EQ(scene.name, "Everything");
  EXPECT_EQ(scene.description, "Each key once.");
  EXPECT_EQ(scene.duration, 2.5);
  EXPECT_EQ(scene.particleSpacing, 0.1);
  EXPECT_EQ(scene.gravity, Vec3d(0.5, -1, 2));

  ASSERT_EQ(scene.fluid.size(), 2U);
  EXPECT_EQ(scene.fluid[0]->velocity, Vec3d(1, 2, 3));
  EXPECT_FALSE(scene.fluid[0]->trim);
  EXPECT_TRUE(scene.fluid[0]->bounds().size().isApprox(Vec3d(0.5, 0.4, 0.6)));
  EXPECT_EQ(scene.fluid[1]->velocity, Vec3d(0, 0, 0));
  EXPECT_TRUE(scene.fluid[1]->trim);
  EXPECT_TRUE(scene.fluid[1]->bounds().center().isApprox(Vec3d(3, 0, 0)));

  EXPECT_EQ(scene.boundary.handling, BoundaryHandling::none);
  EXPECT_EQ(gammaMethodNames()[static_cast<std::size_t>(scene.boundary.gammaMethod)], "mean");
  ASSERT_EQ(scene.surfaces.size(), 2U);
  Vec3f normal;
  EXPECT_FLOAT_EQ(scene.surfaces[0]->distance({0, 1, 0}, normal), 3);
  EXPECT_FLOAT_EQ(scene.surfaces[1]->distance({0, 1, 0}, normal), 4);

  EXPECT_EQ(scene.solver.timeStep, 0.01);
  EXPECT_EQ(scene.solver.substeps, 2);
  EXPECT_EQ(scene.solver.cfl, 0);
  EXPECT_EQ(scene.solver.minIterations, 3);
  EXPECT_EQ(scene.solver.maxIterations, 7);
  EXPECT_EQ(scene.solver.tolerance, 0.5);
  EXPECT_EQ(scene.solver.cfmEpsilon, 2);
  EXPECT_EQ(scene.solver.kernel, KernelType::cubicSpline);
  EXPECT_EQ(scene.solver.supportRatio, 2.5);
  EXPECT_EQ(scene.solver.positionStep, PositionStep::paper);
  EXPECT_EQ(scene.solver.restDensity, 900);
  ASSERT_EQ(scene.effects.size(), 1U);
  EXPECT_EQ(scene.effects[0].name, "viscosity");

  EXPECT_EQ(scene.view.camera.eye, Vec3d(1, 2, 3));
  EXPECT_EQ(scene.view.camera.target, Vec3d(4, 5, 6));
  EXPECT_EQ(scene.view.camera.up, Vec3d(0, 0, 1));
  EXPECT_EQ(scene.view.camera.fovDegrees, 30);
  EXPECT_TRUE(scene.view.clip.enabled);
  EXPECT_EQ(scene.view.clip.axis, Axis::x);
  EXPECT_EQ(scene.view.clip.at, 0.25);
  EXPECT_TRUE(scene.view.nodes);
  EXPECT_EQ(scene.view.color, ColorField::speed);
  EXPECT_TRUE(scene.view.hasColorRange);
  EXPECT_EQ(scene.view.colorRange[1], 3);
}

TEST(SceneReader, TheShortestSceneTakesTheDefaults) {
  const Scene scene = parseScene(R"({"format": 1})", "short.json");
  const SolverParameters defaults;
  EXPECT_EQ(scene.name, "short");
  EXPECT_TRUE(scene.fluid.empty());
  EXPECT_TRUE(scene.surfaces.empty());
  EXPECT_TRUE(scene.effects.empty());
  EXPECT_EQ(scene.gravity, Vec3d(0, -9.81, 0));
  EXPECT_EQ(scene.boundary.handling, BoundaryHandling::gamma);
  EXPECT_EQ(gammaMethodNames()[static_cast<std::size_t>(scene.boundary.gammaMethod)], "auto");
  EXPECT_EQ(scene.solver.timeStep, defaults.timeStep);
  EXPECT_FALSE(scene.view.clip.enabled);
  EXPECT_FALSE(scene.view.hasColorRange);
  EXPECT_TRUE(scene.bounds().empty());
}

TEST(SceneReader, BoundsHoldFluidAndFiniteWalls) {
  const Bounds bounds = parseScene(kFull, "everything.json").bounds();
  EXPECT_TRUE(bounds.min.isApprox(Vec3d(-5, -5, -5)));
  EXPECT_TRUE(bounds.max.isApprox(Vec3d(5, 5, 5)));
}

TEST(SceneReader, WholeNumbersMayBeWrittenWithAPoint) {
  EXPECT_EQ(parseScene(R"({"format": 1.0, "solver": {"substeps": 3e0}})", "a.json").solver.substeps, 3);
}

TEST(SceneReader, AcceptsAByteOrderMarkAndAnyLineEnds) {
  EXPECT_EQ(parseScene("\xEF\xBB\xBF{\r\n\"format\": 1,\r\"name\": \"a\"}\r\n", "a.json").name, "a");
}

TEST(SceneReader, ACopyIsIndependentOfTheFirst) {
  Scene scene = parseScene(kFull, "everything.json");
  const Scene copy = scene;
  scene.solver.tolerance = 0.1;
  scene.fluid.clear();
  EXPECT_EQ(copy.solver.tolerance, 0.5);
  EXPECT_EQ(copy.fluid.size(), 2U);
}

}  // namespace scene_reader_test
}  // namespace migiwa
