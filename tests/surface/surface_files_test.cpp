// Meshes as files, read by a reader of the test's own; and exported particles read back.
#include "core/io/surface_files.h"

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/io/particle_export.h"

namespace migiwa {
namespace surface_files_test {

SurfaceMesh tetrahedron() {
  SurfaceMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1F}};
  mesh.normals = {{-0.6F, -0.8F, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.velocities = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {-1, -2, -3.5F}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.wet = {1, 0, 0, 1};
  return mesh;
}

std::string textOf(const SurfaceMesh& mesh, std::string_view format, const Vec3d& origin = Vec3d::Zero()) {
  for (const SurfaceFormat& known : surfaceFormats())
    if (known.name == format) return known.text({mesh, 0.25, origin});
  ADD_FAILURE() << "no format " << format;
  return {};
}

template <class T>
T take(const std::string& text, std::size_t& at) {
  T value;
  std::memcpy(&value, text.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

TEST(SurfaceFiles, PlyHoldsAllOfAMesh) {
  const SurfaceMesh mesh = tetrahedron();
  const std::string text = textOf(mesh, "ply");
  const std::size_t end = text.find("end_header\n");
  ASSERT_NE(end, std::string::npos);
  EXPECT_NE(text.find("comment time 0.250000 s\n"), std::string::npos);
  // The properties in the order of the header, whatever it is.
  std::istringstream header(text.substr(0, end));
  std::vector<std::string> names;
  for (std::string line; std::getline(header, line);)
    if (line.starts_with("property float ")) names.push_back(line.substr(15));
  ASSERT_EQ(names.size(), 9u);
  std::size_t at = end + 11;
  for (std::size_t v = 0; v < 4; ++v) {
    std::map<std::string, float> values;
    for (const std::string& name : names) values[name] = take<float>(text, at);
    EXPECT_EQ(Vec3f(values["x"], values["y"], values["z"]), mesh.positions[v]);
    EXPECT_EQ(Vec3f(values["nx"], values["ny"], values["nz"]), mesh.normals[v]);
    EXPECT_EQ(Vec3f(values["vx"], values["vy"], values["vz"]), mesh.velocities[v]);
  }
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_EQ(take<std::uint8_t>(text, at), 3);
    for (const std::uint32_t v : mesh.triangles[t]) EXPECT_EQ(take<std::uint32_t>(text, at), v);
    EXPECT_EQ(take<std::uint8_t>(text, at), mesh.wet[t]);
  }
  EXPECT_EQ(at, text.size());
}

TEST(SurfaceFiles, ObjHasGroupsOfFreeAndWetFaces) {
  const SurfaceMesh mesh = tetrahedron();
  std::istringstream text(textOf(mesh, "obj"));
  std::vector<Vec3f> positions, normals;
  std::map<std::string, int> faces;
  std::string group;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    Vec3f p;
    if (word == "v" || word == "vn") {
      words >> p.x() >> p.y() >> p.z();
      (word == "v" ? positions : normals).push_back(p);
    }
    if (word == "g") words >> group;
    if (word == "f") ++faces[group];
  }
  EXPECT_EQ(positions, mesh.positions);
  EXPECT_EQ(normals, mesh.normals);
  EXPECT_EQ(faces["free"], 2);
  EXPECT_EQ(faces["wet"], 2);
}

TEST(SurfaceFiles, FarFromZeroPositionsAreDoubles) {
  const Vec3d origin(1e6, 0, 0);
  const std::string ply = textOf(tetrahedron(), "ply", origin);
  ASSERT_NE(ply.find("property double x\n"), std::string::npos);
  std::size_t at = ply.find("end_header\n") + 11 + 3 * 48;
  EXPECT_EQ(take<double>(ply, at), 1e6);
  take<double>(ply, at);
  EXPECT_NEAR(take<double>(ply, at), 0.1, 1e-7);
  EXPECT_NE(textOf(tetrahedron(), "obj", origin).find("v 1000001 0 0\n"), std::string::npos);
}

class ParticleImport : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("import_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { std::filesystem::remove(file_); }

  ImportedParticles read(const std::string& text, const Vec3d& origin = Vec3d::Zero()) {
    writeTextFile(file_, text);
    return readParticles(file_, origin);
  }
  std::string faultOf(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "was read";
    return {};
  }

  std::filesystem::path file_;
};

ParticleFrame someParticles() {
  ParticleFrame frame;
  frame.time = 1.5;
  frame.positions = {{0, 1, 2}, {0.5F, -0.25F, 1e-3F}, {3, 4, 5}};
  frame.ids = {0, 1, 2};
  ParticleField velocity{"velocity", ParticleField::Kind::vectors, {}, {}, {}};
  velocity.vectors = {{1, 0, 0}, {0, 1, 0}, {0, 0, -2}};
  ParticleField density{"density", ParticleField::Kind::numbers, {}, {1, 2, 3}, {}};
  frame.fields = {density, velocity};
  return frame;
}

TEST_F(ParticleImport, ReadsWhatWasExported) {
  for (const ParticleFormat& format : {plyFormat(), vtkFormat()}) {
    for (const Vec3d& origin : {Vec3d(0, 0, 0), Vec3d(1e7, 0, -3)}) {
      ParticleFrame frame = someParticles();
      frame.origin = origin;
      const ImportedParticles particles = read(format.text(frame), origin);
      ASSERT_EQ(particles.positions.size(), 3u) << format.name;
      ASSERT_EQ(particles.velocities.size(), 3u) << format.name;
      EXPECT_EQ(particles.time, 1.5);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto &p = frame.positions[k], &u = frame.fields[1].vectors[k];
        EXPECT_LT((particles.positions[k].xyz() - Vec3f(p[0], p[1], p[2])).norm(),
                  1e-8F + (origin.isZero(0) ? 0 : 1e-8F));
        EXPECT_EQ(particles.velocities[k].xyz(), Vec3f(u[0], u[1], u[2]));
      }
    }
  }
}

TEST_F(ParticleImport, AFrameWithoutParticlesIsAFrame) {
  ParticleFrame frame = someParticles();
  frame.positions.clear();
  frame.ids.clear();
  for (ParticleField& field : frame.fields) {
    field.vectors.clear();
    field.numbers.clear();
  }
  for (const ParticleFormat& format : {plyFormat(), vtkFormat()}) {
    const ImportedParticles particles = read(format.text(frame));
    EXPECT_TRUE(particles.positions.empty()) << format.name;
    EXPECT_EQ(particles.time, 1.5) << format.name;
  }
}

/// Arrays of a FIELD in any order beside "velocity", or VECTORS; big-endian, as the format has it.
TEST_F(ParticleImport, ReadsTheVelocitiesOfAnyVtk) {
  const auto bytes = [](std::initializer_list<float> values) {
    std::string text;
    for (const float value : values) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (const int shift : {24, 16, 8, 0}) text += static_cast<char>(bits >> shift & 0xFFU);
    }
    return text;
  };
  const std::string points =
      "# vtk DataFile Version 4.2\nvtk output\nBINARY\nDATASET POLYDATA\nPOINTS 2 float\n" +
      bytes({0, 1, 2, 3, 4, 5}) + "\n\nPOINT_DATA 2\n";
  for (const std::string& data :
       {"FIELD FieldData 3\npressure 1 2 float\n" + bytes({1, 2}) + "\nrelative_velocity 3 2 float\n" +
            bytes({9, 9, 9, 9, 9, 9}) + "\nvelocity 3 2 float\n" + bytes({1, 0, 0, 0, 0, -2}) + "\n",
        "SCALARS pressure float 1\nLOOKUP_TABLE default\n" + bytes({1, 2}) + "\nVECTORS velocity float\n" +
            bytes({1, 0, 0, 0, 0, -2}) + "\n"}) {
    const ImportedParticles particles = read(points + data);
    ASSERT_EQ(particles.positions.size(), 2u);
    EXPECT_EQ(particles.positions[1].xyz(), Vec3f(3, 4, 5));
    ASSERT_EQ(particles.velocities.size(), 2u);
    EXPECT_EQ(particles.velocities[1].xyz(), Vec3f(0, 0, -2));
  }
}

