// What would not fit into memory is refused before it is asked for, whatever would take it: under a limit of
// the process, as `ulimit -v` sets it, tens of MiB above what it has.
#include <algorithm>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/sources.h"
#include "core/simulation/simulation.h"
#include "core/walls/gridded.h"
#include "core/walls/shapes.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace memory_limit_test {

constexpr double kMiB = 1024.0 * 1024;

class MemoryLimit : public ::testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take terabytes of addresses";
#endif
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before_), 0);
    double pages = 0;
    ASSERT_TRUE(std::ifstream("/proc/self/statm") >> pages);
    rlimit any = before_;
    any.rlim_cur = static_cast<rlim_t>(pages * static_cast<double>(sysconf(_SC_PAGESIZE)) + 24 * kMiB);
    ASSERT_EQ(setrlimit(RLIMIT_AS, &any), 0);
  }
  void TearDown() override {
    setrlimit(RLIMIT_AS, &before_);
  }

  static std::string refusalOf(const std::function<void()>& body) {
    try {
      body();
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  }
  static void expectRefusal(const std::string& place, const std::string& what,
                            const std::function<void()>& body) {
    const std::string refusal = refusalOf(body);
    EXPECT_EQ(refusal.find(place + ": expected " + what + " with room in the "), 0U) << refusal;
  }
  static int gammaMethod(std::string_view name) {
    const auto names = gammaMethodNames();
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  }

 private:
  rlimit before_{};
};

TEST_F(MemoryLimit, IsKnown) {
  EXPECT_GT(availableMemory(), 20 * kMiB);
  EXPECT_LE(availableMemory(), 24 * kMiB);
  EXPECT_NO_THROW(requireMemory(10 * kMiB, "it", "here"));
  expectRefusal("here", "it", [] { requireMemory(30 * kMiB, "it", "here"); });
}

TEST_F(MemoryLimit, HoldsForParticles) {
  Scene scene = emptyScene();
  addFluid(scene, Vec3d::Zero(), Vec3d::Constant(40 * kSpacing));
  expectRefusal("test.json:/particle_spacing", "particles", [&] { const Simulation simulation(scene, 1); });
}

TEST_F(MemoryLimit, IsAskedBeforeAMeshIsFilled) {
  Scene scene = emptyScene();
  scene.fluid.push_back(std::make_shared<MeshSource>(
      boxMesh(Vec3d::Zero(), {5, 0, 0}, {0, 5, 0}, {0, 0, 5})));  // a million particles
  expectRefusal("test.json:/particle_spacing", "particles", [&] { const Simulation simulation(scene, 1); });
}

TEST_F(MemoryLimit, IsEnoughForANeedleWithAHugeBox) {
  // Of the box's columns of cells alone, a number each would not have room.
  const MeshSource needle(slantedNeedle(160, 0.12));
  std::vector<Vec3d> centers;
  needle.fill(kSpacing, centers);
  EXPECT_GT(centers.size(), 10000U);
}

TEST_F(MemoryLimit, HoldsForALayerOfAnEmitterThatComesLater) {
  Scene scene = emptyScene();
  Emitter emitter;
  emitter.radius = 150 * kSpacing, emitter.speed = 1, emitter.start = 100;
  emitter.particles = 1000000;
  scene.emitters = {emitter};
  expectRefusal("test.json:/emitters/0", "the particles of a layer",
                [&] { const Simulation simulation(scene, 1); });
}

TEST_F(MemoryLimit, HoldsForGridsOfGamma) {
  Scene scene = emptyScene();
  scene.surfaces.push_back(std::make_shared<Sphere>(Vec3d::Zero(), 40 * kSpacing, Sphere::Fluid::inside));
  scene.boundary.gammaMethod = gammaMethod("baked");
  expectRefusal("test.json:/boundary/gamma/method", "a grid of gamma",
                [&] { const Simulation simulation(scene, 1); });
}

TEST_F(MemoryLimit, HoldsForGridsOfDistances) {
  const auto sphere = std::make_shared<Sphere>(Vec3d::Zero(), 80 * kSpacing, Sphere::Fluid::inside);
  expectRefusal("there", "a grid of wall distances", [&] {
    ThreadPool pool(1);
    const GriddedSurface surface(sphere, static_cast<float>(2 * kSpacing), pool, "there");
  });
}

TEST_F(MemoryLimit, HoldsForBoundaryParticles) {
  Scene scene = emptyScene();
  addTank(scene, Vec3d::Zero(), Vec3d::Constant(100 * kSpacing));
  const auto names = handlingNames();
  scene.boundary.handling =
      static_cast<BoundaryHandling>(std::find(names.begin(), names.end(), "particles") - names.begin());
  expectRefusal("test.json:/boundary/handling", "boundary particles",
                [&] { const Simulation simulation(scene, 1); });
}

TEST_F(MemoryLimit, StopsEmitters) {
  Scene scene = emptyScene();
  Emitter emitter;
  emitter.shape = MouthShape::rectangle;
  emitter.size = {60 * kSpacing, 60 * kSpacing};
  emitter.speed = 40;
  emitter.particles = 1000000;
  scene.emitters = {emitter};
  Simulation simulation(scene, 1);
  const auto stopped = [&] {
    for (const Trouble& trouble : simulation.statistics().trouble)
      if (trouble.kind == "emitter_memory") return true;
    return false;
  };
  for (int frame = 0; frame < 20 && !stopped(); ++frame) simulation.advanceFrame();
  EXPECT_TRUE(stopped());
  EXPECT_FALSE(simulation.stopped()) << "what there is goes on";
  EXPECT_GT(simulation.view().positions.size(), 3600U);
}

}  // namespace memory_limit_test
}  // namespace migiwa::testing
