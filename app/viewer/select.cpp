// Particles that are selected by a rectangle over the picture.
#include <algorithm>
#include <cmath>

#include "app/session/selection.h"
#include "app/ui/bindings.h"
#include "app/viewer/viewer.h"

namespace migiwa {
namespace {

/// A rectangle that is no larger is a click.
constexpr float kLeastPixels = 4;

}  // namespace

void Viewer::select(const FrameView& frame, const InputState& input, const Rect& area) {
  if (options_.selection == nullptr) return;
  SelectionModel& model = *options_.selection;
  const bool down = input.down(MouseButton::left), before = last_.down(MouseButton::left);
  const bool asked =
      model.tool || actionOf(MouseGesture::drag, MouseButton::left, input) == MouseAction::select;
  if (down && !before && asked && contains(area, input) && !ui_.wantsMouse() && !asShown(frame).water)
    selectingFrom_ = {input.mouseX, input.mouseY};
  if (!selectingFrom_) return;
  const auto [x, y] = *selectingFrom_;
  if (down) {
    model.rectangle = {std::min(x, input.mouseX), std::min(y, input.mouseY), std::max(x, input.mouseX),
                       std::max(y, input.mouseY)};
    return;
  }
  if (model.rectangle) selectInside(frame, area);
  model.rectangle.reset();
  selectingFrom_.reset();
}

/// Those whose centres the rectangle has in it, however far behind, but for those that are cut away.
void Viewer::selectInside(const FrameView& frame, const Rect& area) {
  SelectionModel& model = *options_.selection;
  const auto [left, top, right, bottom] = *model.rectangle;
  if (right - left < kLeastPixels && bottom - top < kLeastPixels) return;
  model.tool = false;
  model.ids.clear();
  const Shot now = shot(area);
  const Projection projection = makeProjection(view_.camera, target_->width(), target_->height(), area);
  for (std::size_t k = 0; k < frame.positions.size(); ++k) {
    const Vec3f place = frame.positions[k].xyz();
    const auto pixel = pixelOf(place, projection, area);
    if (!pixel || isCut(now, place)) continue;
    const auto [px, py] = *pixel;
    if (px >= left && px <= right && py >= top && py <= bottom)
      model.ids.push_back(frame.ids.empty() ? static_cast<std::uint32_t>(k) : frame.ids[k]);
  }
  std::sort(model.ids.begin(), model.ids.end());
}

/// Where its panel was open in the last frame.
void Viewer::measureSelection(const FrameView& frame) {
  if (options_.selection == nullptr) return;
  SelectionModel& model = *options_.selection;
  model.all = frame.positions.size();
  model.spread.reset();
  if (!std::exchange(model.shown, false)) return;
  const std::vector<std::size_t> places = selectedIn(frame, model.ids);
  model.here = model.ids.empty() ? 0 : places.size();
  std::vector<double> values;
  for (const std::size_t place : places)
    values.push_back(fieldValue(frame, place, model.field, scene_.origin));
  model.spread = spreadOf(values);
}

}  // namespace migiwa
