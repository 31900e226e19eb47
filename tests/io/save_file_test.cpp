// A run that goes on from a save is the run that was never interrupted; what is no save of the scene is
// refused.
#include "core/io/save_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/io/report.h"
#include "core/simulation/measures.h"
#include "core/walls/shapes.h"
#include "tests/support/same_stamp.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace save_file_test {

using namespace migiwa::testing;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Falls so fast that the CFL rule divides its frames, and is not let converge.
Scene fastDrop() {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {0.3, 0.3, 0.1}, {0.6, 0.7, 0.4}, {1, -9, 0});
  addTank(scene, {0, 0, 0}, {0.9, 1.2, 0.5});
  scene.solver.maxIterations = 3;
  scene.solver.tolerance = 1e-4;
  addViscosity(scene);
  return scene;
}

/// A curved wall by directions, a thin one beside it, plain iterations.
Scene roundTank() {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {-0.2, -0.3, -0.2}, {0.2, 0.2, 0.2}, {0.5, 0, 0.3});
  scene.surfaces.push_back(std::make_shared<Sphere>(Vec3d(0, 0, 0), 0.5, Sphere::Fluid::inside));
  const auto& methods = gammaMethodNames();
  scene.boundary.gammaMethod =
      static_cast<int>(std::find(methods.begin(), methods.end(), "directions") - methods.begin());
  scene.boundary.directions = 64;
  scene.solver.acceleration = Acceleration::none;
  return scene;
}

class SaveFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("migiwa_save_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    file_ = folder_ / "run.save";
  }
  void TearDown() override { fs::remove_all(folder_); }

  void saveAfter(const Scene& scene, int frames, int threads = 1) const {
    Simulation simulation(scene, threads);
    SettledSampler sampler;
    for (int k = 0; k < frames; ++k) simulation.advanceFrame();
    writeSave(file_, simulation, sampler, {});
  }
  /// Why the save is refused for the scene; empty if it is not.
  std::string faultsFor(const Scene& scene) const {
    Simulation simulation(scene, 1);
    SettledSampler sampler;
    try {
      readSave(file_, simulation, sampler);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(file_, std::ios::binary).rdbuf();
    return text.str();
  }
  void setContent(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }
  /// The save with another header and the checksum that goes with it.
  void changeHeader(const std::function<void(Json&)>& change) const {
    const std::string old = content();
    std::array<std::uint64_t, 3> lengths;  // header, arrays, checksum
    std::memcpy(lengths.data(), old.data() + 16, sizeof lengths);
    Json header = Json::parse(old.substr(40, lengths[0]));
    change(header);
    const std::string text = header.dump(), arrays = old.substr(40 + lengths[0]);
    lengths[0] = text.size();
    lengths[2] = checksum(checksum(kEmptyChecksum, text.data(), text.size()), arrays.data(), arrays.size());
    std::string head = old.substr(0, 40);
    std::memcpy(head.data() + 16, lengths.data(), sizeof lengths);
    setContent(head + text + arrays);
  }

  fs::path folder_, file_;
};

/// What of a report does not depend on the clock and the machine.
std::string withoutTimes(const Report& report) {
  Json json = Json::parse(reportText(report));
  for (const char* key :
       {"wall_s", "threads", "step_ms", "stages_ms", "ns_per_particle_iteration", "peak_memory_bytes"})
    json.erase(key);
  return json.dump(2);
}

template <class T>
bool sameBits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

void expectSameView(const FrameView& a, const FrameView& b) {
  // Their fourth lane holds what is known of walls, which a run that goes on learns anew.
  EXPECT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t k = 0; k < std::min(a.positions.size(), b.positions.size()); ++k)
    ASSERT_EQ(a.positions[k].xyz(), b.positions[k].xyz()) << k;
  EXPECT_TRUE(sameBits(a.velocities, b.velocities));
  EXPECT_TRUE(sameBits(a.density, b.density));
  EXPECT_TRUE(sameBits(a.gamma, b.gamma));
  EXPECT_TRUE(sameBits(a.lambda, b.lambda));
  EXPECT_TRUE(sameBits(a.neighbours, b.neighbours));
  EXPECT_TRUE(sameBits(a.ids, b.ids));
  EXPECT_EQ(a.info.time, b.info.time);
  EXPECT_EQ(a.info.steps, b.info.steps);
  EXPECT_EQ(a.info.iterations, b.info.iterations);
  EXPECT_EQ(a.info.errors.size(), b.info.errors.size());
  EXPECT_EQ(a.info.stateHash, b.info.stateHash);
}

