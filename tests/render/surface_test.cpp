// Walls as surfaces: a SLIM sphere against the projection of the exact one, worked out by hand, and against a
// mesh of the exact one with exact normals; cuts and discs at the pixel where geometry has them.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/render/renderer.h"
#include "core/slim/fit.h"
#include "core/walls/slim_wall.h"
#include "tests/render/test_scene.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace surface_test {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kFov = 50, kDistance = 4, kRadius = 0.5, kPi = std::numbers::pi;

double focal() {
  return 0.5 * kHeight / std::tan(0.5 * kFov * kPi / 180);
}

WallMesh slimSphere(SlimSurface::Fluid fluid) {
  ThreadPool pool(2);
  const auto data = std::make_shared<SlimWallData>();
  SlimFitOptions options;
  options.degree = 2;
  options.tolerance = 0.0002;
  data->model = std::make_unique<const SlimModel>(
      fitSlim(testing::ExactSphere{kRadius}.points(20000), options, pool), 2, true, pool);
  return SlimSurface(data, fluid).mesh();
}

/// Rings of triangles between the poles, with the sphere's own normals.
WallMesh exactSphere() {
  constexpr std::uint32_t kRings = 200, kSteps = 400;
  WallMesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      const double polar = kPi * ring / kRings, around = 2 * kPi * step / kSteps;
      const Vec3d normal(std::sin(polar) * std::cos(around), std::cos(polar),
                         std::sin(polar) * std::sin(around));
      mesh.surface.vertices.push_back((kRadius * normal).cast<float>());
      mesh.normals.push_back(normal.cast<float>());
      if (ring == kRings) continue;
      const std::uint32_t here = ring * kSteps + step, next = ring * kSteps + (step + 1) % kSteps;
      mesh.surface.triangles.push_back({here, next, here + kSteps});
      mesh.surface.triangles.push_back({next, next + kSteps, here + kSteps});
    }
  }
  return mesh;
}

class SurfaceTest : public ::testing::Test {
 protected:
  SurfaceTest() {
    target_.emplace(kWidth, kHeight);
    shot_.camera = {Vec3d(0, 0, kDistance), Vec3d(0, 0, 0), Vec3d(0, 1, 0), kFov};
    shot_.scene = {0, 0, kWidth, kHeight};
  }

  /// With the ground far above the eye, only the backdrop is behind the walls.
  Image draw(const WallDrawing& walls, const FrameSnapshot& frame = frameOf({}, 1)) {
    Surroundings surroundings;
    surroundings.bounds.include(Vec3d(-1, 100, -1));
    surroundings.bounds.include(Vec3d(1, 101, 1));
    surroundings.walls = walls;
    Renderer renderer(surroundings, makeColorMap());
    target_->beginScene();
    renderer.draw(frame.view(), shot_, *target_);
    target_->beginOverlay();
    return target_->read();
  }
  static WallDrawing only(WallMesh mesh) {
    WallDrawing walls;
    walls.meshes.push_back(std::move(mesh));
    return walls;
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  std::optional<RenderTarget> target_;
  Shot shot_;
};

/// Pixels for which `is` holds.
template <class Is>
double area(const Image& image, const Is& is) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += is(image.pixel(x, y)) ? 1 : 0;
  return count;
}

/// The backdrop is bluish, walls and cuts are not.
bool isWall(const std::uint8_t* p) {
  return p[0] > p[2];
}

int largestDifference(const Image& a, const Image& b, int x, int y) {
  int difference = 0;
  for (int c = 0; c < 3; ++c)
    difference = std::max(difference, std::abs(int{a.pixel(x, y)[c]} - int{b.pixel(x, y)[c]}));
  return difference;
}

