// The legend against the colour map itself: its bar has to show every colour, low to high.
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "tests/render/shown_text.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace legend_test {

TEST(LegendTest, ShowsTheWholeMapFromLowToHigh) {
  const auto context = makeEglContext();
  const ColorMap map = makeColorMap();
  Viewer viewer(smallScene(), {}, {1, false, false});
  const FrameSnapshot frame = frameOf({}, 0.1F);
  const Image picture = viewer.takePicture(frame.view(), RunStatus{}, 1280, 720);

  // 255 columns for 256 entries.
  constexpr int kColumns = 255;
  const auto shows = [&](int x, int y, std::size_t entry) {
    const std::uint8_t* p = picture.pixel(x, y);
    return p[0] == map[entry][0] && p[1] == map[entry][1] && p[2] == map[entry][2];
  };
  int rows = 0;
  for (int y = 600; y < 720; ++y) {
    for (int x = 900; x + kColumns <= 1280; ++x) {
      if (!shows(x, y, 0) || !shows(x + kColumns - 1, y, 255)) continue;
      int right = 0;
      for (int i = 0; i < kColumns; ++i) {
        const std::size_t entry = static_cast<std::size_t>(std::lround(255.0 * i / (kColumns - 1)));
        right += shows(x + i, y, entry) ? 1 : 0;
      }
      if (right == kColumns) {
        ++rows;
        break;
      }
    }
  }
  EXPECT_EQ(rows, 12) << "the bar is 12 pixels high";
}

TEST(LegendTest, EveryFieldHasALabelAndARange) {
  for (int i = 0; i < static_cast<int>(kColorFieldNames.size()); ++i) {
    const ColorFieldInfo info = colorFieldInfo(static_cast<ColorField>(i), 6, 1000);
    EXPECT_FALSE(info.label.empty());
    EXPECT_LT(info.low, info.high);
  }
  EXPECT_EQ(colorFieldInfo(ColorField::speed, 6, 1000).unit, "m/s");
  EXPECT_EQ(colorFieldInfo(ColorField::speed, 6, 1000).high, 6);
  EXPECT_DOUBLE_EQ(colorFieldInfo(ColorField::pressure, 6, 1000).high, 18) << "rho v^2 / 2 in kPa";
}

TEST(LegendTest, ASceneMayFixTheRange) {
  const auto context = makeEglContext();
  Scene scene = smallScene();
  scene.view.hasColorRange = true;
  scene.view.colorRange = {0.9, 1.1};
  const Viewer viewer(scene, {}, {1, false, false});
  EXPECT_EQ(viewer.colorRange(scene.view.color), (std::array<double, 2>{0.9, 1.1}));
  EXPECT_NE(viewer.colorRange(ColorField::gamma), (std::array<double, 2>{0.9, 1.1}));
}

TEST(LegendTest, NumbersStandApartAndAreThoseOfTheRange) {
  const auto context = makeEglContext();
  const FrameSnapshot frame = frameOf({}, 0.1F);
  for (const std::array<double, 2>& range :
       {std::array{0.6, 1.2}, std::array{0.0, 0.001}, std::array{-2e-4, 1.1e-3}, std::array{0.0, 3e-7},
        std::array{1.0, 1.00002}, std::array{0.0, 2.3e7}, std::array{-1.0, -0.99}}) {
    Scene scene = smallScene();
    scene.view.hasColorRange = true;
    scene.view.colorRange = range;
    Viewer viewer(scene, {}, {1, false, false});
    viewer.takePicture(frame.view(), RunStatus{}, 1280, 720);
    const std::string text = shownText();
    std::istringstream words(text.substr(text.rfind("/?") + 3));
    double before = -INFINITY;
    int count = 0;
    for (std::string word; words >> word; ++count) {
      std::size_t read = 0;
      const double value = std::stod(word, &read);
      EXPECT_EQ(read, word.size()) << text;
      EXPECT_GT(value, before) << text;
      EXPECT_GE(value, range[0] - 1e-9) << text;
      EXPECT_LE(value, range[1] + 1e-9) << text;
      before = value;
    }
    EXPECT_GE(count, 2) << text;
  }
}

}  // namespace legend_test
}  // namespace migiwa
