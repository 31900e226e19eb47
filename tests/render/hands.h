// Hands that press what they read, and say what was asked for by it.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/session/ui_state.h"
#include "app/viewer/hands.h"
#include "tests/render/shown_text.h"

namespace migiwa::testing {

class Hands {
 public:
  /// `frame` draws one.
  explicit Hands(std::function<UiCommands(const InputState&)> frame)
      : frame_(std::move(frame)), hands_([this](const InputState& input) { take(input); }) {}
  Hands(const Hands&) = delete;
  Hands& operator=(const Hands&) = delete;

  /// Frames without input.
  void look(int frames = 3) { hands_.look(frames); }
  /// Moves there, presses, and lets go: the commands of all frames together.
  UiCommands click(float x, float y) { return drag(x, y, x, y); }
  UiCommands drag(float x, float y, float u, float v) {
    all_ = {};
    hands_.drag({x, y}, {u, v}, {});
    return all_;
  }
  /// The widget that bears these words, or lies so far beside them (pixels).
  UiCommands clickOn(const std::string& words, float beside = 0) {
    look();
    const auto place = placeOfText(words);
    if (!place) {
      ADD_FAILURE() << words << " is not in: " << shownText();
      return {};
    }
    return click((*place)[0] + beside, (*place)[1]);
  }
  /// Opens the list beside the words, and picks an entry.
  UiCommands choose(const std::string& words, const std::string& entry, float beside = 110) {
    clickOn(words, beside);
    return clickOn(entry);
  }
  UiCommands press(Key key, bool control = false, bool shift = false) {
    all_ = {};
    hands_.press(key, {control, shift});
    return all_;
  }
  UiCommands wheel(float x, float y, float notches, bool control = false) {
    all_ = {};
    hands_.wheel({x, y}, notches, {control});
    return all_;
  }

 private:
  void take(const InputState& input) {
    const UiCommands now = frame_(input);
    all_.play |= now.play, all_.pause |= now.pause, all_.step |= now.step, all_.reset |= now.reset;
    all_.settings |= now.settings, all_.savePicture |= now.savePicture, all_.saveSection |= now.saveSection;
  }

  std::function<UiCommands(const InputState&)> frame_;
  UiCommands all_;
  migiwa::Hands hands_;
};

}  // namespace migiwa::testing