TEST_F(SurfaceTest, OutlineAndShadingAreThoseOfTheExactSphere) {
  const Image slim = draw(only(slimSphere(SlimSurface::Fluid::outside))), exact = draw(only(exactSphere()));
  const double outline = focal() * std::tan(std::asin(kRadius / kDistance));
  EXPECT_NEAR(area(slim, isWall), kPi * outline * outline, 0.006 * kPi * outline * outline);
  int darkest = 255, lightest = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (std::hypot(x + 0.5 - kWidth / 2.0, y + 0.5 - kHeight / 2.0) > outline - 2) continue;
      ASSERT_LE(largestDifference(slim, exact, x, y), 3) << x << ", " << y;
      darkest = std::min<int>(darkest, exact.pixel(x, y)[1]);
      lightest = std::max<int>(lightest, exact.pixel(x, y)[1]);
    }
  }
  EXPECT_GT(lightest - darkest, 60) << "shading that normals can be read from";
}

TEST_F(SurfaceTest, CutIsWhereThePlaneMeetsTheSphere) {
  const WallDrawing walls = only(slimSphere(SlimSurface::Fluid::outside));
  const double at = -0.2;
  shot_.clip = {true, Axis::z, at};
  const Image picture = draw(walls);
  // Seen square on, the face of the cut is a disc that hides the rest, of one colour but for its outline.
  const double rim = focal() * std::sqrt(kRadius * kRadius - at * at) / (kDistance - at);
  const std::uint8_t* face = picture.pixel(kWidth / 2, kHeight / 2);
  EXPECT_GT(face[0], 2 * face[2]);
  const double flat = area(picture, [&](const std::uint8_t* p) { return std::equal(p, p + 3, face); });
  constexpr double kHalfLine = 0.9;
  EXPECT_GT(flat, kPi * std::pow(rim - kHalfLine - 0.9, 2));
  EXPECT_LT(flat, kPi * std::pow(rim - kHalfLine + 0.3, 2));
  // The outline is darkest in its middle.
  for (const int side : {-1, 1}) {
    int darkestAt = 0, darkest = 256;
    for (int x = 0; x < 120; ++x) {
      const int column = kWidth / 2 + (side > 0 ? x : -1 - x);
      const int sum = int{picture.pixel(column, kHeight / 2)[0]};
      if (sum < darkest) darkest = sum, darkestAt = x;
    }
    EXPECT_NEAR(darkestAt + 0.5, rim, 0.8) << "side " << side;
  }
  // Nothing is cut from what lies behind, all of what lies before.
  shot_.clip.at = 0.6;
  const Image whole = draw(walls);
  shot_.clip = {};
  EXPECT_EQ(whole.rgba, draw(walls).rgba);
  shot_.clip = {true, Axis::z, -0.6};
  EXPECT_EQ(draw(walls).rgba, draw({}).rgba);
}

TEST_F(SurfaceTest, SolidHidesWhatIsBehindItAndAVesselShowsWhatIsIn) {
  const FrameSnapshot particle = frameOf({Vec3f(0, 0, 0)}, 0.3F);
  const WallDrawing solid = only(slimSphere(SlimSurface::Fluid::outside)),
                    vessel = only(slimSphere(SlimSurface::Fluid::inside));
  EXPECT_EQ(draw(solid, particle).rgba, draw(solid).rgba);

  const Image bare = draw({}, particle), held = draw(vessel, particle), empty = draw(vessel);
  const int x = kWidth / 2, y = kHeight / 2;
  EXPECT_LT(largestDifference(held, bare, x, y), 40) << "glass takes little away";
  EXPECT_GT(largestDifference(held, empty, x, y), 60);
  // The vessel is seen all the same, and most of all at its outline.
  const double outline = focal() * std::tan(std::asin(kRadius / kDistance));
  EXPECT_GT(largestDifference(empty, draw({}), x + static_cast<int>(outline) - 1, y), 60);

  // Cut open, its far side is a wall like any other.
  shot_.clip = {true, Axis::z, 0};
  EXPECT_TRUE(isWall(draw(vessel).pixel(x, y)));
  EXPECT_EQ(largestDifference(draw(vessel, particle), draw({}, particle), x, y), 0);
}

