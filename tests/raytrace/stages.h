// Stages of closed form for tests of ray tracing.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "app/raytrace/stage.h"
#include "core/walls/shapes.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {

/// A tank of glass with waves: what a scene, its walls and the surface of its water would be.
struct WavyTank {
  static constexpr double kWidth = 1, kHeight = 0.8, kDepth = 0.6;

  Scene scene = emptyScene();
  Boundary walls;
  SurfaceMesh water;

  /// `cells` along x; `waves`: their height (m); `look` of white light through white things.
  explicit WavyTank(int cells = 40, double waves = 0.05) : waves_(waves) {
    addTank(scene, Vec3d::Zero(), {kWidth, kHeight, kDepth});
    scene.view.look.waterColor.setOnes();
    scene.view.look.mattColor.setOnes();
    scene.view.camera.eye = {0.5, 0.7, 2.2};
    scene.view.camera.target = {0.5, 0.25, 0.3};
    build(cells, cells * 3 / 5);
    walls = Boundary(scene.surfaces);
  }

  double heightAt(double x, double z) const { return 0.35 + waves_ * std::sin(9 * x + 1) * std::cos(8 * z); }
  /// The medium at a point of the tank, by the surface that the mesh approximates.
  Medium mediumAt(const Vec3f& p) const {
    return static_cast<double>(p.y()) < heightAt(static_cast<double>(p.x()), static_cast<double>(p.z()))
               ? Medium::water
               : Medium::air;
  }
  StageContent content(Surround surround = Surround::furnace, bool ground = false) const {
    return {.scene = &scene, .walls = &walls, .water = &water, .surround = surround, .ground = ground};
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  std::uint32_t vertex(double x, double y, double z, const Vec3f& normal) {
    water.positions.emplace_back(Vec3d(x, y, z).cast<float>());
    water.normals.push_back(normal);
    water.velocities.emplace_back(Vec3f::Zero());
    return static_cast<std::uint32_t>(water.positions.size() - 1);
  }
  void face(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint8_t wet) {
    water.triangles.push_back(Corners{a, b, c});
    water.wet.push_back(wet);
  }
  /// The top is free; the sides and the bottom share its vertices and those below.
  void build(int across, int along) {
    const auto at = [along](int layer, int i, int k) {
      return static_cast<std::uint32_t>(2 * (i * (along + 1) + k) + layer);
    };
    for (int i = 0; i <= across; ++i)
      for (int k = 0; k <= along; ++k) {
        const double x = kWidth * i / across, z = kDepth * k / along;
        const double slopeX = waves_ * 9 * std::cos(9 * x + 1) * std::cos(8 * z);
        const double slopeZ = -waves_ * 8 * std::sin(9 * x + 1) * std::sin(8 * z);
        vertex(x, 0, z, -Vec3f::UnitY());
        vertex(x, heightAt(x, z), z, Vec3d(-slopeX, 1, -slopeZ).normalized().cast<float>());
      }
    for (int i = 0; i < across; ++i)
      for (int k = 0; k < along; ++k) {
        face(at(1, i, k), at(1, i, k + 1), at(1, i + 1, k), 0);
        face(at(1, i + 1, k), at(1, i, k + 1), at(1, i + 1, k + 1), 0);
        face(at(0, i, k), at(0, i + 1, k), at(0, i, k + 1), 1);
        face(at(0, i + 1, k), at(0, i + 1, k + 1), at(0, i, k + 1), 1);
      }
    const auto wall = [&](std::uint32_t a0, std::uint32_t b0, std::uint32_t a1, std::uint32_t b1) {
      face(a0, b0, b1, 1);
      face(a0, b1, a1, 1);
    };
    for (int i = 0; i < across; ++i) {
      wall(at(0, i + 1, 0), at(0, i, 0), at(1, i + 1, 0), at(1, i, 0));
      wall(at(0, i, along), at(0, i + 1, along), at(1, i, along), at(1, i + 1, along));
    }
    for (int k = 0; k < along; ++k) {
      wall(at(0, 0, k), at(0, 0, k + 1), at(1, 0, k), at(1, 0, k + 1));
      wall(at(0, across, k + 1), at(0, across, k), at(1, across, k + 1), at(1, across, k));
    }
  }

  double waves_;
};

}  // namespace migiwa::testing
