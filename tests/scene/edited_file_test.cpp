// Files that a scene names and that are edited in place: what is made of them is made of what they hold, and
// a scene stays the one that was read.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"
#include "core/slim/file.h"
#include "core/walls/slim_wall.h"
#include "tests/support/same_stamp.h"

namespace migiwa {
namespace edited_file_test {

namespace fs = std::filesystem;

/// A cube of 0.4 m; one corner of its top is at this height (m).
std::string cube(const std::string& corner) {
  return "v 0 0 0\nv 0.4 0 0\nv 0.4 0.4 0\nv 0 0.4 0\nv 0 0 0.4\nv 0.4 0 0.4\nv 0.4 0.4 " + corner +
         "\nv 0 0.4 0.4\nf 1 4 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
}
const Vec3f kAboveTheCorner(0.36F, 0.36F, 0.42F);

class EditedFile : public ::testing::Test {
 protected:
  EditedFile() {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::temp_directory_path() / name;
    fs::create_directories(folder_);
    if (const char* value = std::getenv("MIGIWA_CACHE")) before_ = value;
    setenv("MIGIWA_CACHE", (folder_ / "cache").c_str(), 1);
  }
  ~EditedFile() override {
    fs::remove_all(folder_);
    before_.empty() ? unsetenv("MIGIWA_CACHE") : setenv("MIGIWA_CACHE", before_.c_str(), 1);
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// A tank, so that its bounds are those of the scene, and a wall in it.
  Scene read(const std::string& wall) const {
    return parseScene(R"({ "format": 1, "particle_spacing": 0.05, "boundary": { "surfaces": [
        { "shape": "box", "fluid": "inside", "min": [-0.1, -0.1, -0.1], "max": [0.5, 0.5, 0.5] },
        { "fluid": "outside", )" +
                          wall + " } ] } }",
                      folder_ / "scene.json");
  }
  static float gamma(const Scene& scene, std::string_view method) {
    const auto names = gammaMethodNames();
    const auto index = static_cast<int>(std::find(names.begin(), names.end(), method) - names.begin());
    const Boundary walls(scene.surfaces);
    ThreadPool pool(2);
    const PickedGamma picked =
        makeGammaMethod(index, {walls, KernelType::poly6, 0.1F, 1024, 1000, scene.bounds(), &pool});
    const Float4 point(kAboveTheCorner);
    GammaSample sample;
    picked.method->evaluate({&point, 1}, {&sample, 1});
    return sample.gamma;
  }
  /// `other` in the place of what is in the file: its wall is another, and so is gamma.
  void expectOtherGamma(const std::string& wall, const fs::path& file, const std::string& other) const {
    const float before = gamma(read(wall), "baked");
    EXPECT_NEAR(before, gamma(read(wall), "directions"), 0.03F);
    testing::rewriteUnseen(file, other);
    const float expected = gamma(read(wall), "directions");
    ASSERT_GT(std::abs(expected - before), 0.1F) << "nothing would be seen";
    EXPECT_NEAR(gamma(read(wall), "baked"), expected, 0.03F);
  }

  fs::path folder_, before_;
};

TEST_F(EditedFile, BakedGammaIsThatOfTheMeshAsItIsNow) {
  const fs::path file = write("wall.obj", cube("0.4"));
  expectOtherGamma(R"("shape": "mesh", "file": "wall.obj")", file, cube("0.2"));
}

TEST_F(EditedFile, AnOrdinaryEditIsSeenToo) {
  const std::string wall = R"("shape": "mesh", "file": "wall.obj")";
  write("wall.obj", cube("0.4"));
  const float before = gamma(read(wall), "baked");
  write("wall.obj", cube("0.2") + "# edited\n");
  const Scene edited = read(wall);
  const float expected = gamma(edited, "directions");
  ASSERT_GT(std::abs(expected - before), 0.1F) << "nothing would be seen";
  EXPECT_NEAR(gamma(edited, "baked"), expected, 0.03F);
}

TEST_F(EditedFile, BakedGammaIsThatOfTheFittedMeshAsItIsNow) {
  const fs::path file = write("wall.obj", cube("0.4"));
  expectOtherGamma(R"("shape": "slim", "mesh": "wall.obj", "degree": 1, "nodes": 1500)", file, cube("0.2"));
}

TEST_F(EditedFile, BakedGammaIsThatOfTheSlimFileAsItIsNow) {
  const auto slim = [&](const std::string& corner) {
    SlimSource source;
    source.file = write("corner" + corner + ".obj", cube(corner));
    source.degree = 1;
    source.nodes = 1500;
    const std::shared_ptr<const SlimWallData> data = prepareSlim(source);
    SlimData file;
    file.nodes.assign(data->model->nodes().begin(), data->model->nodes().end());
    return slimFileText(file);
  };
  std::string high = slim("0.4"), low = slim("0.2");
  const std::size_t size = std::max(high.size(), low.size());
  high.resize(size, '\n'), low.resize(size, '\n');
  const fs::path file = write("wall.slim.json", high);
  expectOtherGamma(R"("shape": "slim", "file": "wall.slim.json")", file, low);
}

TEST_F(EditedFile, ASceneIsTheOneThatWasRead) {
  for (const std::string shape : {"\"shape\": \"mesh\", \"file\"", "\"shape\": \"slim\", \"mesh\""}) {
    const fs::path file = write("wall.obj", cube("0.4"));
    const std::string wall = shape + ": \"wall.obj\"";
    const Scene first = read(wall);
    const Json identity = sceneIdentity(first);
    testing::rewriteUnseen(file, cube("0.2"));
    EXPECT_EQ(sceneIdentity(first), identity) << "what is in the file now is not what was read";
    const Json other = sceneIdentity(read(wall));
    const auto faults = identityFaults(identity, other);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_TRUE(faults[0].pointer.starts_with("/boundary/surfaces/1/")) << faults[0].pointer;
    EXPECT_TRUE(faults[0].pointer.ends_with("/checksum")) << faults[0].pointer;
    testing::rewriteUnseen(file, cube("0.4"));
    EXPECT_EQ(sceneIdentity(read(wall)), identity);
  }
}

TEST_F(EditedFile, AFitHasNoErrorAgainstAnotherShape) {
  const fs::path file = write("wall.obj", cube("0.4"));
  const Scene scene = read(R"("shape": "slim", "mesh": "wall.obj", "degree": 1, "nodes": 1500)");
  EXPECT_LT(scene.surfaces[1]->fitError().value_or(1), 0.01);
  testing::rewriteUnseen(file, cube("0.2"));
  EXPECT_FALSE(scene.surfaces[1]->fitError().has_value());
}

}  // namespace edited_file_test
}  // namespace migiwa
