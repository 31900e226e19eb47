// Meshes and clouds from files, good and bad.
#include "core/slim/shape_import.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/slim/fit.h"
#include "tests/slim/exact_shapes.h"
#include "tests/slim/import_fixture.h"

namespace migiwa {
namespace shape_import_test {

using namespace testing;

TEST_F(ShapeImport, ReadsACube) {
  const ImportedShape cube = importShape(write("cube.obj", kCubeVertices + kCubeFaces));
  EXPECT_TRUE(cube.isMesh());
  EXPECT_TRUE(cube.closed);
  EXPECT_TRUE(cube.notes.empty());
  EXPECT_EQ(cube.mesh.vertices.size(), 8U);
  EXPECT_EQ(cube.mesh.triangles.size(), 12U);
  EXPECT_NEAR(volumeOf(cube.mesh), 1, 1e-6);
}

TEST_F(ShapeImport, WeldsStl) {
  std::string text = "solid t\n";
  const char* corners[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  for (const auto& face :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) text += std::string("vertex ") + corners[corner] + "\n";
    text += "endloop\nendfacet\n";
  }
  const ImportedShape shape = importShape(write("t.stl", text + "endsolid t\n"));
  EXPECT_TRUE(shape.closed);
  EXPECT_EQ(shape.mesh.vertices.size(), 4U);
  EXPECT_NEAR(volumeOf(shape.mesh), 1.0 / 6, 1e-6);
}

TEST_F(ShapeImport, TurnsFacesThatFaceTheOtherWay) {
  const std::string someFlipped = "f 1 2 3 4\nf 5 6 7 8\nf 1 5 6 2\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  const ImportedShape some = importShape(write("some.obj", kCubeVertices + someFlipped));
  EXPECT_NEAR(volumeOf(some.mesh), 1, 1e-6);
  ASSERT_EQ(some.notes.size(), 1U);
  EXPECT_EQ(some.notes[0], "4 triangles were turned to face outwards as the others do");
  const std::string allFlipped = "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 7 8 4 3\nf 6 7 3 2\nf 4 8 5 1\n";
  EXPECT_NEAR(volumeOf(importShape(write("all.obj", kCubeVertices + allFlipped)).mesh), 1, 1e-6);
}

TEST_F(ShapeImport, AHollowIsAPartWithinAnotherThatFacesTheOtherWay) {
  std::string inner;
  for (const char* corner : {"1 1 1", "2 1 1", "2 2 1", "1 2 1", "1 1 2", "2 1 2", "2 2 2", "1 2 2"})
    inner += std::string("v ") + corner + "\n";
  const std::string outer = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 0 0 3\nv 3 0 3\nv 3 3 3\nv 0 3 3\n";
  const std::string outwards =
      "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 11 12 16 15\nf 10 11 15 14\nf 9 13 16 12\n";
  const std::string inwards =
      "f 10 11 12 9\nf 16 15 14 13\nf 13 14 10 9\nf 15 16 12 11\nf 14 15 11 10\nf 12 16 13 9\n";
  const std::string turnedOuter = "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 7 8 4 3\nf 6 7 3 2\nf 4 8 5 1\n";
  const auto volume = [&](const std::string& faces) {
    return volumeOf(importShape(write("hollow.obj", outer + inner + faces)).mesh);
  };
  EXPECT_NEAR(volume(kCubeFaces + inwards), 26, 1e-5);
  EXPECT_NEAR(volume(turnedOuter + outwards), 26, 1e-5) << "the whole file inside out";
  // Twice inside is inside: the volume counts what lies in both twice.
  EXPECT_NEAR(volume(kCubeFaces + outwards), 28, 1e-5);
  const ImportedShape solid = importShape(write("solid.obj", outer + inner + kCubeFaces + outwards));
  ASSERT_EQ(solid.notes.size(), 1U);
  EXPECT_TRUE(solid.notes[0].starts_with("1 part lies within others and face outwards"));
  // An island in a hollow is one, and nothing needs to be turned.
  std::string island, islandFaces;
  for (const char* corner : {"1.25 1.25 1.25", "1.75 1.25 1.25", "1.75 1.75 1.25", "1.25 1.75 1.25",
                             "1.25 1.25 1.75", "1.75 1.25 1.75", "1.75 1.75 1.75", "1.25 1.75 1.75"})
    island += std::string("v ") + corner + "\n";
  for (const char* face :
       {"17 20 19 18", "21 22 23 24", "17 18 22 21", "19 20 24 23", "18 19 23 22", "17 21 24 20"})
    islandFaces += std::string("f ") + face + "\n";
  const ImportedShape within =
      importShape(write("island.obj", outer + inner + island + kCubeFaces + inwards + islandFaces));
  EXPECT_NEAR(volumeOf(within.mesh), 26.125, 1e-5);
  EXPECT_TRUE(within.notes.empty()) << within.notes.front();
}

TEST_F(ShapeImport, PartsMayTouch) {
  const auto cube = [](double x, double y, double z) {
    std::string text;
    for (int k = 0; k < 8; ++k)
      text += "v " + std::to_string(x + (((k + 1) & 2) >> 1)) + " " + std::to_string(y + ((k & 2) >> 1)) +
              " " + std::to_string(z + (k >> 2)) + "\n";
    return text;
  };
  const auto faces = [](int first, const std::string& order) {
    // Every quad begins at another corner where `order` says so, and is cut along its other diagonal.
    std::string text;
    for (const auto& quad : {std::array{1, 4, 3, 2}, std::array{5, 6, 7, 8}, std::array{1, 2, 6, 5},
                             std::array{3, 4, 8, 7}, std::array{2, 3, 7, 6}, std::array{1, 5, 8, 4}}) {
      text += "f";
      for (std::size_t k = 0; k < 4; ++k)
        text += " " + std::to_string(first + quad[(k + (order == "other" ? 1 : 0)) % 4]);
      text += "\n";
    }
    return text;
  };
  for (const std::string order : {"same", "other"}) {
    for (const auto& [x, y, z] : {std::array{1, 0, 0}, std::array{1, 1, 0}, std::array{1, 1, 1}}) {
      const ImportedShape shape = importShape(
          write("touching.obj", cube(0, 0, 0) + cube(x, y, z) + faces(0, "same") + faces(8, order)));
      EXPECT_TRUE(shape.closed) << order << x << y << z;
      EXPECT_NEAR(volumeOf(shape.mesh), 2, 1e-6) << order << x << y << z;
    }
    // All around an edge, and around a corner.
    std::string all, around;
    for (int k = 0; k < 8; ++k) {
      all += cube(k & 1, k >> 1 & 1, k >> 2);
      around += faces(8 * k, order);
    }
    const ImportedShape block = importShape(write("block.obj", all + around));
    EXPECT_TRUE(block.closed);
    EXPECT_NEAR(volumeOf(block.mesh), 8, 1e-6) << order;
  }
  const ImportedShape same =
      importShape(write("shared.obj", cube(0, 0, 0) + cube(1, 0, 0) + faces(0, "same") + faces(8, "other")));
  EXPECT_TRUE(same.closed);
}

TEST_F(ShapeImport, PartsThatCrossAreNoHollows) {
  // The first corner of the second cube lies in the first cube.
  std::string second;
  for (const char* corner : {"0.5 0.4 0.3", "1.5 0.4 0.3", "1.5 1.4 0.3", "0.5 1.4 0.3", "0.5 0.4 1.3",
                             "1.5 0.4 1.3", "1.5 1.4 1.3", "0.5 1.4 1.3"})
    second += std::string("v ") + corner + "\n";
  const std::string faces =
      "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 11 12 16 15\nf 10 11 15 14\nf 9 13 16 12\n";
  const ImportedShape shape = importShape(write("crossing.obj", kCubeVertices + second + kCubeFaces + faces));
  EXPECT_NEAR(volumeOf(shape.mesh), 2, 1e-5);
  EXPECT_TRUE(shape.notes.empty());
}

TEST_F(ShapeImport, LeavesOutWhatIsThereTwiceOrFlat) {
  const ImportedShape shape =
      importShape(write("twice.obj", kCubeVertices + kCubeFaces + "f 5 6 7\nf 1 1 2\n"));
  EXPECT_TRUE(shape.closed);
  EXPECT_EQ(shape.mesh.triangles.size(), 12U);
  EXPECT_EQ(shape.notes.size(), 2U);
}

TEST_F(ShapeImport, SaysWhereAMeshIsOpen) {
  const std::string lid = "f 5 6 7 8\n";
  std::string faces = kCubeFaces;
  faces.erase(faces.find(lid), lid.size());
  const ImportedShape shape = importShape(write("open.obj", kCubeVertices + faces));
  EXPECT_FALSE(shape.closed);
  ASSERT_EQ(shape.notes.size(), 1U);
  EXPECT_TRUE(shape.notes[0].starts_with(
      "the mesh is open: 4 edges have a triangle on one side only, the first near (0"))
      << shape.notes[0];
}

TEST_F(ShapeImport, RefusesWhatIsNoSurface) {
  EXPECT_EQ(faultOf(folder_ / "none.obj"), "expected a mesh or a point cloud, found no such file");
  EXPECT_EQ(faultOf(folder_), "expected a mesh or a point cloud, found a folder");
  EXPECT_EQ(faultOf(write("empty.obj", "")), "expected a mesh or a point cloud, found an empty file");
  EXPECT_EQ(faultOf(write("text.ply", "Dear Sir,")),
            "expected a PLY file, found one that does not begin with \"ply\"");
  EXPECT_TRUE(faultOf(write("text.obx", "Dear Sir,")).starts_with("expected a mesh (OBJ, PLY, STL, ...)"));
  EXPECT_EQ(faultOf(write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n")),
            "expected triangles with an area, found none");
  EXPECT_TRUE(faultOf(write("nan.obj", "v nan 0 0\n" + kCubeVertices + kCubeFaces))
                  .starts_with("expected coordinates that are finite"));
  EXPECT_EQ(faultOf("/nowhere/glmark2/models/bunny.obj"),
            "expected a mesh or a point cloud, found no such file; it comes with Debian's package "
            "glmark2-data (sudo "
            "apt-get install glmark2-data)");
}

/// A fin on a cube: the cube stays whole, and a wall has both; no polynomials pass through the edge.
TEST_F(ShapeImport, TakesAFinOffTheSolidThatItStandsOn) {
  for (const bool finFirst : {false, true}) {
    const std::string fin = "f 1 2 9\n", points = kCubeVertices + "v 3 0 0\nv 3 1 0\n";
    const ImportedShape shape =
        importShape(write("fin.obj", points + (finFirst ? fin + kCubeFaces : kCubeFaces + fin)));
    EXPECT_FALSE(shape.closed);
    EXPECT_NEAR(volumeOf(shape.mesh), 1, 1e-6);
    EXPECT_EQ(shape.mesh.vertices.size(), 8U + 3U);
    ASSERT_EQ(shape.notes.size(), 2U);
    EXPECT_EQ(shape.notes[0], "sheets meet at 1 edge of three or more triangles, the first at (0.5, 0, 0)");
    EXPECT_THROW(fitPoints(shape, 100), InputError);
  }
}

/// Of parts that are open nobody knows which way round they are meant; a closed one has an outside.
TEST_F(ShapeImport, TurnsAClosedPartBesideAnOpenOneOutwards) {
  std::string inwards;
  for (const char* face : {"1 2 3 4", "8 7 6 5", "5 6 2 1", "6 7 3 2", "7 8 4 3", "8 5 1 4"})
    inwards += std::string("f ") + face + "\n";
  const std::string sheet = "v 5 0 0\nv 6 0 0\nv 5 1 0\nf 9 10 11\n";
  const double volume = volumeOf(importShape(write("alone.obj", kCubeVertices + inwards)).mesh);
  ASSERT_NEAR(volume, 1, 1e-6);
  EXPECT_NEAR(volumeOf(importShape(write("both.obj", kCubeVertices + sheet + kCubeFaces)).mesh), 1, 1e-6);
  EXPECT_NEAR(volumeOf(importShape(write("both.obj", kCubeVertices + sheet + inwards)).mesh), 1, 1e-6);
}

TEST_F(ShapeImport, AMoebiusStripIsASheetAndFitsNothing) {
  std::string text;
  constexpr int kSteps = 12;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSteps;
    for (const double side : {-0.3, 0.3}) {
      const double across = 1 + side * std::cos(angle / 2);
      text += "v " + std::to_string(across * std::cos(angle)) + " " +
              std::to_string(across * std::sin(angle)) + " " + std::to_string(side * std::sin(angle / 2)) +
              "\n";
    }
  }
  for (int k = 0; k < kSteps; ++k) {
    const int a = 2 * k + 1, b = a + 1, last = k + 1 == kSteps ? 1 : 0;
    const int c = last != 0 ? 2 : a + 2, d = last != 0 ? 1 : a + 3;
    text += "f " + std::to_string(a) + " " + std::to_string(c) + " " + std::to_string(d) + "\nf " +
            std::to_string(a) + " " + std::to_string(d) + " " + std::to_string(b) + "\n";
  }
  const ImportedShape shape = importShape(write("moebius.obj", text));
  EXPECT_FALSE(shape.closed);
  EXPECT_EQ(shape.mesh.triangles.size(), 2U * kSteps);
  EXPECT_TRUE(shape.rim.starts_with(std::to_string(2 * kSteps) + " edges have a triangle on one side only"))
      << shape.rim;
  ASSERT_TRUE(shape.branching);
  EXPECT_TRUE(shape.branching->message.starts_with(
      "expected a surface with two sides, found one like a Moebius strip at ("));
  EXPECT_THROW(fitPoints(shape, 0), InputError);
}

std::string cloudText(const std::vector<OrientedPoint>& points, bool normals) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  text += "end_header\n";
  for (const OrientedPoint& point : points) {
    for (const Vec3f* v : {&point.position, &point.normal}) {
      if (v == &point.normal && !normals) break;
      for (int axis = 0; axis < 3; ++axis) text += std::to_string((*v)[axis]) + " ";
    }
    text += "\n";
  }
  return text;
}

TEST_F(ShapeImport, ReadsACloudAndRepairsIt) {
  std::vector<OrientedPoint> points = testing::ExactSphere{}.points(2000).points;
  for (std::size_t k = 0; k < points.size(); k += 40) points[k].normal = -points[k].normal;
  points.push_back(points[7]);
  for (OrientedPoint& point : points) point.normal = -point.normal;  // and all of them inwards
  const ImportedShape shape = importShape(write("cloud.ply", cloudText(points, true)));
  EXPECT_FALSE(shape.isMesh());
  EXPECT_TRUE(shape.closed);
  ASSERT_EQ(shape.cloud.points.size(), 2000U);
  for (const OrientedPoint& point : shape.cloud.points) ASSERT_GT(point.normal.dot(point.position), 0.9F);
  ASSERT_EQ(shape.notes.size(), 3U);
  EXPECT_EQ(shape.notes[1], "50 normals were turned to agree with their neighbours");
}

TEST_F(ShapeImport, EstimatesNormalsWhereThereAreNone) {
  const std::vector<OrientedPoint> points = testing::ExactSphere{}.points(2000).points;
  for (const fs::path& file : {write("bare.ply", cloudText(points, false)), write("bare.obj", [&] {
                                 std::string text;
                                 for (const OrientedPoint& p : points)
                                   text += "v " + std::to_string(p.position.x()) + " " +
                                           std::to_string(p.position.y()) + " " +
                                           std::to_string(p.position.z()) + "\n";
                                 return text;
                               }())}) {
    const ImportedShape shape = importShape(file);
    EXPECT_TRUE(shape.closed);
    ASSERT_EQ(shape.notes.size(), 1U);
    EXPECT_EQ(shape.notes[0], "normals were estimated from neighbouring points, and made to face outwards");
    ASSERT_EQ(shape.cloud.points.size(), 2000U);
    for (const OrientedPoint& point : shape.cloud.points) ASSERT_GT(point.normal.dot(point.position), 0.99F);
  }
}

TEST_F(ShapeImport, TurnsAHalfThatFacesTheOtherWay) {
  std::vector<OrientedPoint> points = testing::ExactSphere{}.points(2000).points;
  for (OrientedPoint& point : points)
    if (point.position.y() > 0.2F) point.normal = -point.normal;
  const ImportedShape shape = importShape(write("half.ply", cloudText(points, true)));
  EXPECT_TRUE(shape.closed);
  for (const OrientedPoint& point : shape.cloud.points) ASSERT_GT(point.normal.dot(point.position), 0.9F);
  ASSERT_FALSE(shape.notes.empty());
  EXPECT_TRUE(shape.notes.back().ends_with("normals were turned so that all of them face outwards"))
      << shape.notes.back();
}

TEST_F(ShapeImport, LeavesOutPointsWithoutANormalAmongOthers) {
  std::vector<OrientedPoint> points = testing::ExactSphere{}.points(2000).points;
  for (std::size_t k = 0; k < 30; ++k) points[7 * k].normal.setZero();
  const ImportedShape shape = importShape(write("some.ply", cloudText(points, true)));
  EXPECT_EQ(shape.cloud.points.size(), 1970U);
  ASSERT_EQ(shape.notes.size(), 1U);
  EXPECT_EQ(shape.notes[0], "30 points without a normal were left out, others have one");
}

TEST_F(ShapeImport, RefusesCloudsThatAreNone) {
  std::vector<OrientedPoint> points = testing::ExactSphere{}.points(100).points;
  EXPECT_EQ(faultOf(write("few.ply", cloudText({points.begin(), points.begin() + 9}, true))),
            "expected a mesh, or at least 50 points, found 9 points");
  std::vector<OrientedPoint> same(200, points[0]);
  EXPECT_EQ(faultOf(write("same.ply", cloudText(same, true))),
            "expected a mesh, or at least 50 points, found 1 points");
  points[3].position.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(faultOf(write("nan.ply", cloudText(points, true)))
                  .starts_with("expected coordinates that are finite and at most 1e7, found (nan"));
  // Half a sphere has no inside, so nobody knows where bare points should face.
  std::vector<OrientedPoint> half = testing::ExactSphere{}.points(2000).points;
  std::erase_if(half, [](const OrientedPoint& p) { return p.position.y() > 0; });
  EXPECT_NE(faultOf(write("half.ply", cloudText(half, false)))
                .find("inside and outside cannot be told apart: they do not cover a closed surface"),
            std::string::npos);
}

/// A tetrahedron in binary, its lists counted by bytes and by shorts.
std::string binaryPly(bool bigEndian, const std::string& counted, std::int64_t corners) {
  std::string text = "ply\nformat binary_" + std::string(bigEndian ? "big" : "little") +
                     "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
                     "element face 4\nproperty list " + counted + " int vertex_indices\nend_header\n";
  const auto add = [&](std::int64_t value, std::size_t bytes) {
    for (std::size_t k = 0; k < bytes; ++k)
      text += static_cast<char>(value >> (8 * (bigEndian ? bytes - 1 - k : k)) & 0xFF);
  };
  for (const auto& corner : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)})
    for (int axis = 0; axis < 3; ++axis) add(std::bit_cast<std::int32_t>(corner[axis]), 4);
  for (const auto& face :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    add(corners, counted == "short" ? 2 : 1);
    for (const int corner : face) add(corner, 4);
  }
  return text;
}