TEST_F(SaveFile, AResumedRunIsTheUninterruptedOne) {
  for (const Scene& scene : {smallDamBreak(), fastDrop(), roundTank()}) {
    constexpr int kFrames = 40;
    Simulation whole(scene, 1);
    std::vector<std::uint64_t> hashes{whole.stateHash()};
    std::vector<FrameSnapshot> views(1);
    views[0].assign(whole.view());
    for (int k = 0; k < kFrames; ++k) {
      whole.advanceFrame();
      hashes.push_back(whole.stateHash());
      views.emplace_back().assign(whole.view());
    }
    for (const auto& [frames, before, after] : {std::array{0, 1, 1}, {1, 1, 3}, {17, 3, 1}, {30, 2, 8}}) {
      saveAfter(scene, frames, before);
      Simulation resumed(scene, after);
      SettledSampler sampler;
      readSave(file_, resumed, sampler);
      expectSameView(resumed.view(), views[static_cast<std::size_t>(frames)].view());
      for (int k = frames; k <= kFrames; ++k) {
        ASSERT_EQ(resumed.stateHash(), hashes[static_cast<std::size_t>(k)]) << frames << " to " << k;
        resumed.advanceFrame();
      }
    }
  }
}

TEST_F(SaveFile, TheReportCoversTheWholeRun) {
  const Scene scene = fastDrop();
  constexpr double kUntil = 0.3;  // 60 frames, the last 6 of them sampled
  Simulation whole(scene, 1);
  const Report expected = makeReport(whole, runUntil(whole, kUntil), {});
  ASSERT_GT(expected.steps, 60) << "the scene divides no frame";
  ASSERT_FALSE(expected.trouble.empty()) << "the scene has no trouble to remember";
  ASSERT_TRUE(expected.settled.nearWallSpacingP1);

  for (const long stop : {10L, 57L, 60L}) {
    Simulation first(scene, 1);
    SettledSampler sampler;
    runUntil(first, kUntil, sampler, [&] {
      if (first.frame() == stop) writeSave(file_, first, sampler, {});
      return first.frame() < stop;
    });
    Simulation second(scene, 2);
    SettledSampler fromFile;
    readSave(file_, second, fromFile);
    EXPECT_EQ(second.frame(), stop);
    const Report report = makeReport(second, runUntil(second, kUntil, fromFile), {});
    EXPECT_EQ(withoutTimes(report), withoutTimes(expected)) << "stopped at frame " << stop;
    EXPECT_EQ(second.statistics().stepSeconds.size(), static_cast<std::size_t>(second.statistics().steps));
  }
}

TEST_F(SaveFile, SamplesOfAShorterRunAreNotThoseOfALongerOne) {
  const Scene scene = smallDamBreak();
  Simulation first(scene, 1);
  SettledSampler sampler;
  runUntil(first, 0.1, sampler);
  writeSave(file_, first, sampler, {});
  Simulation second(scene, 1), whole(scene, 1);
  SettledSampler fromFile;
  readSave(file_, second, fromFile);
  const SettledMeasures found = runUntil(second, 0.3, fromFile), expected = runUntil(whole, 0.3);
  EXPECT_EQ(found.height, expected.height);
  EXPECT_EQ(found.rmsSpeed, expected.rmsSpeed);
  EXPECT_EQ(found.bulkSpacingP1, expected.bulkSpacingP1);
}

