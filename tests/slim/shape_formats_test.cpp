// What formats and their writers are like: digits, far coordinates, counts that are wrong.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "core/slim/fit.h"
#include "tests/slim/exact_shapes.h"
#include "tests/slim/import_fixture.h"

namespace migiwa {
namespace shape_formats_test {

using namespace testing;

class ShapeFormats : public ShapeImport {};

/// A ball of triangles as text STL, every corner off by up to `noise` in each coordinate.
std::string ballStl(double radius, double noise, std::size_t& triangles) {
  constexpr int kRings = 12, kSectors = 24;
  RandomSequence random(3);
  std::ostringstream text;
  text.precision(12);
  text << "solid part\n";
  triangles = 0;
  const auto corner = [&](int ring, int sector) {
    const double polar = std::numbers::pi * ring / kRings, around = 2 * std::numbers::pi * sector / kSectors;
    Vec3d p = radius *
              Vec3d(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
    for (int axis = 0; axis < 3; ++axis) p[axis] += noise * (2 * random.unit() - 1);
    text << "vertex " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  };
  const auto facet = [&](const std::array<std::array<int, 2>, 3>& corners) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const auto& [ring, sector] : corners)
      corner(ring, ring == 0 || ring == kRings ? 0 : sector % kSectors);
    text << "endloop\nendfacet\n";
    ++triangles;
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      if (ring > 0) facet({{{ring, sector}, {ring, sector + 1}, {ring + 1, sector}}});
      if (ring + 1 < kRings) facet({{{ring, sector + 1}, {ring + 1, sector + 1}, {ring + 1, sector}}});
    }
  text << "endsolid part\n";
  return text.str();
}

TEST_F(ShapeFormats, WeldsCornersWithinAMillionthOfTheSize) {
  for (const double noise : {1e-9, 1e-8, 1e-7}) {
    std::size_t triangles = 0;
    const ImportedShape shape = importShape(write("cracks.stl", ballStl(0.15, noise, triangles)));
    EXPECT_TRUE(shape.closed) << noise;
    EXPECT_EQ(shape.mesh.triangles.size(), triangles) << noise;
    EXPECT_EQ(shape.mesh.vertices.size(), triangles / 2 + 2) << noise;  // Euler's formula
    ASSERT_EQ(shape.notes.size(), 1U) << noise;
    EXPECT_NE(shape.notes[0].find("welded to others within 5.2e-07 m"), std::string::npos) << shape.notes[0];
  }
  std::size_t triangles = 0;
  EXPECT_FALSE(importShape(write("open.stl", ballStl(0.15, 3e-6, triangles))).closed);
}

/// The cube moved by so much along x, in the words of a format, with so many digits.
std::string cubeObj(double east) {
  std::ostringstream text;
  text.precision(15);
  for (int k = 0; k < 8; ++k)
    text << "v " << east + (((k + 1) & 2) >> 1) * 0.1 << " " << ((k & 2) >> 1) * 0.1 << " " << (k >> 2) * 0.1
         << "\n";
  return text.str() + kCubeFaces;
}

std::string ballPly(double east, const std::string& format) {
  const bool binary = format != "ascii";
  std::ostringstream text;
  text.precision(15);
  const OrientedPoints ball = ExactSphere{}.points(500);
  text << "ply\nformat " << format
       << " 1.0\nelement vertex 500\nproperty double x\nproperty uchar red\nproperty double z\n"
       << "property double y\nend_header\n";
  for (const OrientedPoint& p : ball.points) {
    const std::array<double, 3> at{east + 0.1 * double(p.position.x()), 0.1 * double(p.position.z()),
                                   0.1 * double(p.position.y())};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!binary) {
        text << at[k] << (k == 0 ? " 7 " : " ");
        continue;
      }
      const auto bits = std::bit_cast<std::uint64_t>(at[k]);
      for (std::size_t byte = 0; byte < 8; ++byte)
        text << static_cast<char>(bits >> (8 * (format == "binary_big_endian" ? 7 - byte : byte)) & 0xFF);
      if (k == 0) text << '\7';
    }
    if (!binary) text << '\n';
  }
  return text.str();
}

