// Keys and mouse: every line of the list does what it says, and the list is shown where it is asked for.
#include "app/ui/bindings.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/commands/command.h"
#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "tests/render/hands.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace bindings_test {

constexpr int kWidth = 1280, kHeight = 720;

class Bindings : public ::testing::Test {
 protected:
  Bindings() {
    run_.line.branches = {{.number = 3, .name = "run", .from = 0.1, .until = 0.4, .kept = {0.1}}};
    run_.line.branch = 3;
    hands_.look();
  }
  UiCommands frame(const InputState& input) {
    const UiCommands now = viewer_.frame(frame_.view(), run_, input, kWidth, kHeight);
    stepBack_ |= now.stepBack;
    if (now.goTo) goTo_ = now.goTo;
    return now;
  }
  UiCommands press(const KeyBinding& binding) {
    stepBack_ = false;
    goTo_.reset();
    if (binding.key) return hands_.press(*binding.key, binding.control, binding.shift.value_or(false));
    InputState input;
    input.characters = {static_cast<unsigned>(binding.character)};
    frame(input);
    hands_.look();
    return {};
  }
  BoundaryHandling handling() const { return viewer_.settings().boundary.handling; }
  static std::string letters(std::string text) {
    std::erase(text, ' ');
    return text;
  }
  static bool isListed() { return shownText().find("Keys and mouse") != std::string::npos; }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  FrameSnapshot frame_ = frameOf({Vec3f(0.5F, 0.4F, 0.25F)}, 0.1F);
  RunStatus run_;
  InspectModel inspect_;
  SectionModel section_;
  SelectionModel selection_;
  Viewer viewer_{smallScene(), {}, {.inspect = &inspect_, .section = &section_, .selection = &selection_}};
  testing::Hands hands_{[this](const InputState& input) { return frame(input); }};
  bool stepBack_ = false;
  std::optional<TimePlace> goTo_;
};

TEST_F(Bindings, EveryKeyOfTheListDoesWhatItSays) {
  std::set<KeyAction> tried;
  for (const KeyBinding& binding : keyBindings()) {
    SCOPED_TRACE(nameOf(binding) + ": " + std::string(binding.does));
    const BoundaryHandling before = handling();
    const bool panels = viewer_.view().panels, listed = isListed();
    const bool corrected = binding.action == KeyAction::undo || binding.action == KeyAction::redo;
    if (corrected) hands_.press(Key::c);
    const BoundaryHandling changed = handling();
    if (binding.action == KeyAction::redo) hands_.press(Key::z, true);
    if (binding.action == KeyAction::close) inspect_.id = 0;
    const UiCommands asked = press(binding);
    switch (binding.action) {
      case KeyAction::playOrPause:
        EXPECT_TRUE(asked.play);
        run_.playing = true;
        EXPECT_TRUE(press(binding).pause);
        run_.playing = false;
        break;
      case KeyAction::step:
        EXPECT_TRUE(asked.step);
        break;
      case KeyAction::stepBack:
        EXPECT_TRUE(stepBack_);
        break;
      case KeyAction::toStart:
        ASSERT_TRUE(goTo_);
        EXPECT_EQ(goTo_->branch, 3);
        EXPECT_EQ(goTo_->time, 0.1);
        break;
      case KeyAction::toEnd:
        ASSERT_TRUE(goTo_);
        EXPECT_EQ(goTo_->time, 0.4);
        break;
      case KeyAction::reset:
        EXPECT_TRUE(asked.reset);
        break;
      case KeyAction::correct:
        EXPECT_TRUE(asked.settings);
        EXPECT_NE(handling(), before);
        break;
      case KeyAction::panels:
        EXPECT_NE(viewer_.view().panels, panels);
        press(binding);
        EXPECT_EQ(viewer_.view().panels, panels);
        break;
      case KeyAction::picture:
        EXPECT_TRUE(asked.savePicture);
        break;
      case KeyAction::undo:
        EXPECT_NE(changed, before);
        EXPECT_EQ(handling(), before);
        break;
      case KeyAction::redo:
        EXPECT_NE(changed, before);
        EXPECT_EQ(handling(), changed);
        break;
      case KeyAction::close:
        EXPECT_FALSE(inspect_.id);
        break;
      case KeyAction::keys:
        EXPECT_NE(isListed(), listed);
        press(binding);
        hands_.look();
        EXPECT_EQ(isListed(), listed);
        break;
    }
    tried.insert(binding.action);
  }
  EXPECT_EQ(tried.size(), static_cast<std::size_t>(KeyAction::keys) + 1) << "an action without a key";
}

TEST_F(Bindings, NoTwoLinesAskForTheSamePress) {
  for (const KeyBinding& binding : keyBindings()) {
    InputState now;
    now.control = binding.control, now.shift = binding.shift.value_or(false);
    if (binding.key)
      now.keys[static_cast<std::size_t>(*binding.key)] = true;
    else
      now.characters = {static_cast<unsigned>(binding.character)};
    EXPECT_EQ(pressedActions({}, now), std::vector{binding.action}) << nameOf(binding);
    EXPECT_FALSE(nameOf(binding).ends_with("+ ")) << "a key without a name";
    EXPECT_FALSE(nameOf(binding).empty());
  }
}