TEST_F(SaveFile, ASecondSaveIsTheSameFile) {
  saveAfter(smallDamBreak(), 5);
  const std::string first = content();
  Simulation simulation(smallDamBreak(), 2);
  SettledSampler sampler;
  readSave(file_, simulation, sampler);
  writeSave(file_, simulation, sampler, {});
  EXPECT_EQ(content(), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(SaveFile, WhatMayDifferDoes) {
  Scene scene = smallDamBreak();
  saveAfter(scene, 3);
  scene.name = "Another name";
  scene.description = "and what it shows";
  scene.duration = 99;
  scene.view.camera.eye = {1, 2, 3};
  scene.view.color = ColorField::gamma;
  scene.file = "elsewhere.json";
  EXPECT_EQ(faultsFor(scene), "");
}

TEST_F(SaveFile, EverythingElseIsNamed) {
  const Scene scene = smallDamBreak();
  saveAfter(scene, 3);
  struct Change {
    std::string pointer;
    std::function<void(Scene&)> make;
  };
  const std::vector<Change> changes{
      {"/particle_spacing", [](Scene& s) { s.particleSpacing = 0.04; }},
      {"/gravity", [](Scene& s) { s.gravity.x() = 1; }},
      {"/solver/tolerance", [](Scene& s) { s.solver.tolerance = 0.02; }},
      {"/solver/time_step", [](Scene& s) { s.solver.timeStep = 0.004; }},
      {"/solver/kernel", [](Scene& s) { s.solver.kernel = KernelType::cubicSpline; }},
      {"/boundary/handling", [](Scene& s) { s.boundary.handling = BoundaryHandling::none; }},
      {"/boundary/gamma/method", [](Scene& s) { s.boundary.gammaMethod = 1; }},
      {"/boundary/surfaces",
       [](Scene& s) {
         addTank(s, {-1, -1, -1}, {3, 3, 3});
       }},
      {"/boundary/surfaces/0/max",
       [](Scene& s) {
         s.surfaces.clear();
         addTank(s, Vec3d::Zero(), {0.9, 0.85, 0.3});
       }},
      {"/fluid",
       [](Scene& s) {
         addFluid(s, {0.5, 0, 0}, {0.6, 0.1, 0.1});
       }},
      {"/effects/viscosity", [](Scene& s) { s.effects.clear(); }},
  };
  for (const Change& change : changes) {
    Scene changed = scene;
    change.make(changed);
    const std::string faults = faultsFor(changed);
    EXPECT_EQ(faults.find(file_.string() + ":/scene" + change.pointer + ": expected "), 0U)
        << change.pointer << "\n"
        << faults;
    EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 0) << "one fault only:\n" << faults;
  }
  Scene changed = scene;
  changed.particleSpacing = 0.04;
  changed.solver.tolerance = 0.02;
  EXPECT_NE(faultsFor(changed).find("run.save:/scene/particle_spacing: expected 0.04, found 0.05\n"),
            std::string::npos);
  EXPECT_NE(faultsFor(changed).find("run.save:/scene/solver/tolerance: expected 0.02, found 0.01; a save"),
            std::string::npos)
      << faultsFor(changed);
}

TEST_F(SaveFile, AMeshFileWithAnotherContentIsAnotherScene) {
  const auto writeCube = [&](double size) {
    std::ofstream out(folder_ / "cube.obj");
    for (int k = 0; k < 8; ++k)
      out << "v " << (k & 1) * size << " " << (k >> 1 & 1) * size << " " << (k >> 2) * size << "\n";
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  };
  const auto scene = [&] {
    return parseScene(R"({ "format": 1, "particle_spacing": 0.1,
                           "fluid": [ { "shape": "mesh", "file": "cube.obj" } ] })",
                      folder_ / "scene.json");
  };
  writeCube(0.5);
  saveAfter(scene(), 1);
  EXPECT_EQ(faultsFor(scene()), "");
  writeCube(0.6);
  EXPECT_NE(faultsFor(scene()).find("run.save:/scene/fluid/0/file/checksum: expected "), std::string::npos)
      << faultsFor(scene());
}

TEST_F(SaveFile, AMeshThatIsEditedWhileTheRunGoesOnIsAnotherScene) {
  const auto corner = [](const std::string& height) {
    return "v 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nv 0 0 " + height + "\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  };
  const auto scene = [&] {
    return parseScene(R"({ "format": 1, "particle_spacing": 0.1,
                           "fluid": [ { "shape": "mesh", "file": "corner.obj" } ] })",
                      folder_ / "scene.json");
  };
  std::ofstream(folder_ / "corner.obj") << corner("0.50");
  Simulation simulation(scene(), 1);
  simulation.advanceFrame();
  rewriteUnseen(folder_ / "corner.obj", corner("0.55"));
  SettledSampler sampler;
  writeSave(file_, simulation, sampler, {});
  EXPECT_NE(faultsFor(scene()).find("run.save:/scene/fluid/0/file/checksum: expected "), std::string::npos)
      << faultsFor(scene());
  rewriteUnseen(folder_ / "corner.obj", corner("0.50"));
  EXPECT_EQ(faultsFor(scene()), "") << "the mesh that the run has";
}

TEST_F(SaveFile, DamageIsFoundWhereverItIs) {
  const Scene scene = smallDamBreak();
  saveAfter(scene, 3);
  const std::string whole = content();
  for (std::size_t at = 0; at < whole.size(); at += at < 48 ? 1 : whole.size() / 61) {
    for (const int bit : {0, 7}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      setContent(damaged);
      EXPECT_NE(faultsFor(scene), "") << "byte " << at;
    }
  }
  for (std::size_t size = 0; size < whole.size(); size += size < 48 ? 1 : whole.size() / 31) {
    setContent(whole.substr(0, size));
    EXPECT_NE(faultsFor(scene), "") << size << " bytes";
  }
  setContent(whole + "x");
  EXPECT_NE(faultsFor(scene).find("something was added"), std::string::npos);
  setContent(whole.substr(0, whole.size() - 1));
  EXPECT_NE(faultsFor(scene).find("the end is missing"), std::string::npos);
  setContent(whole);
  EXPECT_EQ(faultsFor(scene), "") << "the test damages nothing else";
}

