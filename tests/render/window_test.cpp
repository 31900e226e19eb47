// A real window, driven by real keys and clicks: needs a display, such as xvfb-run's.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <future>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/session/session.h"
#include "app/session/ui_state.h"
#include "app/viewer/viewer.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace window_test {

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

/// A person at the window, in a program of its own (window_hands.py).
class Hands {
 public:
  Hands() : pipe_(popen("exec /usr/bin/python3 " MIGIWA_SOURCE_DIR "/tests/render/window_hands.py", "w")) {
    // If it fails, the test is to say so and not to end.
    std::signal(SIGPIPE, SIG_IGN);
  }
  ~Hands() { EXPECT_EQ(pclose(pipe_), 0); }
  Hands(const Hands&) = delete;
  Hands& operator=(const Hands&) = delete;

  void act(const std::string& line) {
    std::fputs((line + "\n").c_str(), pipe_);
    std::fflush(pipe_);
  }

 private:
  std::FILE* pipe_;
};

/// A frame of the window's, kept until it is closed.
struct Seen {
  explicit Seen(const DrawnFrame& drawn)
      : info(drawn.frame.info),
        particles(drawn.frame.positions.size()),
        run(drawn.run),
        handling(drawn.viewer.settings().boundary.handling),
        picture(drawn.viewer.picture()) {}

  FrameInfo info;
  std::size_t particles;
  RunStatus run;
  BoundaryHandling handling;
  Image picture;
};

/// What is done at the window, nothing perhaps, and what shows that it has been done.
struct Act {
  std::string line;
  std::function<bool(const DrawnFrame&)> done;
};

std::function<bool(const DrawnFrame&)> afterFrames(int count) {
  return [count](const DrawnFrame&) mutable { return --count <= 0; };
}

/// Does one thing after the other in a window on the small scene, closes it, and returns the frame after
/// each; fewer where something was never done.
std::vector<Seen> windowAfter(const std::vector<Act>& acts, WindowOptions options = {}) {
  constexpr long kMostFrames = 2000;
  std::vector<Seen> seen;
  bool begun = false;
  Hands hands;
  options.frames = kMostFrames;
  options.threads = 1;
  options.drawn = [&](const DrawnFrame& drawn) {
    if (seen.size() == acts.size()) return;
    const Act& act = acts[seen.size()];
    if (!std::exchange(begun, true)) {
      if (!act.line.empty()) hands.act(act.line);
      return;
    }
    if (!act.done(drawn)) return;
    begun = false;
    seen.emplace_back(drawn);
    if (seen.size() == acts.size()) hands.act("close");
  };
  runWindow("small", smallScene, options);
  EXPECT_EQ(seen.size(), acts.size()) << "the window never showed what act " << seen.size() << " does";
  return seen;
}

/// The scene's middle, where there is water and no text; a wall time is never the same again.
Image middleOf(const Image& picture) {
  constexpr int kLeft = 560, kTop = 220, kWide = 520, kHigh = 320;
  Image part(kWide, kHigh);
  for (int y = 0; y < kHigh; ++y) std::copy_n(picture.pixel(kLeft, kTop + y), 4 * kWide, part.pixel(0, y));
  return part;
}

/// The same picture, off-screen.
Image middleWithoutWindow(const Simulation& simulation, const RunStatus& run, bool panels) {
  const auto context = makeEglContext();
  SceneEditor editor;
  WhatIfModel whatIf;
  Viewer viewer(simulation.scene(), simulation.walls(),
                {.scale = 1, .panels = panels, .editor = &editor, .whatIf = &whatIf});
  return middleOf(viewer.takePicture(simulation.drawnView(), run, 1280, 720));
}

void advanceTo(Simulation& simulation, double time) {
  while (simulation.time() < time - 1e-9) simulation.advanceFrame();
}

