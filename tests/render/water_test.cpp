// The style "water": its outline against the mesh filled by hand, the light that it takes against Beer and
// Lambert, and what degenerate meshes do to it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/raytrace/optics.h"
#include "app/render/projection.h"
#include "app/viewer/viewer.h"
#include "core/simulation/scene_surface.h"
#include "core/simulation/simulation.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace water_test {

constexpr int kWidth = 1280, kHeight = 720;

using Mask = std::vector<std::uint8_t>;

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
}

/// Pixels whose centres some triangle covers.
Mask filled(const SurfaceMesh& mesh, const Camera& camera) {
  const Projection projection = makeProjection(camera, kWidth, kHeight, {0, 0, kWidth, kHeight});
  const Eigen::Matrix4d toScreen = (projection.clip * projection.view).cast<double>();
  std::vector<Eigen::Vector2d> places;
  for (const Vec3f& p : mesh.positions) {
    const Eigen::Vector4d clip = toScreen * Eigen::Vector4d(p.cast<double>().homogeneous());
    places.emplace_back((0.5 + 0.5 * clip.x() / clip.w()) * kWidth,
                        (0.5 - 0.5 * clip.y() / clip.w()) * kHeight);
  }
  Mask mask(static_cast<std::size_t>(kWidth) * kHeight, 0);
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector2d &a = places[i], &b = places[j], &c = places[k];
    const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& p) {
      return (to - from).x() * (p - from).y() - (to - from).y() * (p - from).x();
    };
    const double turn = side(a, b, c) < 0 ? -1 : 1;
    for (int y = std::max(static_cast<int>(low.y()), 0); y < std::min(high.y() + 1, 1.0 * kHeight); ++y)
      for (int x = std::max(static_cast<int>(low.x()), 0); x < std::min(high.x() + 1, 1.0 * kWidth); ++x) {
        const Eigen::Vector2d p(x + 0.5, y + 0.5);
        if (turn * side(a, b, p) >= 0 && turn * side(b, c, p) >= 0 && turn * side(c, a, p) >= 0)
          mask[at(x, y)] = 1;
      }
  }
  return mask;
}

/// Pixels of a mask with a neighbour on the other side.
std::vector<std::array<int, 2>> outline(const Mask& mask) {
  std::vector<std::array<int, 2>> pixels;
  for (int y = 1; y + 1 < kHeight; ++y)
    for (int x = 1; x + 1 < kWidth; ++x)
      if (mask[at(x, y)] != 0 && (mask[at(x - 1, y)] == 0 || mask[at(x + 1, y)] == 0 ||
                                  mask[at(x, y - 1)] == 0 || mask[at(x, y + 1)] == 0))
        pixels.push_back({x, y});
  return pixels;
}

/// The share of one outline that lies within a pixel of the other.
double shareNear(const Mask& of, const Mask& to) {
  Mask near(of.size(), 0);
  for (const auto& [x, y] : outline(to))
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) near[at(x + dx, y + dy)] = 1;
  const auto pixels = outline(of);
  const auto count = std::count_if(pixels.begin(), pixels.end(),
                                   [&](const auto& pixel) { return near[at(pixel[0], pixel[1])] != 0; });
  return static_cast<double>(count) / static_cast<double>(pixels.size());
}

class WaterStyle : public ::testing::Test {
 protected:
  Image draw(Viewer& viewer, const FrameView& frame, const SurfaceMesh& water) const {
    FrameView shown = frame;
    shown.water = std::make_shared<const SurfaceMesh>(water);
    return viewer.takePicture(shown, RunStatus{}, kWidth, kHeight);
  }
  static ViewerOptions options() { return {.panels = false, .timings = false, .water = true}; }

  std::unique_ptr<GlContext> context_ = makeEglContext();
};

TEST_F(WaterStyle, OutlineIsTheMeshs) {
  Scene scene = smallScene();
  scene.particleSpacing = 0.05;
  Simulation simulation(scene);
  while (simulation.frame() < simulation.frameAt(0.4)) simulation.advanceFrame();
  ThreadPool pool(2);
  SceneSurface surface(scene, SurfaceOptions{}, pool);
  const SurfaceMesh mesh = surface.mesh(simulation.view().positions, {}, simulation.time());
  // Nothing but the backdrop is behind the water, and nothing before it.
  scene.view.look.waterColor = {0.001, 0.001, 0.001};
  scene.view.look.waterDepth = 0.01;
  Viewer viewer(scene, {}, options());
  const Image with = draw(viewer, simulation.view(), mesh), without = draw(viewer, simulation.view(), {});
  Mask found(static_cast<std::size_t>(kWidth) * kHeight, 0);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(int{with.rgba[4 * i + c]} - int{without.rgba[4 * i + c]}) > 8) found[i] = 1;
  const Mask expected = filled(mesh, scene.view.camera);
  EXPECT_GT(outline(expected).size(), 800U);
  EXPECT_GT(shareNear(found, expected), 0.99);
  EXPECT_GT(shareNear(expected, found), 0.99);
}

/// A box of water from `back` to `front` along z, by default wide enough to fill the picture.
SurfaceMesh slab(float front, float back = 0, float halfWidth = 2) {
  SurfaceMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back((k & 1) != 0 ? halfWidth : -halfWidth,
                                (k & 2) != 0 ? 100 + halfWidth : 100 - halfWidth,
                                (k & 4) != 0 ? front : back);
  const auto side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                        const Vec3f& normal) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t corner : {a, b, c, d}) {
      mesh.positions.push_back(Vec3f(mesh.positions[corner]));
      while (mesh.normals.size() < mesh.positions.size()) mesh.normals.push_back(normal);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  side(4, 5, 7, 6, Vec3f::UnitZ());
  side(1, 0, 2, 3, -Vec3f::UnitZ());
  mesh.velocities.assign(mesh.positions.size(), Vec3f::Zero());
  mesh.wet.assign(mesh.triangles.size(), 0);
  return mesh;
}

