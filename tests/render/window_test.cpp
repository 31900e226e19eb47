// A real window: needs a display, such as xvfb-run's.
#include <gtest/gtest.h>

#include "app/platform/egl_context.h"
#include "app/platform/glfw_window.h"
#include "app/viewer/viewer.h"
#include "app/viewer/window_loop.h"
#include "core/scene/scene_reader.h"
#include "core/simulation/simulation.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace {

Image pictureIn(const Simulation& simulation, bool panels) {
  Viewer viewer(simulation.scene(), simulation.walls(), {scaleFor(640, 360), panels, false});
  return viewer.takePicture(simulation.view(), RunStatus{}, 640, 360);
}

/// In a window and off-screen, with panels and without.
void expectSameBytes(const Simulation& simulation) {
  for (const bool panels : {false, true}) {
    Image offScreen, inWindow;
    {
      const auto context = makeEglContext();
      offScreen = pictureIn(simulation, panels);
    }
    {
      const GlfwWindow window("Migiwa", 400, 300);
      inWindow = pictureIn(simulation, panels);
    }
    EXPECT_EQ(offScreen.rgba, inWindow.rgba) << (panels ? "with" : "without") << " panels";
  }
}

TEST(WindowTest, DrawsTheSameBytesAsEgl) {
  Simulation simulation(readScene(MIGIWA_SOURCE_DIR "/scenes/dam_break.json"));
  for (int i = 0; i < 40; ++i) simulation.advanceFrame();
  expectSameBytes(simulation);
}

/// A bowl, cut, as a surface and as nodes; and one whose wall holds the fluid, as glass.
TEST(WindowTest, DrawsSurfacesAndNodesWithTheSameBytesAsEgl) {
  for (const bool nodes : {false, true}) {
    Scene scene = parseScene(R"({
      "format": 1, "particle_spacing": 0.1,
      "fluid": [{"shape": "sphere", "center": [0, -0.3, 0], "radius": 0.4}],
      "boundary": {"handling": "none", "surfaces": [
        {"shape": "slim", "fluid": "outside", "bowl": {"center": [0, 0, 0], "radius": 1, "thickness": 0.2}, "nodes": 600}
      ]},
      "view": {"clip": {"axis": "z", "at": 0.1}}
    })",
                             "bowl.json");
    scene.view.nodes = nodes;
    expectSameBytes(Simulation(scene));
    if (nodes) continue;
    scene = parseScene(R"({
      "format": 1, "particle_spacing": 0.1,
      "boundary": {"handling": "none", "surfaces": [
        {"shape": "slim", "fluid": "inside", "bowl": {"center": [0, 0, 0], "radius": 1, "thickness": 0.2}, "nodes": 600}
      ]}
    })",
                       "vessel.json");
    expectSameBytes(Simulation(scene));
  }
}

TEST(WindowTest, LoopDrawsSoManyFramesAndCloses) {
  WindowOptions options;
  options.frames = 20;
  options.threads = 1;
  runWindow(smallScene(), options);
}

TEST(WindowTest, SizeIsAskedForInPixels) {
  const GlfwWindow window("Migiwa", 500, 320);
  EXPECT_EQ(window.framebufferSize(), (std::array<int, 2>{500, 320}));
  EXPECT_FALSE(window.shouldClose());
  EXPECT_GE(window.contentScale(), 1);
  EXPECT_NE(window.renderer().find("OpenGL 4."), std::string::npos) << window.renderer();
}

}  // namespace
}  // namespace migiwa