TEST(WindowTest, LoopDrawsSoManyFramesAndCloses) {
  WindowOptions options;
  options.frames = 20;
  options.threads = 1;
  options.playing = false;
  std::vector<Seen> seen;
  options.drawn = [&](const DrawnFrame& drawn) { seen.emplace_back(drawn); };
  runWindow("small", smallScene, options);
  ASSERT_EQ(seen.size(), 20U);
  const Simulation start(smallScene(), 1);
  for (const Seen& frame : seen) {
    EXPECT_EQ(frame.info.stateHash, start.stateHash());
    EXPECT_EQ(frame.particles, 150U);
    EXPECT_FALSE(frame.run.playing);
  }
  EXPECT_EQ(middleOf(seen.back().picture).rgba, middleWithoutWindow(start, seen.back().run, true).rgba);
}

TEST(WindowTest, PlaysAtOnceUnlessItIsAskedNotTo) {
  const std::vector<Seen> seen =
      windowAfter({{"", [](const DrawnFrame& drawn) { return drawn.frame.info.time > 0.099; }}});
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_TRUE(seen[0].run.playing);
  Simulation same(smallScene(), 1);
  advanceTo(same, seen[0].info.time);
  EXPECT_EQ(seen[0].info.stateHash, same.stateHash());
}

TEST(WindowTest, KeysPlayPauseStepAndReset) {
  const auto steps = [](long count) {
    return [count](const DrawnFrame& drawn) { return drawn.frame.info.steps == count; };
  };
  const auto playing = [](bool wanted) {
    return [wanted](const DrawnFrame& drawn) {
      return drawn.run.playing == wanted && (!wanted || drawn.frame.info.time > 0.06);
    };
  };
  enum { start, step1, step2, played, paused, rested, rested2, stepped, again };
  WindowOptions options;
  options.playing = false;
  const std::vector<Seen> seen = windowAfter({{"", afterFrames(3)},
                                              {"key Right", steps(1)},
                                              {"key Right", steps(2)},
                                              {"key space", playing(true)},
                                              {"key space", playing(false)},
                                              {"", afterFrames(20)},
                                              {"", afterFrames(20)},
                                              {"key Right", afterFrames(20)},
                                              {"key r", steps(0)}},
                                             options);
  ASSERT_EQ(seen.size(), std::size_t{again} + 1);
  Simulation same(smallScene(), 1);
  EXPECT_EQ(seen[start].info.stateHash, same.stateHash());
  for (const int k : {step1, step2}) {
    same.advanceFrame();
    EXPECT_EQ(seen[static_cast<std::size_t>(k)].info.stateHash, same.stateHash()) << "step " << k;
  }
  EXPECT_GT(seen[played].info.time, 0.06);
  EXPECT_EQ(seen[rested].info.steps, seen[rested2].info.steps) << "paused";
  advanceTo(same, seen[rested].info.time);
  EXPECT_EQ(seen[rested].info.stateHash, same.stateHash());
  const Image shown = middleOf(seen[rested].picture);
  EXPECT_EQ(shown.rgba, middleWithoutWindow(same, seen[rested].run, true).rgba);
  EXPECT_NE(shown.rgba, middleOf(seen[start].picture).rgba) << "the water has not moved";
  same.advanceFrame();
  EXPECT_EQ(seen[stepped].info.stateHash, same.stateHash()) << "one more step";
  EXPECT_EQ(seen[again].info.stateHash, seen[start].info.stateHash);
  EXPECT_FALSE(seen[again].run.playing);
}