TEST_F(Bindings, EveryGestureOfTheListDoesWhatItSays) {
  const Rect area = viewer_.area();
  const auto x = static_cast<float>(area.x + area.width / 2), y = static_cast<float>(area.height / 2);
  const Camera start = viewer_.view().camera;
  const auto gesture = [&](const MouseBinding& binding) {
    InputState input;
    input.seconds = binding.gesture == MouseGesture::doubleClick ? 0.05 : 0.5;
    input.control = binding.control.value_or(false), input.shift = binding.shift.value_or(false);
    input.mouseInside = true;
    input.mouseX = x, input.mouseY = y;
    const auto hold = [&](bool down) {
      input.buttons[static_cast<std::size_t>(binding.button.value_or(MouseButton::left))] = down;
      frame(input);
    };
    frame(input);
    input.mouseX += 1;
    frame(input);
    const int clicks = binding.gesture == MouseGesture::doubleClick ? 2 : 1;
    for (int k = 0; binding.button && k < clicks; ++k) {
      hold(true);
      if (binding.gesture == MouseGesture::drag) input.mouseX += 60, input.mouseY += 60, frame(input);
      hold(false);
    }
    if (binding.gesture == MouseGesture::wheel) {
      input.wheel = 1;
      frame(input);
      input.wheel = 0;
      frame(input);
    }
  };
  std::set<MouseAction> tried;
  for (const MouseBinding& binding : mouseBindings()) {
    SCOPED_TRACE(nameOf(binding) + ": " + std::string(binding.does));
    viewer_.view().camera = start;
    viewer_.view().camera.target = {0.45, 0.42, 0.25};
    inspect_ = {};
    InputState away;
    away.seconds = 1;
    frame(away);
    if (binding.action == MouseAction::select || binding.action == MouseAction::lookAt)
      viewer_.view().camera.target = {0.48, 0.42, 0.25};
    if (binding.action == MouseAction::pick || binding.action == MouseAction::point)
      viewer_.view().camera.target = {0.5, 0.4, 0.25};
    viewer_.view().section.shown = binding.action == MouseAction::moveSection;
    const Camera before = viewer_.view().camera;
    const double at = viewer_.view().section.at;
    selection_ = {};
    gesture(binding);
    const Camera& now = viewer_.view().camera;
    const double range = (before.eye - before.target).norm();
    switch (binding.action) {
      case MouseAction::turn:
        EXPECT_EQ(now.target, before.target);
        EXPECT_NEAR((now.eye - now.target).norm(), range, 1e-9);
        EXPECT_GT((now.eye - before.eye).norm(), 0.05);
        break;
      case MouseAction::move:
        EXPECT_GT((now.target - before.target).norm(), 0.01);
        EXPECT_LT(((now.eye - now.target) - (before.eye - before.target)).norm(), 1e-9);
        break;
      case MouseAction::select:
        EXPECT_EQ(selection_.ids.size(), 1U);
        EXPECT_EQ(now, before);
        break;
      case MouseAction::zoom:
        EXPECT_LT((now.eye - now.target).norm(), 0.95 * range);
        break;
      case MouseAction::lookAt:
        EXPECT_GT((now.target - before.target).norm(), 0.01);
        break;
      case MouseAction::moveSection:
        EXPECT_NE(viewer_.view().section.at, at);
        EXPECT_EQ(now, before);
        break;
      case MouseAction::pick:
        EXPECT_TRUE(inspect_.id);
        break;
      case MouseAction::point:
        EXPECT_TRUE(inspect_.hovered);
        break;
    }
    tried.insert(binding.action);
  }
  EXPECT_EQ(tried.size(), static_cast<std::size_t>(MouseAction::point) + 1) << "an action without a gesture";
}

TEST_F(Bindings, AreListedInTheWindowAndByHelp) {
  EXPECT_FALSE(isListed());
  hands_.press(Key::f1);
  hands_.look();
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(runCommandLine({"view", "--help"}), kDone);
  const std::string help = ::testing::internal::GetCapturedStdout(), shown = shownText();
  const auto expectListed = [&](const auto& binding) {
    const std::string name = nameOf(binding), does(binding.does);
    // Letters that touch are read as one word, and those of "r t" may.
    EXPECT_NE(letters(shown).find(letters(name + does)), std::string::npos) << name << " is not in " << shown;
    const std::size_t at = help.find("\n  " + name + "  ");
    ASSERT_NE(at, std::string::npos) << name << " is not in " << help;
    EXPECT_NE(help.find(does, at), std::string::npos) << does;
  };
  for (const KeyBinding& binding : keyBindings()) expectListed(binding);
  for (const MouseBinding& binding : mouseBindings()) expectListed(binding);
  hands_.press(Key::escape);
  hands_.look();
  EXPECT_FALSE(isListed());
}

}  // namespace bindings_test
}  // namespace migiwa
