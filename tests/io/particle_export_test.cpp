// Exported particles, read back by others than those who wrote them.
#include "core/io/particle_export.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/messages.h"
#include "core/simulation/simulation.h"
#include "tests/io/particle_files.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace particle_export_test {

using namespace migiwa::testing;
namespace fs = std::filesystem;
using Json = nlohmann::json;

const ParticleFormat& formatNamed(std::string_view name) {
  for (const ParticleFormat& format : particleFormats())
    if (format.name == name) return format;
  throw std::runtime_error("no such format");
}

std::string contentOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// A fluid in motion, whose particles are not in the order of their ids any more.
class ParticleFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("migiwa_export_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    for (int k = 0; k < 30; ++k) simulation_.advanceFrame();
    const FrameView view = simulation_.view();
    ASSERT_FALSE(std::is_sorted(view.ids.begin(), view.ids.end())) << "the test needs them mixed";
    place_.resize(view.ids.size());
    for (std::size_t k = 0; k < place_.size(); ++k) place_.at(view.ids[k]) = k;
  }
  void TearDown() override { fs::remove_all(folder_); }

  ExportOptions options(std::string_view format, std::vector<std::string> fields = {}) const {
    return {folder_, "drop", formatNamed(format), std::move(fields), "drop.json", {}};
  }
  ParticleFrame frame(const std::vector<std::string>& fields = {}) const {
    return copyParticles(simulation_.view(), simulation_.frame(), fields);
  }
  std::string fileOf(std::string_view format, const std::vector<std::string>& fields) const {
    ParticleExport exporter(options(format, fields), 0);
    exporter.add(frame(fields));
    exporter.finish();
    return contentOf(folder_ / ("drop_000000." + std::string(format)));
  }
  /// Holds a column against the state, particle by particle in the order of ids.
  template <class Value>
  void expectColumn(const ParticleTable& table, const std::string& name, const Value& value) const {
    ASSERT_TRUE(table.columns.contains(name)) << name;
    const std::vector<std::uint32_t>& column = table.columns.at(name);
    ASSERT_EQ(column.size(), place_.size()) << name;
    for (std::size_t id = 0; id < place_.size(); ++id)
      ASSERT_EQ(column[id], std::bit_cast<std::uint32_t>(value(place_[id]))) << name << " of " << id;
  }
  void expectTable(const ParticleTable& table, const std::array<std::string, 3>& position,
                   const std::array<std::string, 3>& velocity) const {
    const FrameView view = simulation_.view();
    EXPECT_EQ(table.count, view.positions.size());
    EXPECT_EQ(table.columns.size(), 11U);
    expectColumn(table, position[0], [&](std::size_t k) { return view.positions[k].x; });
    expectColumn(table, position[1], [&](std::size_t k) { return view.positions[k].y; });
    expectColumn(table, position[2], [&](std::size_t k) { return view.positions[k].z; });
    expectColumn(table, velocity[0], [&](std::size_t k) { return view.velocities[k].x; });
    expectColumn(table, velocity[1], [&](std::size_t k) { return view.velocities[k].y; });
    expectColumn(table, velocity[2], [&](std::size_t k) { return view.velocities[k].z; });
    expectColumn(table, "density", [&](std::size_t k) { return view.density[k]; });
    expectColumn(table, "gamma", [&](std::size_t k) { return view.gamma[k]; });
    expectColumn(table, "lambda", [&](std::size_t k) { return view.lambda[k]; });
    expectColumn(table, "neighbours", [&](std::size_t k) { return view.neighbours[k]; });
    expectColumn(table, "id", [&](std::size_t k) { return view.ids[k]; });
  }

  fs::path folder_;
  Simulation simulation_{smallDamBreak(), 1};
  std::vector<std::size_t> place_;  ///< of each id in the state
};

const std::vector<std::string> kAllFields{"velocity", "density", "gamma", "lambda", "neighbours", "id"};

TEST_F(ParticleFiles, PlyHoldsEveryBitInTheOrderOfIds) {
  expectTable(readPly(fileOf("ply", kAllFields)), {"x", "y", "z"}, {"vx", "vy", "vz"});
}

TEST_F(ParticleFiles, VtkHoldsEveryBitInTheOrderOfIds) {
  expectTable(readVtk(fileOf("vtk", kAllFields)), {"position0", "position1", "position2"},
              {"velocity0", "velocity1", "velocity2"});
}

TEST_F(ParticleFiles, AssimpReadsPlyAndObj) {
  for (const char* format : {"ply", "obj"}) {
    fileOf(format, {});
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((folder_ / ("drop_000000." + std::string(format))).string(), 0);
    ASSERT_NE(scene, nullptr) << format << ": " << importer.GetErrorString();
    ASSERT_EQ(scene->mNumMeshes, 1U) << format;
    const aiMesh& mesh = *scene->mMeshes[0];
    ASSERT_EQ(mesh.mNumVertices, place_.size()) << format;
    // The reader of text rounds in its last digit, and the binary one does not.
    const float allowed = std::string_view(format) == "obj" ? 1e-6F : 0;
    for (std::size_t id = 0; id < place_.size(); ++id) {
      const Float4& p = simulation_.view().positions[place_[id]];
      ASSERT_NEAR(mesh.mVertices[id].x, p.x, allowed) << format;
      ASSERT_NEAR(mesh.mVertices[id].y, p.y, allowed) << format;
      ASSERT_NEAR(mesh.mVertices[id].z, p.z, allowed) << format;
    }
  }
}

