// One sphere of known place against the perspective projection of a ball, worked out by hand: the rays that
// touch it form a cone, and a plane cuts a cone in an ellipse.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/render/renderer.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace sphere_test {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kFov = 50;

/// Of the outline, in pixels from the picture's middle; the centre lies to the right of it.
struct Ellipse {
  double area, centerX;
};

Ellipse outline(double side, double depth, double radius) {
  const double focal = 0.5 * kHeight / std::tan(0.5 * kFov * std::numbers::pi / 180);
  const double distance = std::hypot(side, depth);
  const double theta = std::atan2(side, depth), alpha = std::asin(radius / distance);
  const double right = std::tan(theta + alpha), left = std::tan(theta - alpha);
  const double middle = 0.5 * (left + right);
  // Points (x, y, 1) at the angle alpha from the axis (sin theta, 0, cos theta), at the ellipse's middle.
  const double along = middle * std::sin(theta) + std::cos(theta), c = std::cos(alpha);
  const double halfHeight = std::sqrt(along * along / (c * c) - middle * middle - 1);
  return {std::numbers::pi * 0.5 * (right - left) * halfHeight * focal * focal, middle * focal};
}

class OneSphere : public ::testing::Test {
 protected:
  /// Black spheres; with the ground far above the eye only the backdrop is behind them.
  OneSphere() {
    Surroundings surroundings;
    surroundings.bounds.include(Vec3d(-1, 100, -1));
    surroundings.bounds.include(Vec3d(1, 101, 1));
    renderer_.emplace(surroundings, ColorMap{});
    target_.emplace(kWidth, kHeight);
    shot_.camera = {Vec3d(0, 0, 4), Vec3d(0, 0, 0), Vec3d(0, 1, 0), kFov};
    shot_.scene = {0, 0, kWidth, kHeight};
  }

  Image draw(const FrameSnapshot& frame) {
    target_->beginScene();
    renderer_->draw(frame.view(), shot_, *target_);
    target_->beginOverlay();
    return target_->read();
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  std::optional<Renderer> renderer_;
  std::optional<RenderTarget> target_;
  Shot shot_;
};

struct Coverage {
  double area = 0, centerX = 0, centerY = 0;  ///< pixels; the centre from the picture's middle
};

/// How much of each pixel a black sphere hides of the backdrop. Only its gleam is not black, well inside.
Coverage measure(const Image& with, const Image& without) {
  const auto hidden = [&](int x, int y) {
    return 1 - with.pixel(x, y)[1] / static_cast<double>(without.pixel(x, y)[1]);
  };
  Coverage coverage;
  for (int y = 1; y + 1 < kHeight; ++y) {
    for (int x = 1; x + 1 < kWidth; ++x) {
      const bool inside =
          std::min({hidden(x - 1, y), hidden(x + 1, y), hidden(x, y - 1), hidden(x, y + 1)}) > 0.6;
      const double share = inside ? 1 : hidden(x, y);
      coverage.area += share;
      coverage.centerX += share * (x + 0.5 - 0.5 * kWidth);
      coverage.centerY += share * (y + 0.5 - 0.5 * kHeight);
    }
  }
  coverage.centerX /= coverage.area;
  coverage.centerY /= coverage.area;
  return coverage;
}

TEST_F(OneSphere, CoversTheAnalyticOutline) {
  const Image backdrop = draw(frameOf({}, 1));
  const double radius = 0.5;
  for (const double side : {0.0, 0.9, 1.6}) {
    const Ellipse expected = outline(side, 4, radius);
    const Coverage found = measure(draw(frameOf({Vec3f(static_cast<float>(side), 0, 0)}, 1)), backdrop);
    EXPECT_NEAR(found.area / expected.area, 1, 0.003) << "side " << side;
    EXPECT_NEAR(found.centerX, expected.centerX, 0.05) << "side " << side;
    EXPECT_NEAR(found.centerY, 0, 0.05) << "side " << side;
  }
}

TEST_F(OneSphere, SmallAndLargeKeepTheirOutline) {
  const Image backdrop = draw(frameOf({}, 1));
  for (const float radius : {0.02F, 0.1F, 1.2F}) {
    const double expected = outline(0, 4, static_cast<double>(radius)).area;
    const Coverage found = measure(draw(frameOf({Vec3f(0, 0, 0)}, 2 * radius)), backdrop);
    // Four samples a pixel: the error is that of the rim alone.
    EXPECT_NEAR(found.area, expected, 0.1 * std::sqrt(expected) + 0.0002 * expected) << "radius " << radius;
  }
}

TEST_F(OneSphere, RimIsSmooth) {
  const Image backdrop = draw(frameOf({}, 1)), picture = draw(frameOf({Vec3f(0, 0, 0)}, 1));
  int partly = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double share = 1 - picture.pixel(x, y)[1] / static_cast<double>(backdrop.pixel(x, y)[1]);
      if (share > 0.15 && share < 0.85) ++partly;
    }
  }
  const double rim = std::sqrt(4 * std::numbers::pi * outline(0, 4, 0.5).area);
  EXPECT_GT(partly, 0.5 * rim);
}