TEST(WindowTest, KeysAndButtonsChangeWhatIsShownAndComputed) {
  std::promise<Image> kept;
  std::future<Image> picture = kept.get_future();
  WindowOptions options;
  options.playing = false;
  options.savePicture = [&](const Image& image) { kept.set_value(image); };
  const auto isKept = [&](const DrawnFrame&) {
    return picture.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  const auto changed = [](const DrawnFrame& drawn) {
    return drawn.viewer.settings().boundary.handling == BoundaryHandling::none;
  };
  const auto steps = [](long count) {
    return [count](const DrawnFrame& drawn) { return drawn.frame.info.steps == count; };
  };
  enum { kPicture, kHidden, kChanged, kStepped, kShown, kClicked };
  const std::vector<Seen> seen = windowAfter({{"key p", isKept},
                                              {"key h", afterFrames(20)},
                                              {"key c", changed},
                                              {"key Right", steps(1)},
                                              {"key h", afterFrames(20)},
                                              {"click 160 86", steps(2)}},
                                             options);
  ASSERT_EQ(seen.size(), std::size_t{kClicked} + 1);
  Simulation same(smallScene(), 1);
  EXPECT_EQ(middleOf(picture.get()).rgba, middleWithoutWindow(same, seen[kPicture].run, true).rgba);
  const Image hidden = middleOf(seen[kHidden].picture);
  EXPECT_EQ(hidden.rgba, middleWithoutWindow(same, seen[kHidden].run, false).rgba);
  EXPECT_NE(hidden.rgba, middleOf(seen[kPicture].picture).rgba) << "the scene has all of the window";

  Settings settings = same.settings();
  settings.boundary.handling = BoundaryHandling::none;
  same.apply(settings);
  for (const int k : {kStepped, kClicked}) {
    same.advanceFrame();
    EXPECT_EQ(seen[static_cast<std::size_t>(k)].info.stateHash, same.stateHash());
    EXPECT_EQ(seen[static_cast<std::size_t>(k)].info.handling, "no correction");
  }
}

/// The bar of the first of `branches` branches in a window of 1280 x 720, at a share of its length.
std::string onBar(double share, int branches) {
  const int height = static_cast<int>(std::lround((1.35 * branches + 2) * 15));
  return std::to_string(std::lround(468 + share * (1268 - 468))) + " " + std::to_string(720 - height + 14);
}

TEST(WindowTest, TimeLineGoesBackByKeysByClicksAndByDragging) {
  const auto at = [](double time) {
    return [time](const DrawnFrame& drawn) {
      return std::abs(drawn.frame.info.time - time) < 1e-9 && !drawn.run.line.underWay;
    };
  };
  const auto branch = [](int number) {
    return [number](const DrawnFrame& drawn) { return drawn.run.line.branch == number; };
  };
  enum { kEnd, kBack, kHome, kEndAgain, kClicked, kDragged, kBranch, kOn, kFirst };
  WindowOptions options;
  options.playing = false;
  std::vector<Act> acts;
  for (int k = 1; k <= 20; ++k) acts.push_back({"key Right", at(0.005 * k)});
  const std::size_t steps = acts.size();
  for (const Act& act : std::vector<Act>{{"key Left", at(0.095)},
                                         {"key Home", at(0)},
                                         {"key End", at(0.1)},
                                         {"click " + onBar(0.5, 1), at(0.05)},
                                         {"drag " + onBar(0.5, 1) + " " + onBar(0.2, 1), at(0.02)},
                                         {"key c", branch(2)},
                                         {"key Right", at(0.025)},
                                         {"click " + onBar(0.7, 2), at(0.07)}})
    acts.push_back(act);
  const std::vector<Seen> seen = windowAfter(acts, options);
  ASSERT_EQ(seen.size(), steps + kFirst);
  const auto shown = [&](int k) -> const Seen& { return seen[steps - 1 + static_cast<std::size_t>(k)]; };
  Simulation same(smallScene(), 1);
  std::vector<std::uint64_t> hashes{same.stateHash()};
  for (int k = 0; k < 20; ++k) {
    same.advanceFrame();
    hashes.push_back(same.stateHash());
  }
  EXPECT_EQ(shown(kEnd).info.stateHash, hashes[20]);
  EXPECT_EQ(shown(kBack).info.stateHash, hashes[19]);
  EXPECT_EQ(shown(kHome).info.stateHash, hashes[0]);
  EXPECT_EQ(shown(kEndAgain).info.stateHash, hashes[20]);
  EXPECT_EQ(shown(kClicked).info.stateHash, hashes[10]);
  EXPECT_EQ(shown(kDragged).info.stateHash, hashes[4]);
  EXPECT_EQ(shown(kBranch).run.line.branches.at(1).name, "/boundary/handling=none");
  EXPECT_EQ(shown(kOn).info.handling, "no correction");
  EXPECT_EQ(shown(kFirst).info.stateHash, hashes[14]);
  EXPECT_EQ(shown(kFirst).run.line.branch, 1);
  EXPECT_EQ(shown(kFirst).handling, BoundaryHandling::gamma) << "the panel shows what is in force";
}

TEST(WindowTest, OpensWhatIsClickedInTheGalleryAndWhatIsDropped) {
  WindowOptions options;
  options.playing = false;
  options.gallery = [] { return std::vector<GalleryEntry>{{"wide.json", {}, "Wide", "A wider tank."}}; };
  std::vector<std::string> asked;
  options.open = [&](const std::filesystem::path& file) -> Scene {
    asked.push_back(file.string());
    if (file == "wide.json")
      return parseScene(R"({"format": 1, "particle_spacing": 0.1,
        "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [1, 0.2, 0.5]}]})",
                        file);
    if (file == "/tmp/dropped.obj") return smallScene();
    throw InputError(file.string(), "expected a scene, found none");
  };
  const auto particles = [](std::size_t count) {
    return [count](const DrawnFrame& drawn) { return drawn.frame.positions.size() == count; };
  };
  // The button "Scenes", and the first card.
  const std::vector<Seen> seen = windowAfter({{"click 158 40", afterFrames(5)},
                                              {"click 450 180", particles(100)},
                                              {"drop /tmp/faulty.obj", afterFrames(20)},
                                              {"drop /tmp/dropped.obj", particles(150)}},
                                             options);
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(asked, (std::vector<std::string>{"wide.json", "/tmp/faulty.obj", "/tmp/dropped.obj"}));
  EXPECT_TRUE(seen[1].run.playing) << "what is opened plays";
  EXPECT_EQ(seen[2].particles, 100U) << "what cannot be opened changes nothing";
}

TEST(WindowTest, AClickOnAParticleLooksIntoIt) {
  WindowOptions options;
  options.playing = false;
  const auto looksInto = [](bool wanted) {
    return [wanted](const DrawnFrame& drawn) {
      const InspectModel* const model = drawn.viewer.inspected();
      return model->id.has_value() == wanted && (!wanted || (model->picked && model->walls));
    };
  };
  const std::vector<Seen> seen =
      windowAfter({{"click 700 420", looksInto(true)}, {"key Escape", looksInto(false)}}, options);
  ASSERT_EQ(seen.size(), 2U);
}

/// Titles of the windows that there are.
std::string titles() {
  std::FILE* const pipe = popen(
      "/usr/bin/python3 -c 'from Xlib import display\n"
      "for w in display.Display().screen().root.query_tree().children: print(w.get_wm_name())'",
      "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

TEST(WindowTest, SaysWhatIsDoneWhileTheSceneIsPrepared) {
  bool said = false;
  const auto read = [&] {
    Activity activity("fitting five points");
    activity.reach(0.45);
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!said && std::chrono::steady_clock::now() < until)
      said = titles().find("fitting five points: 45 % - small - Migiwa") != std::string::npos;
    return smallScene();
  };
  std::string after;
  WindowOptions options;
  options.frames = 3;
  options.drawn = [&](const DrawnFrame&) { after = titles(); };
  runWindow("small", read, options);
  EXPECT_TRUE(said);
  EXPECT_EQ(after.find("fitting"), std::string::npos) << after;
  EXPECT_NE(after.find(" - Migiwa"), std::string::npos) << after;
}

/// As where there is no window.
TEST(WindowTest, OpensNoWindowOnASceneWithFaults) {
  const auto read = []() -> Scene { throw InputError("scene.json", "expected one, found none"); };
  EXPECT_THROW(runWindow("small", read, {}), InputError);
}

TEST(WindowTest, SizeIsAskedForInPixels) {
  const GlfwWindow window("Migiwa", 500, 320);
  EXPECT_EQ(window.framebufferSize(), (std::array<int, 2>{500, 320}));
  EXPECT_FALSE(window.shouldClose());
  EXPECT_GE(window.contentScale(), 1);
  EXPECT_NE(window.renderer().find("OpenGL 4."), std::string::npos) << window.renderer();
}

}  // namespace window_test
}  // namespace migiwa
