// What keys and the mouse over the picture do, as app/ui/bindings.h lists it.
#include <cmath>
#include <numbers>

#include "app/ui/bindings.h"
#include "app/viewer/viewer.h"

namespace migiwa {
namespace {

constexpr double kDoubleClickSeconds = 0.3;

/// The button of the drag that is under way, if any.
std::optional<MouseButton> heldButton(const InputState& input) {
  for (const MouseButton button : {MouseButton::right, MouseButton::middle, MouseButton::left})
    if (input.down(button)) return button;
  return std::nullopt;
}

}  // namespace

void Viewer::moveCamera(const InputState& input, const Rect& area) {
  const std::optional<MouseButton> held = heldButton(input);
  const bool pressed = input.down(MouseButton::left) && !last_.down(MouseButton::left);
  const bool free = contains(area, input) && !ui_.wantsMouse();
  if (!held) draggingScene_ = false;
  const bool dragged = draggingScene_;
  if (held && !draggingScene_ && free) draggingScene_ = true;

  sinceClick_ += input.seconds;
  if (pressed && free) {
    doubleClicked_ = sinceClick_ < kDoubleClickSeconds;
    if (doubleClicked_ &&
        actionOf(MouseGesture::doubleClick, MouseButton::left, input) == MouseAction::lookAt) {
      const auto point = pointAt(static_cast<int>(input.mouseX), static_cast<int>(input.mouseY), area);
      if (point) lookAt(view_.camera, *point);
    }
    sinceClick_ = 0;
  }

  const double dx = static_cast<double>(input.mouseX - last_.mouseX) / area.height;
  const double dy = static_cast<double>(input.mouseY - last_.mouseY) / area.height;
  const std::optional<MouseAction> drag =
      dragged && !selectingFrom_ ? actionOf(MouseGesture::drag, held, input) : std::nullopt;
  if (drag == MouseAction::turn) orbit(view_.camera, std::numbers::pi * dx, std::numbers::pi * dy);
  if (drag == MouseAction::move) {
    // What lies at the target's distance follows the mouse.
    const double height = 2 * (view_.camera.eye - view_.camera.target).norm() *
                          std::tan(view_.camera.fovDegrees * std::numbers::pi / 360);
    pan(view_.camera, dx * height, -dy * height);
  }
  if (free && input.wheel != 0 && !wheelMovesSection(input))
    zoom(view_.camera, std::pow(0.9, static_cast<double>(input.wheel)));
}

bool Viewer::wheelMovesSection(const InputState& input) const {
  return options_.section != nullptr && view_.section.shown &&
         actionOf(MouseGesture::wheel, std::nullopt, input) == MouseAction::moveSection;
}

void Viewer::keys(const InputState& input, const RunStatus& run, UiCommands& commands) {
  const TimeLineView::Branch* const branch = run.line.present();
  for (const KeyAction action : pressedActions(last_, input)) {
    switch (action) {
      case KeyAction::playOrPause:
        (run.playing ? commands.pause : commands.play) = true;
        break;
      case KeyAction::step:
        commands.step = true;
        break;
      case KeyAction::stepBack:
        commands.stepBack = true;
        break;
      case KeyAction::toStart:
        if (branch != nullptr) commands.goTo = {branch->number, branch->from};
        break;
      case KeyAction::toEnd:
        if (branch != nullptr) commands.goTo = {branch->number, branch->until};
        break;
      case KeyAction::reset:
        commands.reset = true;
        break;
      case KeyAction::correct: {
        BoundaryHandling& handling = settings_.boundary.handling;
        handling = handling == BoundaryHandling::gamma ? BoundaryHandling::none : BoundaryHandling::gamma;
        commands.settings = true;
        break;
      }
      case KeyAction::panels:
        view_.panels = !view_.panels;
        break;
      case KeyAction::picture:
        commands.savePicture = true;
        break;
      case KeyAction::undo:
        commands.undo = 1;
        break;
      case KeyAction::redo:
        commands.undo = -1;
        break;
      case KeyAction::close:
        close();
        break;
      case KeyAction::keys:
        commands.listKeys = true;
        break;
    }
  }
}

/// What lies uppermost.
void Viewer::close() {
  if (listsKeys_)
    listsKeys_ = false;
  else if (options_.command != nullptr && options_.command->open)
    options_.command->open = false;
  else if (options_.inspect != nullptr && options_.inspect->id)
    options_.inspect->id.reset();
  else if (options_.selection != nullptr)
    options_.selection->ids.clear();
}

}  // namespace migiwa