TEST_F(SaveFile, WhatIsNoSaveIsToldSo) {
  const Scene scene = smallDamBreak();
  EXPECT_EQ(faultsFor(scene), file_.string() + ": expected a save, found no such file");
  setContent("{ \"format\": 1 }");
  EXPECT_NE(faultsFor(scene).find("that migiwa simulate --save wrote, found something else"),
            std::string::npos);
  setContent("");
  EXPECT_NE(faultsFor(scene).find("found something else"), std::string::npos);

  saveAfter(scene, 1);
  std::string other = content();
  other[8] = 9;
  setContent(other);
  EXPECT_NE(faultsFor(scene).find("expected a save of version 1, found version 9"), std::string::npos);
  saveAfter(scene, 1);
  other = content();
  std::reverse(other.begin() + 12, other.begin() + 16);
  setContent(other);
  EXPECT_NE(faultsFor(scene).find("order of bytes"), std::string::npos);
}

TEST_F(SaveFile, NamesThatOnlyOneSideKnowsAreRefused) {
  const Scene scene = smallDamBreak();
  saveAfter(scene, 1);
  changeHeader([](Json&) {});
  EXPECT_EQ(faultsFor(scene), "") << "the change of nothing is allowed";
  changeHeader([](Json& header) { header["values"]["faucet"]["poured"] = 1; });
  EXPECT_NE(faultsFor(scene).find("only what this version of migiwa simulates, found \"/faucet/poured\""),
            std::string::npos)
      << faultsFor(scene);
  saveAfter(scene, 1);
  changeHeader([](Json& header) {
    header["arrays"].push_back({{"name", "faucet/drops"}, {"element_bytes", 4}, {"count", 0}});
  });
  EXPECT_NE(faultsFor(scene).find("\"faucet/drops\""), std::string::npos) << faultsFor(scene);
  saveAfter(scene, 1);
  changeHeader([](Json& header) { header["values"].erase("max_speed"); });
  EXPECT_NE(faultsFor(scene).find("expected \"/max_speed\", found none"), std::string::npos)
      << faultsFor(scene);
  saveAfter(scene, 1);
  changeHeader([](Json& header) {
    for (Json& entry : header["arrays"])
      if (entry["name"] == "particles/position") entry["name"] = "particles/place";
  });
  EXPECT_NE(faultsFor(scene).find("expected \"particles/position\", found none"), std::string::npos)
      << faultsFor(scene);
}

TEST_F(SaveFile, SaysWhatPositionsAreRelativeTo) {
  Scene far = smallDamBreak();
  far.origin = {431250, 0, -8700};
  saveAfter(far, 3);
  EXPECT_EQ(faultsFor(far), "");
  changeHeader([](Json& header) { header.erase("origin"); });
  EXPECT_NE(faultsFor(far).find(
                ":/origin: expected positions relative to [431250.0,0.0,-8700.0], found [0.0,0.0,0.0]"),
            std::string::npos)
      << faultsFor(far);
}

TEST_F(SaveFile, ContradictionsAreFound) {
  const Scene scene = smallDamBreak();
  const auto changed = [&](const std::function<void(Json&)>& change) {
    saveAfter(scene, 1);
    changeHeader(change);
    return faultsFor(scene);
  };
  EXPECT_NE(changed([](Json& h) { h["state_hash"] = "0123456789abcdef"; }).find("state hash"),
            std::string::npos);
  EXPECT_NE(changed([](Json& h) { h["arrays"][0]["count"] = 1U << 30; }).find("found too little"),
            std::string::npos);
  EXPECT_NE(changed([](Json& h) { h["arrays"][0]["element_bytes"] = 0; }), "");
  EXPECT_NE(changed([](Json& h) { h["values"]["frame"] = "soon"; }).find("header of a save"),
            std::string::npos);
  EXPECT_NE(changed([](Json& h) { h.erase("arrays"); }).find("header of a save"), std::string::npos);
  EXPECT_NE(changed([](Json& h) { std::swap(h["arrays"][0]["name"], h["arrays"][7]["name"]); }), "");
}

TEST_F(SaveFile, AFullDiskLeavesTheOldSave) {
  const Scene scene = smallDamBreak();
  saveAfter(scene, 2);
  const std::string old = content();
  fs::create_symlink("/dev/full", folder_ / "run.save.tmp");
  try {
    saveAfter(scene, 3);
    ADD_FAILURE() << "nobody noticed that the disk is full";
  } catch (const OutputError& error) {
    EXPECT_EQ(error.what(), file_.string() + ": could not be written: No space left on device");
  }
  EXPECT_EQ(content(), old);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(SaveFile, ARunThatFailedIsNotSaved) {
  Simulation simulation(blowUp(), 1, Guards::off);
  SettledSampler sampler;
  for (int k = 0; k < 200 && !simulation.stopped(); ++k) simulation.advanceFrame();
  ASSERT_TRUE(simulation.stopped());
  EXPECT_THROW(writeSave(file_, simulation, sampler, {}), InputError);
  EXPECT_FALSE(fs::exists(file_));
}

}  // namespace save_file_test
}  // namespace migiwa
