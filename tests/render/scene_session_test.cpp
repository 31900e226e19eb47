// A scene's file that is edited while its simulation is there.
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/session/session.h"
#include "core/simulation/simulation.h"
#include "tests/render/test_scene.h"
#include "tests/support/same_stamp.h"

namespace migiwa {
namespace scene_session_test {

namespace fs = std::filesystem;

std::string sceneText(double tolerance, double height) {
  return R"({ "format": 1, "name": "Edited", "particle_spacing": 0.1,
    "fluid": [{ "shape": "box", "min": [0, 0, 0], "max": [0.5, )" +
         std::to_string(height) + R"(, 0.5] }],
    "boundary": { "surfaces": [{ "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5] }] },
    "solver": { "time_step": 0.005, "tolerance": )" +
         std::to_string(tolerance) + " } }\n";
}

void writeInPlace(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// As most editors save.
void writeByRename(const fs::path& file, const std::string& text) {
  writeInPlace(file.string() + "~", text);
  fs::rename(file.string() + "~", file);
}

class SceneWatchTest : public ::testing::Test {
 protected:
  ~SceneWatchTest() override { fs::remove_all(folder_); }
  const fs::path folder_ = freshFolder("watch");
  const fs::path file_ = folder_ / "scene.json";
};

TEST_F(SceneWatchTest, TellsAChangeOnceAndOnlyWhenItHasSettled) {
  writeInPlace(file_, "one");
  SceneWatch watch({file_});
  EXPECT_FALSE(watch.poll());
  writeInPlace(file_, "one more");
  EXPECT_FALSE(watch.poll()) << "may still be written";
  writeInPlace(file_, "one more word");
  EXPECT_FALSE(watch.poll()) << "is still written";
  EXPECT_TRUE(watch.poll());
  EXPECT_FALSE(watch.poll());
}

TEST_F(SceneWatchTest, SeesFilesRenamedOverAndMissingForAMoment) {
  writeInPlace(file_, "one");
  SceneWatch watch({file_});
  writeByRename(file_, "another");
  EXPECT_FALSE(watch.poll());
  EXPECT_TRUE(watch.poll());
  fs::rename(file_, folder_ / "backup");
  EXPECT_FALSE(watch.poll());
  writeInPlace(file_, "a third one");
  EXPECT_FALSE(watch.poll());
  EXPECT_TRUE(watch.poll());
}

TEST_F(SceneWatchTest, ATouchIsNoChange) {
  writeInPlace(file_, "one");
  SceneWatch watch({file_});
  fs::last_write_time(file_, fs::last_write_time(file_) + std::chrono::seconds(7));
  EXPECT_FALSE(watch.poll());
  EXPECT_FALSE(watch.poll());
  writeByRename(file_, "one");
  EXPECT_FALSE(watch.poll());
  EXPECT_FALSE(watch.poll());
}

TEST_F(SceneWatchTest, SeesWhatNeitherSizeNorTimeOfWritingTells) {
  writeInPlace(file_, "one");
  fs::last_write_time(file_, fs::last_write_time(file_) - std::chrono::hours(1));
  SceneWatch watch({file_});
  EXPECT_FALSE(watch.poll());
  testing::rewriteUnseen(file_, "two");
  EXPECT_FALSE(watch.poll());
  EXPECT_TRUE(watch.poll());
}

TEST_F(SceneWatchTest, AFileThatStaysAwayIsAChange) {
  writeInPlace(file_, "one");
  SceneWatch watch({file_});
  fs::remove(file_);
  EXPECT_FALSE(watch.poll());
  EXPECT_TRUE(watch.poll());
}

class SceneSessionTest : public ::testing::Test {
 protected:
  SceneSessionTest() {
    writeInPlace(file_, sceneText(0.02, 0.5));
    session_ = std::make_unique<SceneSession>(readScene(file_), SessionOptions{{}, 1, Pace::unlimited});
  }
  ~SceneSessionTest() override { fs::remove_all(folder_); }

  /// What the session says of what was begun or changed, if anything.
  std::optional<SceneChange> change() const {
    // A change is seen at the first call, believed at the second, and read when it has been waited for.
    for (int k = 0; k < 4; ++k) {
      if (auto change = session_->poll()) return change;
      session_->wait();
    }
    return std::nullopt;
  }

  const fs::path folder_ = freshFolder("session");
  const fs::path file_ = folder_ / "scene.json";
  std::unique_ptr<SceneSession> session_;
};

TEST_F(SceneSessionTest, ParametersNeedNoNewBeginning) {
  EXPECT_FALSE(change());
  writeByRename(file_, sceneText(0.04, 0.5));
  const auto changed = change();
  ASSERT_TRUE(changed && changed->scene);
  EXPECT_EQ(changed->scene->solver.tolerance, 0.04);
  EXPECT_FALSE(changed->simulation);
  EXPECT_TRUE(changed->fromFile());
  EXPECT_FALSE(change());
}

TEST_F(SceneSessionTest, EffectsComeAndGoWithoutANewBeginning) {
  const auto withEffects = [](const std::string& effects) {
    std::string text = sceneText(0.02, 0.5);
    return text.insert(text.rfind('}'), R"(, "effects": )" + effects);
  };
  writeByRename(file_, withEffects(R"({ "viscosity": {}, "wall_friction": { "coefficient": 0.5 } })"));
  const auto added = change();
  ASSERT_TRUE(added && added->scene);
  EXPECT_FALSE(added->simulation);
  ASSERT_EQ(added->scene->effects.size(), 2U);
  EXPECT_EQ(added->scene->effects[0].name, "viscosity");
  EXPECT_EQ(added->scene->effects[1].name, "wall_friction");
  writeByRename(file_, sceneText(0.02, 0.5));
  const auto removed = change();
  ASSERT_TRUE(removed && removed->scene);
  EXPECT_FALSE(removed->simulation);
  EXPECT_TRUE(removed->scene->effects.empty());
}

TEST_F(SceneSessionTest, FluidAndWallsBeginAnew) {
  writeInPlace(file_, sceneText(0.02, 0.8));
  const auto changed = change();
  ASSERT_TRUE(changed && changed->scene && changed->simulation);
  FrameSnapshot frame;
  ASSERT_TRUE(changed->simulation->takeFrame(frame));
  EXPECT_EQ(frame.positions.size(), 5U * 8U * 5U);
}

TEST_F(SceneSessionTest, ABrokenFileIsToldAndMendedAgain) {
  writeByRename(file_, sceneText(7, 0.5));
  const auto faulty = change();
  ASSERT_TRUE(faulty && !faulty->scene && !faulty->simulation);
  ASSERT_EQ(faulty->faults.size(), 1U);
  EXPECT_EQ(faulty->faults[0].place, file_.string() + ":/solver/tolerance");
  writeByRename(file_, "{");
  const auto broken = change();
  ASSERT_TRUE(broken && broken->faults.size() == 1);
  EXPECT_EQ(broken->faults[0].place, file_.string() + ":1:2");
  writeByRename(file_, sceneText(0.02, 0.5));
  const auto mended = change();
  ASSERT_TRUE(mended && mended->scene);
  EXPECT_FALSE(mended->simulation) << "the simulation has gone on all the while";
}

TEST_F(SceneSessionTest, IncludedFilesAreWatchedToo) {
  const fs::path variant = folder_ / "variant.json";
  writeInPlace(variant, R"({ "include": "scene.json", "solver": { "max_iterations": 9 } })");
  session_ = std::make_unique<SceneSession>(readScene(variant), SessionOptions{{}, 1, Pace::unlimited});
  writeByRename(file_, sceneText(0.05, 0.5));
  const auto changed = change();
  ASSERT_TRUE(changed && changed->scene);
  EXPECT_EQ(changed->scene->solver.tolerance, 0.05);
  EXPECT_EQ(changed->scene->solver.maxIterations, 9);
  // And one that is included from now on.
  writeInPlace(folder_ / "third.json", sceneText(0.06, 0.5));
  writeByRename(variant, R"({ "include": "third.json" })");
  ASSERT_TRUE(change());
  writeByRename(folder_ / "third.json", sceneText(0.07, 0.5));
  const auto third = change();
  ASSERT_TRUE(third && third->scene);
  EXPECT_EQ(third->scene->solver.tolerance, 0.07);
}

TEST_F(SceneSessionTest, MeshesAreWatchedToo) {
  // A tetrahedron of fluid; stretched along x, it takes twice as many particles, give or take its slanted
  // sides.
  const auto mesh = [](double length) {
    return "v 0 0 0\nv " + std::to_string(length) +
           " 0 0\nv 0 0.9 0\nv 0 0 0.9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  };
  const auto scene = [](const std::string& file) {
    return R"({ "format": 1, "particle_spacing": 0.05, "fluid": [ { "shape": "mesh", "file": ")" + file +
           "\" } ] }";
  };
  const auto count = [](const std::optional<SceneChange>& changed) {
    FrameSnapshot frame;
    if (!changed || !changed->simulation || !changed->simulation->takeFrame(frame)) return std::size_t{0};
    return frame.positions.size();
  };
  writeInPlace(folder_ / "fluid.obj", mesh(0.9));
  writeInPlace(file_, scene("fluid.obj"));
  const std::size_t before = Simulation(readScene(file_), 1).view().positions.size();
  session_ = std::make_unique<SceneSession>(readScene(file_), SessionOptions{{}, 1, Pace::unlimited});
  writeByRename(folder_ / "fluid.obj", mesh(1.8));
  const std::size_t after = count(change());
  EXPECT_NEAR(static_cast<double>(after), 2 * static_cast<double>(before), 0.1 * static_cast<double>(before));

  // A mesh that breaks is told, and told to be mended, though the scene has not changed.
  writeByRename(folder_ / "fluid.obj", "v 0 0 0\n");
  const auto broken = change();
  ASSERT_TRUE(broken && broken->faults.size() == 1);
  EXPECT_EQ(broken->faults[0].place, file_.string() + ":/fluid/0/file");
  writeByRename(folder_ / "fluid.obj", mesh(0.9));
  EXPECT_EQ(count(change()), before);

  // One that a text from the window names for the first time, and that is not there yet.
  session_->apply(scene("later.obj"));
  const auto missing = change();
  ASSERT_TRUE(missing && missing->faults.size() == 1);
  writeByRename(file_, scene("later.obj"));
  ASSERT_TRUE(change());
  writeInPlace(folder_ / "later.obj", mesh(1.8));
  EXPECT_EQ(count(change()), after);
  EXPECT_FALSE(change());
}

TEST_F(SceneSessionTest, TextsFromTheWindowAreTakenWithoutTheFile) {
  session_->apply(sceneText(0.02, 0.7));
  const auto changed = change();
  ASSERT_TRUE(changed && changed->scene && changed->simulation);
  EXPECT_FALSE(changed->fromFile());
  EXPECT_EQ(session_->fileText(), sceneText(0.02, 0.5));
  session_->apply("{ \"format\": 1, }");
  const auto broken = change();
  ASSERT_TRUE(broken);
  EXPECT_EQ(broken->faults.size(), 1U);
}

TEST_F(SceneSessionTest, SavedAsItIsNowReadsBackToTheSameHash) {
  Scene scene = readScene(file_);
  Settings settings;
  settings.solver = scene.solver;
  settings.boundary = scene.boundary;
  settings.effects = scene.effects;
  settings.solver.maxIterations = 3;
  settings.boundary.handling = BoundaryHandling::none;
  ViewState view;
  view.camera = scene.view.camera;
  view.camera.eye = {3, 2, 1};
  view.clip = {true, Axis::z, 0.25};
  view.color = ColorField::speed;
  session_->saveAs({"other", session_->fileText(), settings, view});
  const auto changed = change();
  ASSERT_TRUE(changed && changed->saved && changed->scene);
  EXPECT_FALSE(changed->simulation);

  const Scene saved = readScene(folder_ / "other.json");
  EXPECT_EQ(saved.view.camera, view.camera);
  EXPECT_EQ(saved.view.clip, view.clip);
  EXPECT_EQ(saved.view.color, ColorField::speed);
  Simulation one(saved, 1), two(scene, 1);
  two.apply(settings);
  for (int k = 0; k < 5; ++k) one.advanceFrame(), two.advanceFrame();
  EXPECT_EQ(one.stateHash(), two.stateHash());
  EXPECT_EQ(session_->file(), folder_ / "other.json");
  EXPECT_EQ(session_->fileText().find("/solver"), std::string::npos);
}

TEST_F(SceneSessionTest, NothingIsSavedFromAFaultyTextOrUnderAWrongName) {
  const Settings settings;
  const ViewState view;
  const auto refused = [&](const std::string& name, const std::string& text) {
    session_->saveAs({name, text, settings, view});
    const auto changed = change();
    return changed && !changed->saved && !changed->scene && !changed->faults.empty() &&
           changed->source == SceneChange::Source::save;
  };
  EXPECT_TRUE(refused("other.json", "{}"));
  EXPECT_TRUE(refused("", session_->fileText()));
  EXPECT_TRUE(refused("../other.json", session_->fileText()));
  EXPECT_EQ(session_->file(), file_);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

/// A pipe in the place of a file: whoever reads it waits for finish(), after which it is a file like others.
class SlowFile {
 public:
  SlowFile(fs::path file, std::string content) : file_(std::move(file)), content_(std::move(content)) {
    EXPECT_EQ(mkfifo(pipe().c_str(), 0600), 0);
    fs::create_hard_link(pipe(), file_);
  }
  /// Waits until somebody reads.
  void awaitReader() { out_ = open(pipe().c_str(), O_WRONLY | O_CLOEXEC); }
  void finish() const {
    writeByRename(file_, content_);
    EXPECT_EQ(write(out_, content_.data(), content_.size()), static_cast<ssize_t>(content_.size()));
    close(out_);
  }

 private:
  std::string pipe() const { return file_.string() + ".pipe"; }

  fs::path file_;
  std::string content_;
  int out_ = -1;
};

/// The calls of a window between two frames, while somebody waits for a slow file. Each returns, or the test
/// never ends.
class SlowSceneTest : public SceneSessionTest {
 protected:
  void expectNoNews() {
    slow_.awaitReader();
    for (int k = 0; k < 5; ++k) EXPECT_FALSE(session_->poll());
    EXPECT_EQ(session_->file(), file_);
    EXPECT_EQ(session_->stateFile(), folder_ / "scene.save");
  }

  const std::string text_ = R"({ "include": "slow.json", "solver": { "max_iterations": 9 } })";
  SlowFile slow_{folder_ / "slow.json", sceneText(0.05, 0.5)};
};

TEST_F(SlowSceneTest, IsAppliedInTheBackground) {
  session_->apply(text_);
  expectNoNews();
  session_->apply("out of date before anybody reads it");
  session_->apply(sceneText(0.06, 0.5));
  EXPECT_FALSE(session_->poll());
  slow_.finish();
  const auto slow = change();
  ASSERT_TRUE(slow && slow->scene);
  EXPECT_EQ(slow->scene->solver.tolerance, 0.05);
  EXPECT_EQ(slow->scene->solver.maxIterations, 9);
  const auto next = change();
  ASSERT_TRUE(next && next->scene);
  EXPECT_EQ(next->scene->solver.tolerance, 0.06);
  EXPECT_FALSE(change());
}

TEST_F(SlowSceneTest, IsSavedInTheBackground) {
  const Scene scene = readScene(file_);
  Settings settings{scene.solver, scene.boundary, scene.effects};
  settings.solver.tolerance = 0.07;
  session_->saveAs({"other", text_, settings, {}});
  expectNoNews();
  EXPECT_FALSE(fs::exists(folder_ / "other.json"));
  slow_.finish();
  const auto saved = change();
  ASSERT_TRUE(saved && saved->saved && saved->scene);
  EXPECT_EQ(session_->file(), folder_ / "other.json");
  EXPECT_EQ(readScene(folder_ / "other.json").solver.tolerance, 0.07);
  EXPECT_FALSE(change()) << "the session's own file is no news";
}

TEST_F(SlowSceneTest, IsReadAgainInTheBackground) {
  writeByRename(file_, text_);
  EXPECT_FALSE(session_->poll());
  session_->wait();
  EXPECT_FALSE(session_->poll());
  expectNoNews();
  EXPECT_EQ(session_->fileText(), sceneText(0.02, 0.5)) << "as last taken over";
  slow_.finish();
  const auto changed = change();
  ASSERT_TRUE(changed && changed->scene);
  EXPECT_EQ(changed->scene->solver.tolerance, 0.05);
  EXPECT_EQ(session_->fileText(), text_);
}

TEST_F(SlowSceneTest, IsStillSavedWhenTheWindowCloses) {
  session_->apply(text_);
  slow_.awaitReader();
  const Scene scene = readScene(file_);
  session_->apply("not read any more");
  session_->saveAs({"last", sceneText(0.08, 0.5), {scene.solver, scene.boundary, scene.effects}, {}});
  slow_.finish();
  session_.reset();
  EXPECT_EQ(readScene(folder_ / "last.json").surfaces.size(), 1U);
}

/// Of the calling thread, from files and pipes; nothing where the system does not count them.
std::optional<long> bytesReadHere() {
  std::ifstream io("/proc/thread-self/io");
  std::string name;
  long bytes = 0;
  if (!(io >> name >> bytes) || name != "rchar:") return std::nullopt;
  return bytes;
}

TEST_F(SceneSessionTest, WhoAsksReadsNoFile) {
  constexpr std::size_t kLong = std::size_t{1} << 22;
  const auto mesh = [&](char padding) {
    return "# " + std::string(kLong, padding) +
           "\nv 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nv 0 0 0.5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  };
  const std::string text =
      R"({ "format": 1, "particle_spacing": 0.1, "fluid": [ { "shape": "mesh", "file": "fluid.obj" } ] })";
  writeInPlace(folder_ / "fluid.obj", mesh('a'));
  writeInPlace(file_, text);
  const Scene scene = readScene(file_);
  session_ = std::make_unique<SceneSession>(scene, SessionOptions{{}, 1, Pace::unlimited});
  if (!bytesReadHere()) GTEST_SKIP() << "this system does not count what a thread reads";
  writeByRename(folder_ / "fluid.obj", mesh('b'));

  const long before = *bytesReadHere();
  EXPECT_TRUE(change()) << "another content";
  session_->apply(text + " ");
  EXPECT_TRUE(change());
  session_->saveAs({"other", text, {scene.solver, scene.boundary, scene.effects}, {}});
  const auto saved = change();
  EXPECT_TRUE(saved && saved->saved);
  EXPECT_LT(*bytesReadHere() - before, 4096) << "the counter itself";
}

}  // namespace scene_session_test
}  // namespace migiwa
