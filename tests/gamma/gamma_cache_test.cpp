// Grids of gamma on disk: found again, and never believed when they are not what was asked for.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/gamma/baked.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace gamma_cache_test {

namespace fs = std::filesystem;
using Surfaces = std::vector<std::shared_ptr<const Surface>>;

/// A cache of its own for every test.
class GammaCache : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / test->name();
    fs::remove_all(folder_);
    if (const char* value = std::getenv("MIGIWA_CACHE")) before_ = value;
    setenv("MIGIWA_CACHE", folder_.c_str(), 1);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    before_.empty() ? unsetenv("MIGIWA_CACHE") : setenv("MIGIWA_CACHE", before_.c_str(), 1);
  }

  static PickedGamma baked(const Boundary& boundary, KernelType kernel = KernelType::poly6, float h = 0.1F) {
    const auto names = gammaMethodNames();
    const auto index = static_cast<int>(std::find(names.begin(), names.end(), "baked") - names.begin());
    return makeGammaMethod(
        index, {boundary, kernel, h, 256, 1000, {}, nullptr, "scene.json:/boundary/gamma/method"});
  }
  static bool read(const PickedGamma& picked) { return picked.reason.find("read from") != std::string::npos; }
  static bool made(const PickedGamma& picked) { return picked.reason.find("made and") != std::string::npos; }
  static float at(const PickedGamma& picked, const Vec3f& p) {
    const Float4 point(p);
    GammaSample sample;
    picked.method->evaluate({&point, 1}, {&sample, 1});
    return sample.gamma;
  }
  fs::path onlyFile() const {
    fs::path file;
    int count = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) file = entry.path(), ++count;
    EXPECT_EQ(count, 1) << "and no temporary file left";
    return file;
  }

  fs::path folder_;
  std::string before_;
};

const Surfaces kBall{std::make_shared<Sphere>(Vec3d(0.1, 0, 0), 0.12, Sphere::Fluid::inside)};
const Vec3f kNearWall(0.1F, 0.08F, 0);

TEST_F(GammaCache, TheSecondStartReadsTheSameGrid) {
  const Boundary ball(kBall);
  const PickedGamma first = baked(ball), second = baked(ball);
  EXPECT_TRUE(made(first)) << first.reason;
  EXPECT_TRUE(read(second)) << second.reason;
  EXPECT_EQ(at(first, kNearWall), at(second, kNearWall));
  EXPECT_LT(at(first, kNearWall), 0.9F);
}

TEST_F(GammaCache, OtherParametersHaveGridsOfTheirOwn) {
  baked(Boundary(kBall));
  EXPECT_TRUE(made(baked(Boundary(kBall), KernelType::spiky)));
  EXPECT_TRUE(made(baked(Boundary(kBall), KernelType::poly6, 0.11F)));
  for (const auto& other : {std::make_shared<Sphere>(Vec3d(0.1, 0, 0), 0.1200001, Sphere::Fluid::inside),
                            std::make_shared<Sphere>(Vec3d(0.1, 0, 1e-9), 0.12, Sphere::Fluid::inside),
                            std::make_shared<Sphere>(Vec3d(0.1, 0, 0), 0.12, Sphere::Fluid::outside)})
    EXPECT_TRUE(made(baked(Boundary(Surfaces{other}))));
  EXPECT_TRUE(read(baked(Boundary(kBall))));
}

TEST_F(GammaCache, EveryFieldOfEveryShapeIsInTheKey) {
  std::vector<Surfaces> walls{kBall, {kBall[0], kBall[0]}, {}};
  walls.push_back({std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(0, 1, 0))});
  walls.push_back({std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(0, 1, 1e-7))});
  for (const double degrees : {0.0, 1e-5})
    for (const Box::Fluid fluid : {Box::Fluid::inside, Box::Fluid::outside})
      walls.push_back(
          {std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(1, 1, 1), fluid, Rotation{{0, 1, 0}, degrees})});
  for (const double c : {0.1, 0.2})
    walls.push_back({std::make_shared<Polynomial>(Vec3d::Zero(), Vec3d::UnitY(), Vec3d::UnitX(), 1,
                                                  std::vector<Polynomial::Term>{{2, 0, c}})});
  std::set<std::string> keys;
  for (const Surfaces& surfaces : walls) keys.insert(describeWalls(Boundary(surfaces)));
  EXPECT_EQ(keys.size(), walls.size());
}

TEST_F(GammaCache, WhatIsNotWholeOrNotItsOwnIsMadeAgain) {
  const Boundary ball(kBall);
  const float expected = at(baked(ball), kNearWall);
  const fs::path file = onlyFile();
  std::string whole;
  {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    whole = text.str();
  }
  std::vector<std::pair<const char*, std::string>> broken{
      {"empty", ""},
      {"cut in the header", whole.substr(0, 40)},
      {"cut in the data", whole.substr(0, whole.size() - 5)},
      {"too long", whole + "x"},
      {"of another program", "GIF89a" + whole}};
  for (const auto& [what, place] :
       {std::pair("a wrong version", std::size_t{8}), std::pair("a wrong size", std::size_t{30}),
        std::pair("another key", std::size_t{90}), std::pair("a flipped bit", whole.size() / 2),
        std::pair("a flipped last bit", whole.size() - 1), std::pair("a shifted origin", std::size_t{49})}) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 4);
    broken.emplace_back(what, changed);
  }
  for (const auto& [what, content] : broken) {
    SCOPED_TRACE(what);
    std::ofstream(file, std::ios::binary) << content;
    const PickedGamma again = baked(ball);
    EXPECT_TRUE(made(again)) << again.reason;
    EXPECT_EQ(at(again, kNearWall), expected);
    EXPECT_TRUE(read(baked(ball))) << "mended";
  }
}

TEST_F(GammaCache, WithoutAFolderToWriteToItWorksAndSaysSo) {
  setenv("MIGIWA_CACHE", "/dev/null/none", 1);
  const Boundary ball(kBall);
  const PickedGamma picked = baked(ball);
  EXPECT_TRUE(made(picked));
  EXPECT_NE(picked.reason.find("not kept"), std::string::npos) << picked.reason;
  EXPECT_TRUE(made(baked(ball)));
}

TEST_F(GammaCache, AGridBeyondMemoryIsRefusedBeforeItIsMade) {
  for (const double radius : {100.0, 1e4}) {
    const Boundary vast(Surfaces{std::make_shared<Sphere>(Vec3d::Zero(), radius, Sphere::Fluid::inside)});
    try {
      baked(vast);
      ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("GiB"), std::string::npos) << error.what();
      EXPECT_EQ(error.faults().front().place, "scene.json:/boundary/gamma/method");
    }
  }
}

}  // namespace gamma_cache_test
}  // namespace migiwa