double linear(std::uint8_t encoded) {
  const double c = encoded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST_F(WaterStyle, TakesLightAsBeerAndLambertSay) {
  Scene scene = smallScene();
  scene.view.camera = {Vec3d(0, 100, 3), Vec3d(0, 100, 0), Vec3d(0, 1, 0), 20};
  scene.view.look.waterColor = {0.25, 0.5, 0.9};
  scene.view.look.waterDepth = 0.5;
  Viewer viewer(scene, {}, options());
  const FrameSnapshot frame = frameOf({}, 0.1F);
  const Image none = draw(viewer, frame.view(), {}), thin = draw(viewer, frame.view(), slab(0.001F)),
              thick = draw(viewer, frame.view(), slab(0.5F));
  // Head on each face lets 98 % pass; the rest shows the same surroundings before and behind.
  const double passing = 1 - std::pow(0.333 / 2.333, 2);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = [&](const Image& image) { return linear(image.pixel(kWidth / 2, kHeight / 2)[c]); };
    EXPECT_NEAR(value(thin) / value(none), 1, 0.03) << c;
    const double share = scene.view.look.waterColor[static_cast<Eigen::Index>(c)];
    EXPECT_NEAR(value(thick) - (1 - passing) * value(none), passing * share * value(none), 0.02) << c;
  }
}

TEST_F(WaterStyle, NormalsThatCancelOutLeaveNoHole) {
  Scene scene = smallScene();
  scene.view.camera = {Vec3d(0, 100, 3), Vec3d(0, 100, 0), Vec3d(0, 1, 0), 20};
  Viewer viewer(scene, {}, options());
  SurfaceMesh mesh = slab(0.2F);
  const Image wanted = draw(viewer, frameOf({}, 0.1F).view(), mesh);
  std::fill(mesh.normals.begin(), mesh.normals.end(), Vec3f::Zero());
  mesh.triangles.push_back({0, 0, 0});
  mesh.wet.push_back(1);
  const Image found = draw(viewer, frameOf({}, 0.1F).view(), mesh);
  for (const std::size_t c : {0U, 1U, 2U})
    EXPECT_NEAR(found.pixel(kWidth / 2, kHeight / 2)[c], wanted.pixel(kWidth / 2, kHeight / 2)[c], 2);
}

/// Water in the middle of the picture whose front throws light to the left, out of the pixels that it covers.
SurfaceMesh prism() {
  SurfaceMesh mesh = slab(0.5F, 0, 0.2F);
  for (Vec3f& normal : mesh.normals)
    if (normal.z() > 0) normal = Vec3f(0.8F, 0, 0.6F);
  return mesh;
}

/// A wall that stands on the left nearer to the eye than the prism.
WallDrawing leftWall() {
  WallMesh wall;
  for (const Vec3f& p : {Vec3f(-2, 98, 1), Vec3f(-0.25F, 98, 1), Vec3f(-0.25F, 102, 1), Vec3f(-2, 102, 1)})
    wall.surface.vertices.push_back(p);
  wall.surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  wall.normals.assign(4, Vec3f::UnitZ());
  return {.lines = {}, .meshes = {wall}, .nodes = {}};
}

Scene prismScene() {
  Scene scene = smallScene();
  scene.view.camera = {Vec3d(0, 100, 3), Vec3d(0, 100, 0), Vec3d(0, 1, 0), 20};
  scene.view.look.waterColor = {0.25, 0.5, 0.9};
  scene.view.look.waterDepth = 0.5;
  return scene;
}

std::ptrdiff_t differentBytes(const Image& a, const Image& b) {
  return std::inner_product(a.rgba.begin(), a.rgba.end(), b.rgba.begin(), std::ptrdiff_t{0}, std::plus<>{},
                            std::not_equal_to<>{});
}

TEST_F(WaterStyle, IsTheSameAfterAnotherFrame) {
  const Scene scene = prismScene();
  Viewer viewer(scene, leftWall(), options());
  const FrameSnapshot frame = frameOf({}, 0.1F);
  const Image first = draw(viewer, frame.view(), prism());
  draw(viewer, frame.view(), slab(0.5F, -4));
  EXPECT_EQ(differentBytes(first, draw(viewer, frame.view(), prism())), 0);
}

TEST_F(WaterStyle, SeesWhatLiesAroundTheWater) {
  const Scene scene = prismScene();
  Viewer viewer(scene, leftWall(), options());
  const FrameSnapshot frame = frameOf({}, 0.1F);
  // Vertices without a face, so that the water has a part in the whole picture.
  SurfaceMesh wide = prism();
  for (const float far : {-2.0F, 2.0F}) {
    wide.positions.emplace_back(far, 100 + far, 0);
    wide.normals.push_back(Vec3f::UnitZ());
    wide.velocities.push_back(Vec3f::Zero());
  }
  const Image found = draw(viewer, frame.view(), prism());
  EXPECT_EQ(differentBytes(found, draw(viewer, frame.view(), wide)), 0);
}

TEST_F(WaterStyle, ParticlesAreShownWhereThereIsNoSurface) {
  const Simulation simulation(smallScene());
  const auto picture = [&](const ViewerOptions& with) {
    return Viewer(smallScene(), simulation.walls(), with)
        .takePicture(simulation.view(), RunStatus{}, 640, 360)
        .rgba;
  };
  ViewerOptions particles = options();
  particles.water = false;
  EXPECT_EQ(picture(options()), picture(particles));
}

}  // namespace water_test
}  // namespace migiwa
