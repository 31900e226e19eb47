// Which particle is under the mouse, and what a frame knows of it.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "app/ui/bindings.h"
#include "app/viewer/viewer.h"

namespace migiwa {
namespace {

/// A press that moves no farther is a click, and not a turn of the view.
constexpr float kClickPixels = 4;

PickedParticle valuesOf(const FrameView& frame, std::size_t index) {
  PickedParticle picked;
  picked.id = frame.ids.empty() ? static_cast<std::uint32_t>(index) : frame.ids[index];
  picked.position = frame.positions[index].xyz();
  picked.velocity = frame.velocities[index].xyz();
  picked.density = frame.density[index];
  picked.gamma = frame.gamma[index];
  picked.lambda = frame.lambda[index];
  picked.neighbours = frame.neighbours[index];
  if (!frame.pressure.empty()) picked.pressure = frame.pressure[index];
  return picked;
}

/// Places of the other particles whose kernel reaches this one.
std::vector<Vec3f> around(const FrameView& frame, const PickedParticle& picked, std::size_t index) {
  std::vector<Vec3f> places;
  const float reach = frame.info.supportRadius * frame.info.supportRadius;
  for (std::size_t k = 0; k < frame.positions.size(); ++k) {
    const Vec3f other = frame.positions[k].xyz();
    if (k != index && (other - picked.position).squaredNorm() < reach) places.push_back(other);
  }
  return places;
}

}  // namespace

std::optional<std::size_t> pickParticle(const FrameView& frame, const Shot& shot, int width, int height,
                                        double x, double y) {
  const Projection projection = makeProjection(shot.camera, width, height, shot.scene);
  const Eigen::Matrix4d toWorld = (projection.clip * projection.view).cast<double>().inverse();
  const Eigen::Vector4d onScreen(2 * (x - shot.scene.x) / shot.scene.width - 1,
                                 1 - 2 * (y - shot.scene.y) / shot.scene.height, 0, 1);
  const Eigen::Vector4d through = toWorld * onScreen;
  const Vec3f eye = shot.camera.eye.cast<float>();
  const Vec3f ray = (Vec3d(through.head<3>() / through.w()) - shot.camera.eye).normalized().cast<float>();
  const float radius = 0.5F * frame.info.spacing;
  float nearest = std::numeric_limits<float>::infinity();
  std::optional<std::size_t> found;
  for (std::size_t k = 0; k < frame.positions.size(); ++k) {
    const Vec3f centre = frame.positions[k].xyz();
    const Vec3f offset = centre - eye;
    const float along = offset.dot(ray);
    const float missed = (offset - along * ray).squaredNorm();
    if (!(missed < radius * radius) || isCut(shot, centre)) continue;
    const float at = along - std::sqrt(radius * radius - missed);
    if (at < static_cast<float>(projection.near) || at >= nearest) continue;
    nearest = at;
    found = k;
  }
  return found;
}

void Viewer::inspect(const FrameView& frame, const InputState& input, const Rect& area) {
  if (options_.inspect == nullptr) return;
  InspectModel& model = *options_.inspect;
  const bool free = contains(area, input) && !ui_.wantsMouse();
  const bool pressed = input.down(MouseButton::left) && !last_.down(MouseButton::left);
  const bool released = !input.down(MouseButton::left) && last_.down(MouseButton::left);
  if (pressed && free && !doubleClicked_) pressedAt_ = {input.mouseX, input.mouseY};
  const bool clicked =
      released && pressedAt_ &&
      actionOf(MouseGesture::click, MouseButton::left, input) == MouseAction::pick &&
      std::hypot(input.mouseX - (*pressedAt_)[0], input.mouseY - (*pressedAt_)[1]) < kClickPixels;
  if (released) pressedAt_.reset();

  model.hovered.reset();
  const bool still =
      !input.down(MouseButton::left) && !input.down(MouseButton::right) && !input.down(MouseButton::middle);
  if (free && still && mouseUsed_ && !asShown(frame).water) {
    // The middle of the pixel.
    const auto under = pickParticle(frame, shot(area), target_->width(), target_->height(),
                                    std::floor(static_cast<double>(input.mouseX)) + 0.5,
                                    std::floor(static_cast<double>(input.mouseY)) + 0.5);
    if (under && !hidden(frame, *under, input, area)) model.hovered = valuesOf(frame, *under);
    if (clicked) model.id = model.hovered ? std::optional(model.hovered->id) : std::nullopt;
  }
  lookInto(frame);
}

/// Whether a wall that is drawn as a surface lies before the particle in the last picture.
bool Viewer::hidden(const FrameView& frame, std::size_t particle, const InputState& input,
                    const Rect& area) const {
  if (!renderer_.hasSurfaces() || !view_.walls) return false;
  const auto point = pointAt(static_cast<int>(input.mouseX), static_cast<int>(input.mouseY), area);
  const Vec3d offset = frame.positions[particle].xyz().cast<double>() - view_.camera.eye;
  return point &&
         (*point - view_.camera.eye).norm() < offset.norm() - static_cast<double>(frame.info.spacing);
}

/// Takes in where the picked particle is now, and what it is like.
void Viewer::lookInto(const FrameView& frame) {
  InspectModel& model = *options_.inspect;
  model.picked.reset();
  model.time = frame.info.time;
  if (model.walls && model.id != model.walls->id) model.walls.reset();
  if (!model.id) return;
  for (std::size_t k = 0; k < frame.positions.size() && !model.picked; ++k) {
    const std::uint32_t id = frame.ids.empty() ? static_cast<std::uint32_t>(k) : frame.ids[k];
    if (id != *model.id) continue;
    model.picked = valuesOf(frame, k);
    model.picked->around = around(frame, *model.picked, k);
  }
}

}  // namespace migiwa
