#include "app/viewer/hands.h"

namespace migiwa {
namespace {

InputState mouseAt(const Hands::Place& place, const Hands::Held& held = {}, bool pressed = false) {
  InputState input;
  input.mouseInside = true;
  input.mouseX = place[0], input.mouseY = place[1];
  input.buttons[static_cast<std::size_t>(held.button)] = pressed;
  input.control = held.control, input.shift = held.shift;
  input.seconds = 0.5;  // no two clicks are a double click
  return input;
}

}  // namespace

void Hands::look(int frames) {
  for (int k = 0; k < frames; ++k) frame_(InputState{});
}

void Hands::moveTo(const Place& place) {
  // A widget is under the mouse from the frame after it was laid out, and the first place points at nothing.
  for (const float aside : {1.0F, 0.0F, 0.0F}) frame_(mouseAt({place[0] + aside, place[1]}));
}

void Hands::doubleClick(const Place& place) {
  moveTo(place);
  for (const bool pressed : {true, false, true, false}) {
    InputState input = mouseAt(place, {}, pressed);
    input.seconds = 0.05;
    frame_(input);
  }
}

void Hands::drag(const Place& from, const Place& to, const Held& held) {
  const Place middle{0.5F * (from[0] + to[0]), 0.5F * (from[1] + to[1])};
  frame_(mouseAt(from, held));
  frame_(mouseAt(from, held));
  frame_(mouseAt(from, held, true));
  frame_(mouseAt(middle, held, true));
  frame_(mouseAt(to, held, true));
  frame_(mouseAt(to, held));
  frame_(mouseAt(to, held));
}

void Hands::press(Key key, const Held& held) {
  InputState input;
  input.control = held.control, input.shift = held.shift;
  frame_(input);
  input.keys[static_cast<std::size_t>(key)] = true;
  frame_(input);
  frame_(InputState{});
}

void Hands::type(const std::string& text) {
  InputState input;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // UTF-8: the first byte of a letter has as many leading ones as the letter has bytes.
    if ((byte & 0xC0U) == 0x80U && !input.characters.empty())
      input.characters.back() = input.characters.back() << 6U | (byte & 0x3FU);
    else
      input.characters.push_back(byte < 0x80U ? byte
                                              : byte & (byte < 0xE0U   ? 0x1FU
                                                        : byte < 0xF0U ? 0xFU
                                                                       : 7U));
  }
  frame_(input);
  frame_(InputState{});
}

void Hands::wheel(const Place& place, float notches, const Held& held) {
  InputState input = mouseAt(place);
  input.seconds = 1.0 / 60;
  frame_(input);
  InputState turned = input;
  turned.wheel = notches;
  turned.control = held.control;
  frame_(turned);
  frame_(input);
}

}  // namespace migiwa
