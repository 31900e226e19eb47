// Particles that are selected by a rectangle: those that a pinhole camera has in it; their spread and their
// table are those of the state, read by other means.
#include "app/session/selection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/simulation/simulation.h"
#include "tests/render/window_over_scene.h"

namespace migiwa {
namespace selection_test {

class Selection : public WindowOverScene {
 protected:
  Selection() : WindowOverScene("selection") {}

  const SelectionModel& selection() const { return window_->selection(); }

  /// Which ids a pinhole camera has between the pixels, by its eye, its target and its field of view.
  std::vector<std::uint32_t> inside(double left, double top, double right, double bottom) {
    const Camera& camera = view().camera;
    const Rect area = window_->viewer().area();
    const Vec3d ahead = (camera.target - camera.eye).normalized(), side = ahead.cross(camera.up).normalized(),
                up = side.cross(ahead);
    // Pixels to one unit at distance 1: panels take from the width, not from what is seen across.
    const double pixels =
        0.5 * area.width * kHeight / (std::tan(camera.fovDegrees * std::numbers::pi / 360) * kWidth);
    std::vector<std::uint32_t> ids;
    const FrameView frame = window_->frame();
    for (std::size_t k = 0; k < frame.positions.size(); ++k) {
      const Vec3d arm = frame.positions[k].xyz().cast<double>() - camera.eye;
      const double x = area.x + 0.5 * area.width + pixels * arm.dot(side) / arm.dot(ahead);
      const double y = area.y + 0.5 * area.height - pixels * arm.dot(up) / arm.dot(ahead);
      if (x > left && x < right && y > top && y < bottom) ids.push_back(frame.ids[k]);
    }
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  void openPanel() {
    hands_.look();
    if (!placeOfText("Selected")) hands_.clickOn("Particles");
    hands_.look();
    ASSERT_TRUE(placeOfText("Selected")) << shownText();
  }
  void selectByKey(float x, float y, float u, float v) {
    InputState input;
    input.mouseInside = input.control = true;
    input.seconds = 0.5;
    const auto take = [&](float px, float py, bool down) {
      input.mouseX = px, input.mouseY = py, input.buttons[0] = down;
      frame(input);
    };
    take(x, y, false), take(x, y, true), take(0.5F * (x + u), v, true), take(u, v, true), take(u, v, false);
    hands_.look();
  }
  static std::vector<double> numbers(const std::string& line) {
    std::vector<double> values;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) values.push_back(std::stod(cell));
    return values;
  }
};

TEST_F(Selection, HasWhatAPinholeCameraHasInTheRectangle) {
  open();
  step(12);
  openPanel();
  const Camera camera = view().camera;
  const Rect area = window_->viewer().area();
  const auto x = static_cast<float>(area.x + area.width / 2), y = static_cast<float>(area.height / 2);
  const auto px = static_cast<double>(x), py = static_cast<double>(y);
  hands_.clickOn("Select");
  hands_.drag(x - 90.25F, y - 60.25F, x + 40.75F, y + 80.75F);
  hands_.look();
  const std::vector<std::uint32_t> first = selection().ids;
  EXPECT_GT(first.size(), 20U);
  EXPECT_LT(first.size(), window_->frame().positions.size());
  EXPECT_EQ(first, inside(px - 90.25, py - 60.25, px + 40.75, py + 80.75));
  EXPECT_EQ(view().camera, camera) << "the view is not turned";
  EXPECT_NE(shownText().find(std::to_string(first.size()) + " of "), std::string::npos) << shownText();
  // By the key, from another corner; the tool is for one rectangle.
  selectByKey(x + 70.25F, y + 90.75F, x - 20.75F, y + 10.25F);
  EXPECT_EQ(selection().ids, inside(px - 20.75, py + 10.25, px + 70.25, py + 90.75));
  hands_.drag(x, y, x + 60, y + 20);
  EXPECT_NE(view().camera, camera) << "and then it is turned again";
  hands_.clickOn("Clear");
  EXPECT_TRUE(selection().ids.empty());
}

TEST_F(Selection, LeavesWhatIsCutAwayAndFollowsItsParticles) {
  open();
  step(4);
  view().clip = {.enabled = true, .axis = Axis::z, .at = 0.25};
  hands_.look();
  const Rect area = window_->viewer().area();
  selectByKey(static_cast<float>(area.x + 2), 2, static_cast<float>(area.x + area.width - 2),
              static_cast<float>(area.height - 2));
  std::set<std::uint32_t> behind;
  const FrameView frame = window_->frame();
  for (std::size_t k = 0; k < frame.positions.size(); ++k)
    if (frame.positions[k].xyz().z() <= 0.25F) behind.insert(frame.ids[k]);
  EXPECT_EQ(std::set(selection().ids.begin(), selection().ids.end()), behind);
  const std::vector<std::uint32_t> ids = selection().ids;
  step(10);
  EXPECT_EQ(selection().ids, ids);
  hands_.press(Key::escape);
  hands_.look();
  EXPECT_TRUE(selection().ids.empty());
}

TEST_F(Selection, ItsTableIsThatOfAnotherRunOfTheScene) {
  open();
  view().color = ColorField::pressure;
  hands_.look();
  step(9);
  openPanel();
  const Rect area = window_->viewer().area();
  const auto x = static_cast<float>(area.x + area.width / 2), y = static_cast<float>(area.height / 2);
  selectByKey(x - 80, y - 50, x + 80, y + 90);
  const std::vector<std::uint32_t> ids = selection().ids;
  ASSERT_GT(ids.size(), 20U);
  const std::filesystem::path file = folder_ / "some.csv";
  hands_.clickOn("particles.csv");
  hands_.press(Key::a, true);
  InputState typed;
  for (const char c : file.string()) typed.characters.push_back(static_cast<unsigned>(c));
  frame(typed);
  hands_.clickOn("CSV of particles");
  await([&] { return !window_->busy(); });
  EXPECT_NE(selection().note.find(std::to_string(ids.size()) + " particles of 0.045 s in " + file.string()),
            std::string::npos)
      << selection().note;

  Simulation again(readScene(file_), 1);
  again.watchPressure(true);
  for (int k = 0; k < 9; ++k) again.advanceFrame();
  const FrameView frame = again.view();
  ASSERT_EQ(frame.info.stateHash, window_->frame().info.stateHash);
  std::istringstream in(readTextFile(file, "a table"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line,
            "id,x (m),y (m),z (m),vx (m/s),vy (m/s),vz (m/s),speed (m/s),density (1),gamma (1),lambda (1),"
            "neighbours (1),pressure (Pa)");
  std::size_t row = 0;
  for (; std::getline(in, line); ++row) {
    const std::vector<double> cells = numbers(line);
    ASSERT_EQ(cells.size(), 13U);
    ASSERT_EQ(cells[0], ids[row]);
    const auto k =
        static_cast<std::size_t>(std::find(frame.ids.begin(), frame.ids.end(), ids[row]) - frame.ids.begin());
    const Float4 &p = frame.positions[k], &v = frame.velocities[k];
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(static_cast<float>(cells[static_cast<std::size_t>(1 + axis)]), p.xyz()[axis]);
      EXPECT_EQ(static_cast<float>(cells[static_cast<std::size_t>(4 + axis)]), v.xyz()[axis]);
    }
    EXPECT_NEAR(cells[7], static_cast<double>(v.xyz().norm()), 1e-6);
    EXPECT_EQ(static_cast<float>(cells[8]), frame.density[k]);
    EXPECT_EQ(static_cast<float>(cells[9]), frame.gamma[k]);
    EXPECT_EQ(static_cast<float>(cells[10]), frame.lambda[k]);
    EXPECT_EQ(cells[11], frame.neighbours[k]);
    EXPECT_EQ(static_cast<float>(cells[12]), frame.pressure[k]);
  }
  EXPECT_EQ(row, ids.size());

  // A folder that is not there.
  const auto name = placeOfWidget("File");
  ASSERT_TRUE(name);
  hands_.click((*name)[0], (*name)[1]);
  hands_.press(Key::a, true);
  typed.characters = {'/', 'n', 'o', 'n', 'e', '/', 'x'};
  this->frame(typed);
  hands_.clickOn("CSV of particles");
  await([&] { return !window_->busy(); });
  EXPECT_TRUE(selection().note.starts_with("Not written: ")) << selection().note;
}

TEST_F(Selection, SpreadIsThatOfTheFieldAsItIsChosen) {
  open();
  step(6);
  openPanel();
  hands_.choose("Spread of", "vy");
  hands_.look();
  ASSERT_EQ(selection().field, ParticleValue::vy);
  ASSERT_TRUE(selection().spread);
  const FieldSpread& spread = *selection().spread;
  const FrameView frame = window_->frame();
  EXPECT_EQ(spread.count, frame.positions.size()) << "all, where none are selected";
  double sum = 0;
  for (const Float4& v : frame.velocities) sum += static_cast<double>(v.xyz().y());
  EXPECT_NEAR(spread.mean, sum / static_cast<double>(spread.count), 1e-9);
  EXPECT_NE(shownText().find(formatNumber("%.5g", spread.mean)), std::string::npos) << shownText();
  std::size_t counted = 0;
  for (const std::size_t bin : spread.bins) counted += bin;
  EXPECT_EQ(counted, spread.count);
}

TEST(FieldSpread, OfKnownValues) {
  // 0, 1, ..., 63: two to a bin; the mean square deviation of n whole numbers in a row is (n^2 - 1) / 12.
  std::vector<double> values;
  for (int k = 0; k < 64; ++k) values.push_back(k);
  values.push_back(std::nan(""));
  const FieldSpread spread = spreadOf(values);
  EXPECT_EQ(spread.count, 64U);
  EXPECT_EQ(spread.least, 0);
  EXPECT_EQ(spread.largest, 63);
  EXPECT_DOUBLE_EQ(spread.mean, 31.5);
  EXPECT_NEAR(spread.deviation, std::sqrt((64.0 * 64 - 1) / 12), 1e-12);
  for (const std::size_t bin : spread.bins) EXPECT_EQ(bin, 2U);
  EXPECT_EQ(spreadOf(std::vector<double>(5, 2.0)).bins[0], 5U) << "a constant";
  EXPECT_EQ(spreadOf({}).count, 0U);
}

}  // namespace selection_test
}  // namespace migiwa
