// The style "raytraced" of `migiwa render`.
#include <thread>

#include "app/commands/pictures.h"
#include "app/raytrace/still.h"
#include "core/base/progress.h"
#include "core/simulation/scene_surface.h"

namespace migiwa {
namespace {

class StillTaker final : public PictureTaker {
 public:
  StillTaker(const RenderJob& job, int threads) : job_(job), pool_(threads) {}

  Image take(const Simulation& simulation, const FrameView& frame) override {
    const Scene& scene = simulation.scene();
    if (!surface_) surface_.emplace(scene, SurfaceOptions{}, pool_);
    const SurfaceMesh water = surface_->mesh(frame.positions, {}, simulation.time());
    const Stage stage({.scene = &scene, .walls = &surface_->boundary(), .water = &water});

    Activity activity("tracing rays");
    const std::thread::id caller = std::this_thread::get_id();
    const auto progress = [&](double part) {
      if (std::this_thread::get_id() == caller) activity.reach(part);
    };
    const Exposure exposure = expose(stage, scene.view.camera,
                                     {.width = job_.width,
                                      .height = job_.height,
                                      .samples = job_.samples,
                                      .seed = job_.seed,
                                      .progress = progress},
                                     pool_);
    Image image(job_.width, job_.height);
    image.rgba = developed(denoised(exposure, pool_));
    return image;
  }

 private:
  const RenderJob& job_;
  ThreadPool pool_;
  std::optional<SceneSurface> surface_;
};

}  // namespace

std::unique_ptr<PictureTaker> makeStillTaker(const RenderJob& job, int threads) {
  return std::make_unique<StillTaker>(job, threads);
}

}  // namespace migiwa