TEST_F(ShapeFormats, FarCoordinatesAreMovedBackWithoutLoss) {
  // A float at 431 km has steps of 31 mm.
  constexpr double kEast = 431250.125;
  const Transform back{.scale = 10, .rotate = {}, .translate = {-10 * kEast, 0, 0}};
  const Transform near{.scale = 10, .rotate = {}, .translate = {0, 0, 0}};
  const auto compare = [&](const ImportedShape& far, const ImportedShape& close, std::size_t points) {
    const auto places = [](const ImportedShape& shape) {
      std::vector<std::array<float, 3>> all;
      for (const Vec3f& p : shape.mesh.vertices) all.push_back({p.x(), p.y(), p.z()});
      for (const OrientedPoint& p : shape.cloud.points)
        all.push_back({p.position.x(), p.position.y(), p.position.z()});
      return all;
    };
    const auto a = places(far), b = places(close);
    ASSERT_EQ(a.size(), points);
    ASSERT_EQ(b.size(), points);
    for (const auto& p : a) {
      float least = 1;
      for (const auto& q : b)
        least =
            std::min(least, std::max({std::abs(p[0] - q[0]), std::abs(p[1] - q[1]), std::abs(p[2] - q[2])}));
      EXPECT_LT(least, 2e-6F);
    }
  };
  ImportedShape far = importShape(write("far.obj", cubeObj(kEast))),
                close = importShape(write("near.obj", cubeObj(0)));
  EXPECT_TRUE(far.closed);
  transformShape(far, back);
  transformShape(close, near);
  compare(far, close, 8);
  EXPECT_NEAR(volumeOf(far.mesh), 1, 1e-5);
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    far = importShape(write("far.ply", ballPly(kEast, format)));
    close = importShape(write("near.ply", ballPly(0, format)));
    transformShape(far, back);
    transformShape(close, near);
    compare(far, close, 500);
  }
  std::string text = "solid far\n";
  const std::array<const char*, 4> corners{"431250.125 0 0", "431250.225 0 0", "431250.125 0.1 0",
                                           "431250.125 0 0.1"};
  for (const auto& face :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face)
      text += std::string("vertex ") + corners.at(static_cast<std::size_t>(corner)) + "\n";
    text += "endloop\nendfacet\n";
  }
  far = importShape(write("far.stl", text + "endsolid far\n"));
  EXPECT_TRUE(far.closed);
  transformShape(far, back);
  EXPECT_NEAR(volumeOf(far.mesh), 1.0 / 6, 1e-5);
}

TEST_F(ShapeFormats, ReadsXyzClouds) {
  const std::vector<OrientedPoint> points = ExactSphere{}.points(1000).points;
  const auto text = [&](double east, bool normals, const std::string& between) {
    std::ostringstream out;
    out.precision(12);
    out << "# x y z\n";
    for (const OrientedPoint& p : points) {
      out << east + double(p.position.x()) << between << p.position.y() << between << p.position.z();
      if (normals) out << between << p.normal.x() << between << p.normal.y() << between << p.normal.z();
      out << "\n";
    }
    return out.str();
  };
  for (const bool normals : {true, false})
    for (const std::string before :
         {"", "1000\n", "x,y,z\n", "//X Y Z Nx Ny Nz\n", "\n\"x\";\"y\";\"z\"\n"}) {
      const ImportedShape shape =
          importShape(write("ball.xyz", before + text(0, normals, before.empty() ? " " : ", ")));
      EXPECT_TRUE(shape.closed);
      ASSERT_EQ(shape.cloud.points.size(), 1000U);
      EXPECT_EQ(shape.notes.size(), normals ? 0U : 1U);
      for (const OrientedPoint& p : shape.cloud.points) ASSERT_GT(p.normal.dot(p.position), 0.98F);
    }
  ImportedShape far = importShape(write("far.XYZ", text(431250, true, "\t")));
  transformShape(far, {.scale = 1, .rotate = {}, .translate = {-431250, 0, 0}});
  for (const OrientedPoint& p : far.cloud.points) ASSERT_NEAR(p.position.norm(), 1, 1e-5F);
  EXPECT_EQ(faultOf(write("word.xyz", "0 0 0\n1 0 O\n")),
            "expected a line of numbers (x y z, or x y z nx ny nz) in line 2, found \"O\"");
  EXPECT_EQ(faultOf(write("late.xyz", "0 0 0\nx y z\n")),
            "expected a line of numbers (x y z, or x y z nx ny nz) in line 2, found \"x\"");
  EXPECT_EQ(faultOf(write("other.xyz", "x z y\n0 0 0\n")),
            "expected a line of numbers (x y z, or x y z nx ny nz) in line 1, found \"x\"");
  EXPECT_EQ(faultOf(write("short.xyz", "0 0 0\n1 0\n")),
            "expected 3 numbers in line 2, as in the lines before, found 2");
  EXPECT_EQ(faultOf(write("two.xyz", "0 0\n")),
            "expected 3 or 6 numbers in line 1 (x y z, or x y z nx ny nz), found 2");
  EXPECT_EQ(faultOf(write("early.xyz", "3\n0 0 0\n1 0 0\n")),
            "expected 3 points, as the first line says, found 2");
  EXPECT_EQ(faultOf(write("few.xyz", "0 0 0\n1 0 0\n")),
            "expected a mesh, or at least 50 points, found 2 points");
}