TEST_F(SurfaceTest, GlassLooksTheSameWhateverTheOrderOfItsTriangles) {
  WallMesh mesh = slimSphere(SlimSurface::Fluid::inside);
  // A second layer, so that there is an order.
  const auto count = static_cast<std::uint32_t>(mesh.surface.vertices.size());
  for (std::uint32_t k = 0; k < count; ++k) {
    mesh.surface.vertices.emplace_back(mesh.surface.vertices[k] - Vec3f(0, 0, 1.2F));
    mesh.normals.emplace_back(mesh.normals[k]);
  }
  const std::size_t triangles = mesh.surface.triangles.size();
  for (std::size_t k = 0; k < triangles; ++k) {
    const auto [a, b, c] = mesh.surface.triangles[k];
    mesh.surface.triangles.push_back({a + count, b + count, c + count});
  }
  const Image picture = draw(only(mesh));
  std::reverse(mesh.surface.triangles.begin(), mesh.surface.triangles.end());
  EXPECT_EQ(picture.rgba, draw(only(mesh)).rgba);
}

TEST_F(SurfaceTest, NodesAreDiscsOfTheirSize) {
  WallDrawing walls = only(slimSphere(SlimSurface::Fluid::outside));
  const Image surface = draw(walls);
  walls.nodes.push_back({Vec3f::Zero(), Vec3f::UnitZ(), 0.5F, 0.3F, false});
  EXPECT_EQ(draw(walls).rgba, surface.rgba) << "only where they are asked for";
  shot_.nodes = true;
  const double radius = 0.3 * focal() / kDistance;
  // A pixel at the rim counts before half of it is covered, for discs have strong colours.
  EXPECT_NEAR(area(draw(walls), isWall), kPi * radius * radius, 0.5 * 2 * kPi * radius);
  // Askew by 60 degrees it is half as wide (and a little more, for half of it is nearer).
  walls.nodes[0].normal = Vec3f(std::sin(1.0471976F), 0, std::cos(1.0471976F));
  EXPECT_NEAR(area(draw(walls), isWall), 0.5 * kPi * radius * radius, 0.02 * kPi * radius * radius);
  // Cut in half.
  shot_.clip = {true, Axis::x, 0};
  EXPECT_NEAR(area(draw(walls), isWall), 0.25 * kPi * radius * radius, 0.03 * kPi * radius * radius);
  shot_.clip = {};
  // A vessel's near side must not hide the fluid: a rim.
  walls.nodes[0] = {Vec3f::Zero(), -Vec3f::UnitZ(), 0.5F, 0.3F, true};
  const Image hollow = draw(walls);
  EXPECT_LT(area(hollow, isWall), 0.2 * kPi * radius * radius);
  EXPECT_FALSE(isWall(hollow.pixel(kWidth / 2, kHeight / 2)));
}

TEST_F(SurfaceTest, ShadowIsAsDarkAsTheGroundIsCovered) {
  Surroundings surroundings;
  surroundings.bounds.include(Vec3d(-1, 0, -1));
  surroundings.bounds.include(Vec3d(1, 2, 1));
  const Ground ground = makeGround(surroundings.bounds, Vec3d::UnitY());
  GroundShadow shadow(ground);
  // A plate of 1 m on the ground in 200 by 200 patches: where it lies, each place is covered once.
  std::vector<Float4> patches;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j)
      patches.emplace_back((static_cast<float>(i) - 99.5F) / 200, 0.0F, (static_cast<float>(j) - 99.5F) / 200,
                           1 / 40000.0F);
  const std::span<const float> cells = shadow.compute({}, 0, patches);
  const std::size_t middle = GroundShadow::kSize / 2 * (GroundShadow::kSize + 1);
  EXPECT_NEAR(static_cast<double>(cells[middle]), 1 - std::exp(-1.5), 0.01);
  EXPECT_EQ(cells[0], 0);
}

}  // namespace surface_test
}  // namespace migiwa
