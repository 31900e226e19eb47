// The field on a plane that the window shows, worked out beside the simulation. No window, no OpenGL.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>

#include "app/session/ui_state.h"
#include "core/base/parallel.h"
#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/scene_section.h"

namespace migiwa {

/// The plane of a view in a scene; nothing where it misses it. With fewer cells where the field takes long.
std::optional<SectionPlane> planeOf(const SectionView& view, const Scene& scene);

/// Between the panel and the raster that is made in the background.
class SectionSession {
 public:
  /// `threads` as for a Simulation.
  explicit SectionSession(int threads) : threads_(threads) {}

  /// Asks for the section as it is wanted now, and takes in what is done; returns whether there is news.
  /// Until then the last one is shown. None is kept where none is wanted.
  bool poll(SectionModel& model, const SectionView& view, const Scene& scene, const Settings& now,
            const FrameView& frame);
  /// Another scene takes the place of this one.
  void forget(SectionModel& model);
  bool busy() const { return asking_.valid(); }
  /// Waits for what is under way.
  void wait() const;

 private:
  /// What lasts from one question to the next.
  struct Tool {
    Tool(const Scene& scene, int threads) : pool(threads), sections(scene, pool) {}
    ThreadPool pool;
    SceneSection sections;
  };
  struct Outcome {
    std::shared_ptr<Tool> tool;
    SectionModel model;
  };

  int threads_;
  std::shared_ptr<Tool> tool_;
  std::optional<SceneSection::Method> method_{};  ///< that was last asked for, whether or not it could be had
  std::future<Outcome> asking_;
  bool dropped_ = false;
  std::chrono::steady_clock::time_point asked_{};
  std::uint64_t frame_ = 0;  ///< hash of the state that was last asked about
};

}  // namespace migiwa