TEST_F(ParticleFiles, ObjDigitsAreTheNumberItself) {
  std::istringstream lines(fileOf("obj", {}));
  std::size_t id = 0, points = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("p ")) {
      EXPECT_EQ(std::stoul(line.substr(2)), ++points);
    }
    if (!line.starts_with("v ")) continue;
    std::istringstream words(line.substr(2));
    std::string x, y, z;
    words >> x >> y >> z;
    const Float4& p = simulation_.view().positions[place_.at(id++)];
    ASSERT_EQ(std::strtof(x.c_str(), nullptr), p.x);
    ASSERT_EQ(std::strtof(y.c_str(), nullptr), p.y);
    ASSERT_EQ(std::strtof(z.c_str(), nullptr), p.z);
  }
  EXPECT_EQ(id, place_.size());
  EXPECT_EQ(points, place_.size());
}

template <class Number>
Number numberAt(const std::string& text, std::size_t at, std::endian order) {
  std::array<char, sizeof(Number)> bytes{};
  text.copy(bytes.data(), bytes.size(), at);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

// A float at 431 km tells 3 cm apart.
TEST_F(ParticleFiles, PositionsFarFromZeroAreInDouble) {
  const Vec3d origin(431250, 0, -8700);
  for (const char* format : {"ply", "vtk", "obj"}) {
    ParticleExport exporter(options(format, {}), 0);
    exporter.add(copyParticles(simulation_.view(), simulation_.frame(), {}, origin));
    exporter.finish();
  }
  const std::string ply = contentOf(folder_ / "drop_000000.ply"),
                    vtk = contentOf(folder_ / "drop_000000.vtk"),
                    obj = contentOf(folder_ / "drop_000000.obj");
  EXPECT_NE(ply.find("\nproperty double x\nproperty double y\nproperty double z\nend_header\n"), ply.npos);
  const std::string points = "\nPOINTS " + std::to_string(place_.size()) + " double\n";
  ASSERT_NE(vtk.find(points), vtk.npos);
  std::size_t inPly = ply.find("end_header\n") + 11, inVtk = vtk.find(points) + points.size();
  EXPECT_EQ(ply.size(), inPly + place_.size() * 24);
  std::istringstream words(obj.substr(obj.find("\nv ")));
  for (std::size_t id = 0; id < place_.size(); ++id) {
    const Vec3d p = origin + simulation_.view().positions[place_[id]].xyz().cast<double>();
    std::string word;
    words >> word;
    ASSERT_EQ(word, "v");
    for (int axis = 0; axis < 3; ++axis, inPly += 8, inVtk += 8) {
      ASSERT_EQ(numberAt<double>(ply, inPly, std::endian::little), p[axis]);
      ASSERT_EQ(numberAt<double>(vtk, inVtk, std::endian::big), p[axis]);
      words >> word;
      ASSERT_EQ(std::strtod(word.c_str(), nullptr), p[axis]);
    }
  }
}

TEST_F(ParticleFiles, IdsWithGapsAreSortedToo) {
  ParticleFrame sparse;
  sparse.ids = {70, 5, 4'000'000'000, 6};
  sparse.positions = {{7, 0, 0}, {5, 0, 0}, {4, 0, 0}, {6, 0, 0}};
  sparse.sortById();
  EXPECT_EQ(sparse.ids, (std::vector<std::uint32_t>{5, 6, 70, 4'000'000'000}));
  EXPECT_EQ(sparse.positions[2][0], 7);
}

TEST_F(ParticleFiles, AnEmptyFrameIsAFileToo) {
  FrameSnapshot nothing;
  for (const char* format : {"ply", "vtk", "obj"}) {
    ParticleExport exporter(options(format, {"velocity", "id"}), 0);
    exporter.add(copyParticles(nothing.view(), 0, std::vector<std::string>{"velocity", "id"}));
    exporter.finish();
  }
  EXPECT_EQ(readPly(contentOf(folder_ / "drop_000000.ply")).count, 0U);
  EXPECT_NE(contentOf(folder_ / "drop_000000.ply").find("property float vx\n"), std::string::npos);
  const ParticleTable table = readVtk(contentOf(folder_ / "drop_000000.vtk"));
  EXPECT_EQ(table.count, 0U);
  for (const char* name : {"velocity0", "velocity1", "velocity2", "id"})
    EXPECT_TRUE(table.columns.contains(name)) << name;
}

TEST_F(ParticleFiles, NoneIsLostAndTheRunIsTheSame) {
  constexpr int kFrames = 60;
  Simulation quiet(smallDamBreak(), 1), watched(smallDamBreak(), 2);
  ParticleExport exporter(options("ply", kAllFields), 0);
  std::vector<std::string> hashes;
  for (int k = 0; k < kFrames; ++k) {
    quiet.advanceFrame(), watched.advanceFrame();
    exporter.add(copyParticles(watched.view(), watched.frame(), kAllFields));
    EXPECT_EQ(quiet.stateHash(), watched.stateHash());
  }
  exporter.finish();
  const Json list = Json::parse(contentOf(folder_ / "drop.ply.json"));
  ASSERT_EQ(list["files"].size(), static_cast<std::size_t>(kFrames));
  for (int k = 0; k < kFrames; ++k) {
    const Json& entry = list["files"][static_cast<std::size_t>(k)];
    EXPECT_EQ(entry["frame"], k + 1);
    EXPECT_NEAR(entry["time"].get<double>(), (k + 1) * 0.005, 1e-9);
    EXPECT_EQ(readPly(contentOf(folder_ / entry["file"].get<std::string>())).count, 288U);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), kFrames + 1);
}

TEST_F(ParticleFiles, TheSeriesOfVtkFilesHasTheirTimes) {
  fileOf("vtk", {});
  const Json series = Json::parse(contentOf(folder_ / "drop.vtk.series"));
  EXPECT_EQ(series["file-series-version"], "1.0");
  ASSERT_EQ(series["files"].size(), 1U);
  EXPECT_EQ(series["files"][0]["name"], "drop_000000.vtk");
  EXPECT_EQ(series["files"][0]["time"], 0.15);
}

TEST_F(ParticleFiles, AFullDiskEndsTheSequenceWithWholeFiles) {
  fs::create_directories(folder_);
  fs::create_symlink("/dev/full", folder_ / "drop_000002.ply.tmp");
  ParticleExport exporter(options("ply"), 0);
  std::string fault;
  try {
    for (int k = 0; k < 20; ++k) exporter.add(frame());
    exporter.finish();
  } catch (const OutputError& error) {
    fault = error.what();
  }
  EXPECT_EQ(fault,
            (folder_ / "drop_000002.ply").string() + ": could not be written: No space left on device");
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
    names.insert(entry.path().filename().string());
  EXPECT_EQ(names, (std::set<std::string>{"drop_000000.ply", "drop_000001.ply", "drop.ply.json"}));
  EXPECT_EQ(Json::parse(contentOf(folder_ / "drop.ply.json"))["files"].size(), 2U);
}

TEST_F(ParticleFiles, AFlushedFrameIsThere) {
  ParticleExport exporter(options("ply"), 0);
  for (int k = 0; k < 5; ++k) exporter.add(frame());
  exporter.flush();
  EXPECT_TRUE(fs::exists(folder_ / "drop_000004.ply"));
  EXPECT_EQ(Json::parse(contentOf(folder_ / "drop.ply.json"))["files"].size(), 5U);
}

TEST_F(ParticleFiles, AListGoesOnWhereARunDoes) {
  {
    ParticleExport first(options("ply"), 0);
    for (int k = 0; k < 4; ++k) first.add(frame());
  }
  ParticleExport second(options("ply"), 2);
  second.add(frame());
  second.finish();
  EXPECT_EQ(second.laterFiles(), 1) << "the fourth is of the run before";
  const Json list = Json::parse(contentOf(folder_ / "drop.ply.json"));
  ASSERT_EQ(list["files"].size(), 3U);
  EXPECT_EQ(list["files"][2]["file"], "drop_000002.ply");

  std::ofstream(folder_ / "drop.ply.json") << "[]";
  EXPECT_THROW(ParticleExport(options("ply"), 2), InputError);
}

/// Frames nearest to k times `every`, with halves rounded up, in whole microseconds.
std::set<long> nearestFrames(long every, long timeStep, long last) {
  std::set<long> frames;
  for (long k = 0;; ++k) {
    const long frame = (2 * k * every + timeStep) / (2 * timeStep);
    if (frame > last) return frames;
    frames.insert(frame);
  }
}

TEST(ExportSchedule, PicksTheNearestFrames) {
  for (const long timeStep : {5000L, 4000L, 8333L, 1L}) {
    for (const long every : {1L, 2500L, 5000L, 7500L, 12345L, 33333L, 40000L, 41667L, 100000L, 1000000L}) {
      const ExportSchedule schedule(static_cast<double>(every) * 1e-6, static_cast<double>(timeStep) * 1e-6);
      const long last = 3000;
      const std::set<long> expected = nearestFrames(every, timeStep, last);
      long count = 0;
      for (long frame = 0; frame <= last; ++frame) {
        ASSERT_EQ(schedule.countBefore(frame), count) << every << " " << timeStep << " " << frame;
        ASSERT_EQ(schedule.due(frame), expected.contains(frame)) << every << " " << timeStep << " " << frame;
        count += expected.contains(frame) ? 1 : 0;
      }
    }
  }
}

}  // namespace particle_export_test
}  // namespace migiwa
