// How finely the scene is drawn while things move: where drawing is slow a frame comes within its time and
// stays there, and what is at rest is whole, to the pixel.
#include <set>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "tests/render/image_compare.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace detail_test {

/// The shares of the last of many frames that cost so much.
std::set<double> settled(double fixed, double whole) {
  SceneDetail detail;
  std::set<double> last;
  for (int k = 0; k < 400; ++k) {
    const double share = detail.share(true);
    if (k >= 200) last.insert(share);
    detail.drawn(true, fixed + whole * share * share);
  }
  EXPECT_EQ(detail.share(false), 1);
  return last;
}

TEST(SceneDetail, SlowFramesComeWithinTheirTimeAndStayThere) {
  for (const double whole : {0.03, 0.06, 0.09}) {
    const std::set<double> shares = settled(0.004, whole);
    ASSERT_EQ(shares.size(), 1U) << whole << " s: it goes to and fro";
    const double share = *shares.begin();
    EXPECT_LE(0.004 + whole * share * share, SceneDetail::kBudget) << whole;
    EXPECT_GT(0.004 + whole * share * share, 0.3 * SceneDetail::kBudget)
        << whole << " s: coarser than it has to be";
  }
}

TEST(SceneDetail, QuickFramesAreWhole) {
  EXPECT_EQ(settled(0.001, 0.01), std::set<double>{1});
}

TEST(SceneDetail, OneFrameThatWasHeldUpChangesNothing) {
  SceneDetail detail;
  for (int k = 0; k < 20; ++k) detail.drawn(true, k == 10 ? 0.04 : 0.008);
  EXPECT_EQ(detail.share(true), 1);
}

class ReducedScene : public ::testing::Test {
 protected:
  static constexpr int kWidth = 800, kHeight = 600;

  Image draw(const SceneDrawing& drawing, const InputState& input = {}) {
    viewer_.frame(frame_.view(), {}, input, kWidth, kHeight, drawing);
    return viewer_.picture();
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  FrameSnapshot frame_ = frameOf({Vec3f(0.5F, 0.4F, 0.25F)}, 0.1F);
  Viewer viewer_{smallScene(), Simulation(smallScene(), 1).walls(), {1, true, false}};
};

TEST_F(ReducedScene, IsCoarserInTheSceneAlone) {
  const Image whole = draw({});
  const Image reduced = draw({0.5, {}});
  EXPECT_EQ(viewer_.sceneShare(), 0.5);
  const Rect area = viewer_.area();
  int panels = 0, scene = 0, far = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(whole.pixel(x, y)[c] - reduced.pixel(x, y)[c]));
      (x < area.x ? panels : scene) += most > 0;
      far += most > 96;
    }
  EXPECT_EQ(panels, 0);
  EXPECT_GT(scene, 0);
  EXPECT_LT(far, kWidth * kHeight / 50) << "it is where it was";
  EXPECT_EQ(draw({}).rgba, whole.rgba);
}

TEST_F(ReducedScene, WhatHasNotChangedIsNotDrawnAnew) {
  const Image whole = draw({1, 7});
  EXPECT_TRUE(viewer_.drewScene());
  EXPECT_EQ(draw({0.5, 7}).rgba, whole.rgba) << "it stays as fine as it is";
  EXPECT_FALSE(viewer_.drewScene());
  viewer_.view().camera.eye.x() += 0.1;
  draw({0.5, 7});
  EXPECT_TRUE(viewer_.drewScene());
  EXPECT_EQ(viewer_.sceneShare(), 0.5);
  viewer_.view().camera.eye.x() -= 0.1;
  EXPECT_EQ(draw({1, 7}).rgba, whole.rgba);
  EXPECT_TRUE(viewer_.drewScene());
  draw({1, 8});
  EXPECT_TRUE(viewer_.drewScene()) << "another frame";
  draw({1, {}});
  EXPECT_TRUE(viewer_.drewScene());
}

TEST_F(ReducedScene, APictureThatIsKeptIsWhole) {
  const Image whole = draw({});
  EXPECT_NE(draw({0.5, 7}).rgba, whole.rgba);
  InputState input;
  input.keys[static_cast<std::size_t>(Key::p)] = true;
  EXPECT_EQ(draw({0.5, 7}, input).rgba, whole.rgba);
  EXPECT_NE(draw({0.5, 7}).rgba, whole.rgba);
}

}  // namespace detail_test
}  // namespace migiwa
