// Hands at a window that is none: they press what they read.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/session/ui_state.h"
#include "tests/render/shown_text.h"

namespace migiwa::testing {

class Hands {
 public:
  /// `frame` draws one.
  explicit Hands(std::function<UiCommands(const InputState&)> frame) : frame_(std::move(frame)) {}

  /// Frames without input.
  void look(int frames = 3) {
    for (int k = 0; k < frames; ++k) take(InputState{});
  }
  /// Moves there, presses, and lets go: the commands of all frames together.
  UiCommands click(float x, float y) { return drag(x, y, x, y); }
  UiCommands drag(float x, float y, float u, float v) {
    all_ = {};
    take(at(x, y, false));
    take(at(x, y, false));
    take(at(x, y, true));
    take(at(0.5F * (x + u), 0.5F * (y + v), true));
    take(at(u, v, true));
    take(at(u, v, false));
    take(at(u, v, false));
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
    InputState input;
    input.control = control, input.shift = shift;
    take(input);
    input.keys[static_cast<std::size_t>(key)] = true;
    take(input);
    take(InputState{});
    return all_;
  }
  UiCommands wheel(float x, float y, float notches, bool control = false) {
    all_ = {};
    InputState input = at(x, y, false);
    input.seconds = 1.0 / 60;
    take(input);
    InputState turned = input;
    turned.wheel = notches;
    turned.control = control;
    take(turned);
    take(input);
    return all_;
  }

 private:
  static InputState at(float x, float y, bool pressed) {
    InputState input;
    input.mouseInside = true;
    input.mouseX = x, input.mouseY = y;
    input.buttons[0] = pressed;
    input.seconds = 0.5;  // no two clicks are a double click
    return input;
  }
  void take(const InputState& input) {
    const UiCommands now = frame_(input);
    all_.play |= now.play, all_.pause |= now.pause, all_.step |= now.step, all_.reset |= now.reset;
    all_.settings |= now.settings, all_.savePicture |= now.savePicture, all_.saveSection |= now.saveSection;
  }

  std::function<UiCommands(const InputState&)> frame_;
  UiCommands all_;
};

}  // namespace migiwa::testing
