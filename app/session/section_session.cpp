#include "app/session/section_session.h"

#include <chrono>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace migiwa {
namespace {

constexpr int kSectionCells = 512, kErrorCells = 96;
constexpr std::chrono::milliseconds kBetweenSections(80);

/// Whether two views have the same raster: one is not made again for what only its picture depends on.
bool asksTheSame(const SectionView& a, const SectionView& b) {
  return a.field == b.field && (a.divisor == b.divisor || !isInterpolated(a.field)) &&
         a.direction() == b.direction() && a.at == b.at;
}

}  // namespace

std::optional<SectionPlane> planeOf(const SectionView& view, const Scene& scene) {
  const Vec3d up = scene.gravity.norm() > 0 ? Vec3d(-scene.gravity) : scene.view.camera.up;
  return sectionPlane(view.direction(), view.at, scene.bounds(), up,
                      view.field == SectionField::gammaError ? kErrorCells : kSectionCells);
}

bool SectionSession::poll(SectionModel& model, const SectionView& view, const Scene& scene,
                          const Settings& now, const FrameView& frame) {
  bool news = false;
  if (asking_.valid()) {
    if (asking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    Outcome outcome = asking_.get();
    if (!std::exchange(dropped_, false)) {
      tool_ = std::move(outcome.tool);
      model.raster = std::move(outcome.model.raster);
      model.of = outcome.model.of;
      model.time = outcome.model.time;
      model.fault = std::move(outcome.model.fault);
      news = true;
    }
  }
  if (!view.shown) {
    news = news || model.raster != nullptr;
    model = {};
    frame_ = 0;
    return news;
  }
  const SceneSection::Method method = SceneSection::methodOf(scene.particleSpacing, now.solver, now.boundary);
  const bool known = (model.raster || !model.fault.empty()) && method_ == method;
  // Pressures come a frame after they were asked for, of the same state.
  const std::uint64_t state = frame.info.stateHash + (frame.pressure.empty() ? 1 : 2);
  if (known && asksTheSame(model.of, view)) {
    // While a run plays, the simulation needs the processor, too.
    const bool soon = std::chrono::steady_clock::now() - asked_ < kBetweenSections;
    if ((frame_ == state && model.time == frame.info.time) || soon) return news;
  }
  Scene asked = scene;
  asked.solver = now.solver;
  asked.boundary = now.boundary;
  method_ = method;
  frame_ = state;
  asked_ = std::chrono::steady_clock::now();
  asking_ = std::async(
      std::launch::async,
      [tool = tool_, scene = std::move(asked), method, view, threads = threads_, time = frame.info.time,
       positions = std::vector<Float4>(frame.positions.begin(), frame.positions.end()),
       values = sectionValues(frame, view.field)]() mutable {
        Outcome outcome;
        outcome.model.of = view;
        outcome.model.time = time;
        try {
          if (tool == nullptr || !(tool->sections.method() == method))
            tool = std::make_shared<Tool>(scene, threads);
          const std::optional<SectionPlane> plane = planeOf(view, scene);
          if (plane) {
            outcome.model.raster = std::make_shared<SectionRaster>(
                tool->sections.of(*plane, view.field, view.divisor, positions, values, time));
          } else {
            outcome.model.fault = "The plane misses the scene";
          }
        } catch (const std::exception& error) {
          outcome.model.fault = error.what();
        }
        outcome.tool = std::move(tool);
        return outcome;
      });
  return news;
}

void SectionSession::forget(SectionModel& model) {
  model = {};
  tool_.reset();
  method_.reset();
  frame_ = 0;
  dropped_ = asking_.valid();
}

void SectionSession::wait() const {
  if (asking_.valid()) asking_.wait();
}

}  // namespace migiwa