TEST_F(ShapeImport, ReadsBinaryPlyOfBothByteOrders) {
  for (const bool bigEndian : {false, true})
    for (const char* counted : {"uchar", "char", "short"}) {
      const ImportedShape shape = importShape(write("tetrahedron.ply", binaryPly(bigEndian, counted, 3)));
      EXPECT_EQ(shape.mesh.triangles.size(), 4U) << counted << bigEndian;
      EXPECT_TRUE(shape.closed) << counted << bigEndian;
    }
}

TEST_F(ShapeImport, ReadsPlyWhoseLinesEndAsOnWindows) {
  std::string text;
  for (const char c : cloudText(testing::ExactSphere{}.points(200).points, true))
    text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(importShape(write("cloud.ply", text)).cloud.points.size(), 200U);
  text.insert(text.find("end_header"), "\r");
  EXPECT_EQ(faultOf(write("return.ply", text)),
            "expected the header of a PLY file, found something else in its line 10");
}

TEST_F(ShapeImport, RefusesPlyListsThatTheFileDoesNotHold) {
  const std::string early =
      "expected all numbers of each element after the header, as it says, found that the file ends early";
  for (const bool bigEndian : {false, true})
    for (const std::int64_t corners : {-1, 127, 30'000})
      EXPECT_EQ(faultOf(write("long.ply", binaryPly(bigEndian, "short", corners))), early) << corners;
  const auto text = [](const std::string& faces) {
    return "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float x\nproperty float "
           "y\nproperty float "
           "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n\n0 1 0\n" +
           faces;
  };
  EXPECT_EQ(faultOf(write("more.ply", text("3 0 1 2\n77777777 0 1 2\n"))),
            "expected 77777777 numbers in line 16, found 3");
  EXPECT_EQ(faultOf(write("word.ply", text("three 0 1 2\n3 0 1 2\n"))),
            "expected how many numbers follow in line 15, found \"three\"");
  EXPECT_EQ(faultOf(write("minus.ply", text("-1\n3 0 1 2\n"))),
            "expected how many numbers follow in line 15, found \"-1\"");
  EXPECT_EQ(faultOf(write("extra.ply", text("3 0 1 2\n3 0 1 2 1\n"))),
            "expected the end of line 16, found \"1\"");
  EXPECT_EQ(faultOf(write("zero.ply", text("3 0 1 2\n3 0 1 2x\n"))),
            "expected a number in line 16, found \"2x\"");
  EXPECT_EQ(faultOf(write("vast.ply", text("99999999999999999999 0 1 2\n3 0 1 2\n"))),
            "expected how many numbers follow in line 15, found \"99999999999999999999\"");
  // Nothing is wrong with the numbers of these faces.
  EXPECT_EQ(importShape(write("signs.ply", text("+3 +0 1e0 2\n3 0 1 2\n"))).mesh.triangles.size(), 1U);
}

TEST_F(ShapeImport, RefusesFilesThatEndEarly) {
  const std::string whole = cloudText(testing::ExactSphere{}.points(200).points, true);
  for (const std::size_t size : {std::size_t{3}, std::size_t{40}, whole.size() / 2})
    EXPECT_NE(faultOf(write("cut" + std::to_string(size) + ".ply", whole.substr(0, size))), "accepted")
        << size;
  EXPECT_EQ(faultOf(write("cut.ply", whole.substr(0, whole.rfind('\n', whole.size() - 2)))),
            "expected 200 lines after the header, as it says, found 199: the file ends early");
  EXPECT_EQ(
      faultOf(write("binary.ply",
                    "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float "
                    "x\nproperty float y\nproperty double z\nelement face 10\nproperty list "
                    "uchar int vertex_indices\nend_header\n" +
                        std::string(1000, '\1'))),
      "expected all numbers of each element after the header, as it says, found that the file ends early");
  std::string stl(80, ' ');
  stl += std::string("\x10\x27\0\0", 4) + std::string(120, '\0');  // 10,000 triangles, and two follow
  EXPECT_NE(faultOf(write("cut.stl", stl)), "accepted");
  EXPECT_NE(faultOf(write("only_vertices.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "accepted");
  EXPECT_NE(faultOf(write("wrong_corner.obj", kCubeVertices + "f 1 2 99\n")), "accepted");
}

TEST(Bunny, IsToldInsideFromOutside) {
  const fs::path file = "/usr/share/glmark2/models/bunny.obj";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file << ": install glmark2-data";
  const ImportedShape bunny = importShape(file);
  EXPECT_TRUE(bunny.closed);
  EXPECT_TRUE(bunny.notes.empty());
  ThreadPool pool(0);
  SlimFitOptions options;
  options.degree = 2;
  options.tolerance = 0.01;
  const SlimData data = fitShape(bunny, options, pool);
  EXPECT_LT(data.statistics.mean, 0.003);
  const SlimModel model(data.nodes, 2, true, pool);
  // Against the parity of crossings of a ray with the mesh.
  const Bounds bounds = bunny.bounds();
  int inside = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3d share(std::fmod(k * 0.8191725, 1.0), std::fmod(k * 0.6710436, 1.0),
                      std::fmod(k * 0.5497005, 1.0));
    const Vec3d p = bounds.min + share.cwiseProduct(bounds.size());
    int crossings = 0;
    for (const auto& [a, b, c] : bunny.mesh.triangles) {
      const Vec3d A = bunny.mesh.vertices[a].cast<double>() - p,
                  B = bunny.mesh.vertices[b].cast<double>() - p,
                  C = bunny.mesh.vertices[c].cast<double>() - p;
      const auto side = [](const Vec3d& x, const Vec3d& y) { return x.x() * y.y() - x.y() * y.x(); };
      const double u = side(B, C), v = side(C, A), w = side(A, B);
      if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
      if ((u * A.z() + v * B.z() + w * C.z()) / (u + v + w) > 0) ++crossings;
    }
    const auto distance = static_cast<double>(model.nearest(p.cast<float>()).distance);
    inside += crossings % 2;
    if (std::abs(distance) > 0.01) {
      EXPECT_EQ(distance < 0, crossings % 2 == 1) << p.transpose() << ": " << distance;
    }
  }
  EXPECT_GT(inside, 40);
}

}  // namespace shape_import_test
}  // namespace migiwa