TEST_F(OneSphere, DepthIsThatOfItsFront) {
  const double focal = 0.5 * kHeight / std::tan(0.5 * kFov * std::numbers::pi / 180);
  const Projection projection = makeProjection(shot_.camera, kWidth, kHeight, shot_.scene);
  for (const double side : {0.0, 0.7, -1.1}) {
    draw(frameOf({Vec3f(static_cast<float>(side), 0.3F, 0)}, 1));
    const int x = static_cast<int>(0.5 * kWidth + focal * side / 4),
              y = static_cast<int>(0.5 * kHeight - focal * 0.3 / 4);
    const std::optional<float> depth = target_->depthAt(x, y);
    ASSERT_TRUE(depth.has_value());
    // First root of |t d - c|^2 = r^2 for the ray d through the pixel's middle.
    const Vec3d d((x + 0.5 - 0.5 * kWidth) / focal, (0.5 * kHeight - y - 0.5) / focal, -1), c(side, 0.3, -4);
    const double b = d.dot(c) / d.squaredNorm(), q = (c.squaredNorm() - 0.25) / d.squaredNorm();
    const double front = b - std::sqrt(b * b - q);
    const double near = projection.near, far = projection.far;
    const double expected = (1 / near - 1 / front) / (1 / near - 1 / far);
    EXPECT_NEAR(static_cast<double>(*depth), expected, 2e-6) << "side " << side;
  }
  EXPECT_FALSE(target_->depthAt(2, 2).has_value());
}

TEST_F(OneSphere, NearerOneHidesTheOther) {
  renderer_.emplace(Surroundings{}, makeColorMap());
  shot_.color = ColorField::neighbours;
  shot_.colorRange = {0, 1};
  FrameSnapshot frame = frameOf({Vec3f(0, 0, 0), Vec3f(0, 0, 1), Vec3f(0, 0, -1)}, 0.5F);
  frame.neighbours = {0, 1, 0};
  const Image picture = draw(frame);
  const std::uint8_t* middle = picture.pixel(kWidth / 2, kHeight / 2);
  EXPECT_GT(middle[0], 2 * middle[2]) << "yellow in front of blue";
}

TEST_F(OneSphere, BeyondTheClipPlaneIsHiddenWhole) {
  const Image backdrop = draw(frameOf({}, 1));
  shot_.clip = {true, Axis::z, 0.1};
  const FrameSnapshot behind = frameOf({Vec3f(0, 0, 0.05F)}, 1), before = frameOf({Vec3f(0, 0, 0.15F)}, 1);
  EXPECT_NE(draw(behind).rgba, backdrop.rgba) << "its centre lies behind the plane, so it is drawn whole";
  EXPECT_EQ(draw(before).rgba, backdrop.rgba);
  shot_.camera.eye = {0, 0, -4};
  EXPECT_NE(draw(before).rgba, backdrop.rgba) << "seen from the other side the other half is cut away";
}

TEST_F(OneSphere, NonFiniteParticlesAreLeftOut) {
  const Image backdrop = draw(frameOf({}, 1));
  const float nan = std::nanf("");
  EXPECT_EQ(draw(frameOf({Vec3f(nan, 0, 0), Vec3f(0, INFINITY, 0)}, 1)).rgba, backdrop.rgba);
}

}  // namespace sphere_test
}  // namespace migiwa