TEST_F(ShapeFormats, ReadsStlWithWordsInCapitals) {
  std::size_t triangles = 0;
  std::string text = ballStl(0.15, 0, triangles);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const ImportedShape shape = importShape(write("CAPITALS.STL", text));
  EXPECT_TRUE(shape.closed);
  EXPECT_EQ(shape.mesh.triangles.size(), triangles);
  std::string cut = text.substr(0, text.rfind("VERTEX"));
  EXPECT_EQ(faultOf(write("cut.stl", cut)), "expected 3 corners in facet " + std::to_string(triangles) +
                                                ", found 2: the file ends there; export the file anew");
  EXPECT_EQ(faultOf(write("word.stl", "Solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 zero\n")),
            "expected the 3 coordinates of a corner in line 4, found \"zero\"");
}

TEST_F(ShapeFormats, AWrongCountOfABinaryStlIsSaidAndPutRightWhereItIsCertain) {
  const auto stl = [](std::uint32_t said, std::size_t extra) {
    std::string bytes(80, ' ');
    const auto add = [&](std::uint32_t bits) {
      for (int k = 0; k < 4; ++k) bytes += static_cast<char>(bits >> (8 * k) & 0xFFU);
    };
    add(said);
    const std::array<Vec3f, 4> corners{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)};
    for (const auto& face :
         {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
      for (int k = 0; k < 3; ++k) add(0);
      for (const int corner : face)
        for (int axis = 0; axis < 3; ++axis)
          add(std::bit_cast<std::uint32_t>(corners.at(static_cast<std::size_t>(corner))[axis]));
      bytes += std::string(2, '\0');
    }
    return bytes + std::string(extra, 'x');
  };
  const auto noteOf = [&](std::uint32_t said, std::size_t extra) -> std::string {
    const ImportedShape shape = importShape(write("count.stl", stl(said, extra)));
    EXPECT_EQ(shape.mesh.triangles.size(), 4U);
    EXPECT_TRUE(shape.closed);
    return shape.notes.empty() ? "" : shape.notes[0];
  };
  EXPECT_EQ(noteOf(4, 0), "");
  EXPECT_EQ(noteOf(0, 0), "its header says 0 triangles and the file holds 4; all of those were taken");
  EXPECT_EQ(noteOf(1000000, 0),
            "its header says 1000000 triangles and the file holds 4; all of those were taken");
  EXPECT_EQ(noteOf(4, 13), "13 bytes after the last of 4 triangles were left out");
  EXPECT_EQ(
      faultOf(write("cut.stl", stl(4, 0).substr(0, 200))),
      "expected 4 triangles, as its header says, found 2 and 16 bytes more: the file is cut off; copy or "
      "export it anew");
  EXPECT_EQ(faultOf(write("stub.stl", "binary")),
            "expected an STL file, as text that begins with \"solid\" or at least 84 bytes, found 6");
}

TEST_F(ShapeFormats, PointsAtOnePlaceAreToldByTheirDistance) {
  // As close as floats near the origin tell, and far less than their size.
  std::vector<OrientedPoint> points = ExactSphere{}.points(400).points;
  for (std::size_t k = 0; k < 100; ++k) {
    OrientedPoint twin = points[4 * k];
    twin.position.y() += 3e-7F;
    points.push_back(twin);
  }
  std::vector<std::string> notes;
  EXPECT_TRUE(repairCloud(points, "cloud", notes));
  EXPECT_EQ(points.size(), 400U);
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes[0], "100 points at the same place as another one were left out");
}

}  // namespace shape_formats_test
}  // namespace migiwa