TEST_F(ParticleImport, ReadsAsciiOfOtherPrograms) {
  const ImportedParticles particles = read(
      "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty uchar red\r\nproperty float64 z\r\nproperty "
      "float x\r\n"
      "property float y\r\nelement face 0\r\nproperty list uchar int vertex_indices\r\nend_header\r\n7 3 1 "
      "2\r\n8 6 4 5\r\n");
  ASSERT_EQ(particles.positions.size(), 2u);
  EXPECT_EQ(particles.positions[1].xyz(), Vec3f(4, 5, 6));
  EXPECT_TRUE(particles.velocities.empty());
  EXPECT_FALSE(particles.time);
}

TEST_F(ParticleImport, NamesWhatIsWrong) {
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_NE(faultOf("solid of another kind\n").find("PLY or legacy VTK"), std::string::npos);
  EXPECT_NE(faultOf(header + xyz + "too short").find("24 more bytes"), std::string::npos);
  EXPECT_NE(faultOf(header + "property float x\nend_header\n").find("property y"), std::string::npos);
  EXPECT_NE(faultOf("ply\nformat binary_little_endian 1.0\nelement vertex 1e300\n" + xyz).find("1e300"),
            std::string::npos);
  EXPECT_NE(faultOf("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "1 nan 2\n").find("finite"),
            std::string::npos);
  EXPECT_NE(faultOf("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "1 2\n").find("expected a number"),
            std::string::npos);
  EXPECT_NE(faultOf(header + "property list uchar int x\n" + xyz).find("property TYPE NAME"),
            std::string::npos);
  EXPECT_NE(faultOf("# vtk DataFile Version 3.0\nx\nASCII\n").find("binary"), std::string::npos);
  EXPECT_NE(faultOf("# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\nPOINTS 5 float\nabc")
                .find("60 more bytes"),
            std::string::npos);
  EXPECT_NE(faultOf("ply\n").find("cut off"), std::string::npos);
}

}  // namespace surface_files_test
}  // namespace migiwa
