// All that a window shows of a small scene's file, without a window.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/viewer/scene_window.h"
#include "core/base/files.h"
#include "core/scene/scene_file.h"
#include "tests/render/hands.h"
#include "tests/render/test_scene.h"

namespace migiwa {

class WindowOverScene : public ::testing::Test {
 protected:
  static constexpr int kWidth = 1100, kHeight = 1300;

  explicit WindowOverScene(const std::string& name) : folder_(freshFolder(name)) {
    options_.playing = false;
    options_.threads = 1;
    writeTextFile(file_, writeScene(smallScene()));
  }
  ~WindowOverScene() override { std::filesystem::remove_all(folder_); }

  void open() {
    const Scene scene = readScene(file_, options_.overrides);
    window_.emplace(scene, std::make_unique<SimulationThread>(scene, 1, Pace::unlimited), options_,
                    SceneWindow::Look{.scale = 1.1, .timings = false});
    hands_.look();
  }
  UiCommands frame(const InputState& input) {
    window_->poll();
    window_->draw(input, kWidth, kHeight);
    window_->carryOut();
    return {};
  }
  template <class Condition>
  void await(const Condition& condition) {
    for (int k = 0; k < 1000 && !condition(); ++k) {
      hands_.look(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_TRUE(condition());
    hands_.look();
  }
  void step(int count) {
    const long until = window_->run().line.frame + count;
    for (int k = 0; k < count; ++k) window_->simulation().step();
    await([&] {
      return window_->run().line.frame == until && window_->frame().info.time == window_->run().line.time;
    });
  }
  ViewState& view() { return window_->viewer().view(); }

  std::filesystem::path folder_, file_ = folder_ / "it's small.json";
  std::unique_ptr<GlContext> context_ = makeEglContext();
  WindowOptions options_;
  std::optional<SceneWindow> window_;
  testing::Hands hands_{[this](const InputState& input) { return frame(input); }};
};

}  // namespace migiwa
