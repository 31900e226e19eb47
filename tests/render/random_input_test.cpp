// Frames under input drawn at random, on a simulation that does what is asked for: whatever a person does, no
// number is shown that is not finite, the time shown is the simulation's, and what was done has had effects.
// The real window is driven from outside, by drive_window.py.
#include <algorithm>
#include <cctype>
#include <random>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "core/base/messages.h"
#include "core/simulation/simulation.h"
#include "tests/render/shown_text.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace random_input_test {

constexpr int kWidth = 420, kHeight = 900, kFrames = 120;

bool showsNonFinite(const std::string& text) {
  std::string word;
  for (const char c : text + ' ') {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += c;
    } else if (word == "nan" || word == "inf") {
      return true;
    } else {
      word.clear();
    }
  }
  return false;
}

/// Only the engine's bits are used, for distributions differ between libraries.
class Hands {
 public:
  explicit Hands(unsigned seed) : engine_(seed) {}

  InputState next() {
    input_.mouseInside = true;
    input_.wheel = 0;
    input_.keys = {};
    input_.characters.clear();
    const bool moves = chance(3);
    if (moves && input_.buttons[0] && chance(2)) {
      input_.mouseX += static_cast<float>(below(200)) - 100;
    } else if (moves) {
      input_.mouseX = static_cast<float>(below(chance(4) ? kWidth : kWidth / 2));
      input_.mouseY = static_cast<float>(below(kHeight));
    }
    if (chance(2)) input_.buttons[0] = !input_.buttons[0];
    if (chance(8)) input_.buttons[1 + below(2)] ^= true;
    if (chance(6)) input_.wheel = static_cast<float>(below(21)) - 10;
    if (chance(5)) input_.keys[below(kKeyCount)] = true;
    if (chance(5)) input_.characters.push_back('0' + below(10));
    input_.control = chance(10);
    return input_;
  }

 private:
  unsigned below(std::size_t count) { return static_cast<unsigned>(engine_() % count); }
  bool chance(unsigned ofHowMany) { return below(ofHowMany) == 0; }

  std::mt19937 engine_;
  InputState input_;
};

class Session : public ::testing::Test {
 protected:
  /// As the simulation's thread would, but at once.
  void applyRequest(const UiCommands& commands) {
    if (commands.reset) simulation_ = std::make_unique<Simulation>(scene_, 1), run_ = {};
    if (commands.reset || commands.settings) simulation_->apply(viewer_.settings());
    if (commands.play) run_.playing = !run_.stopped;
    if (commands.pause || commands.step) run_.playing = false;
    if ((run_.playing || commands.step) && !run_.stopped) simulation_->advanceFrame();
    run_.stopped = simulation_->stopped();
    if (run_.stopped) run_.playing = false;
    frame_.assign(simulation_->drawnView());
  }
  UiCommands frame(const InputState& input) {
    return viewer_.frame(frame_.view(), run_, input, kWidth, kHeight);
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  Scene scene_ = smallScene();
  std::unique_ptr<Simulation> simulation_ = std::make_unique<Simulation>(scene_, 1);
  FrameSnapshot frame_;
  RunStatus run_;
  Viewer viewer_{scene_, simulation_->walls(), {0.8, true, true}};
};

using RandomInput = Session;

TEST_F(RandomInput, ShowsFiniteNumbersAndHasEffects) {
  run_.playing = true;
  applyRequest({});
  double latest = 0;
  bool turned = false, changed = false;
  for (const unsigned seed : {1U, 2U}) {
    Hands hands(seed);
    for (int k = 0; k < kFrames; ++k) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", frame " << k);
      const double time = frame_.info.time;
      const UiCommands commands = frame(hands.next());
      applyRequest(commands);
      const std::string text = shownText();
      ASSERT_NE(text.find(formatNumber("%.3f s", time)), std::string::npos) << time << ": " << text;
      ASSERT_FALSE(showsNonFinite(text)) << text;
      const ViewState& view = viewer_.view();
      ASSERT_TRUE(view.camera.eye.allFinite() && view.camera.target.allFinite() &&
                  std::isfinite(view.clip.at));
      latest = std::max(latest, time);
      turned |= view.camera != scene_.view.camera;
      changed |= commands.settings;
    }
  }
  EXPECT_GT(latest, 0.01) << "the simulation never went on";
  EXPECT_TRUE(turned) << "the camera has stayed where it was";
  EXPECT_TRUE(changed) << "no setting was changed";
}

/// What the test above would miss if it could not read.
using ShownText = Session;

TEST_F(ShownText, HoldsWhatPanelsSay) {
  run_ = {false, true, "a speed of -nan m/s"};
  applyRequest({});
  run_.stopped = true;
  frame(InputState{});
  const std::string text = shownText();
  for (const char* word : {"Simulation", "Reset", "Max", "iterations", "-nan"})
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
  EXPECT_TRUE(showsNonFinite(text));
}

}  // namespace random_input_test
}  // namespace migiwa
