// Meshes as fluid: which cells are filled, against a count of every cell of the bounding box, and what that
// costs where the box is nearly empty.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/scene/sources.h"
#include "tests/support/mesh_shapes.h"

namespace migiwa::testing {
namespace mesh_fill_test {

bool inside(const TriangleMesh& mesh, const Vec3d& at) {
  return std::abs(windingNumber(mesh, at)) > 0.5;
}

/// Every cell of the bounding box and one more, by z, then y, then x, of the lattice with a cell at `center`.
std::vector<Vec3d> filledByCounting(const TriangleMesh& mesh, double spacing, const Vec3d& center) {
  const Eigen::Array3d cells = (mesh.bounds().size() / spacing).array().round() + 1;
  Vec3d first = mesh.bounds().center() - 0.5 * spacing * (cells - 2).matrix();
  first -= spacing * movedBy(center, first, spacing);
  std::vector<Vec3d> centers;
  for (double k = 0; k < cells.z(); ++k)
    for (double j = 0; j < cells.y(); ++j)
      for (double i = 0; i < cells.x(); ++i)
        if (const Vec3d at = first + spacing * Vec3d(i, j, k); inside(mesh, at)) centers.push_back(at);
  return centers;
}

/// A ball of triangles, and a smaller one within it that is hollow.
TriangleMesh shell() {
  TriangleMesh mesh;
  const auto add = [&](double radius, bool turned) {
    constexpr std::uint32_t kRings = 13, kSectors = 17;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t ring = 0; ring <= kRings; ++ring)
      for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
        const double polar = std::numbers::pi * ring / kRings,
                     around = 2 * std::numbers::pi * sector / kSectors;
        mesh.vertices.emplace_back((radius * Vec3d(std::sin(polar) * std::cos(around), std::cos(polar),
                                                   std::sin(polar) * std::sin(around)))
                                       .cast<float>());
      }
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
      for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
        const std::uint32_t a = first + ring * kSectors + sector,
                            b = first + ring * kSectors + (sector + 1) % kSectors, c = a + kSectors,
                            d = b + kSectors;
        mesh.triangles.push_back(turned ? std::array{a, c, b} : std::array{a, b, c});
        mesh.triangles.push_back(turned ? std::array{b, c, d} : std::array{b, d, c});
      }
  };
  add(0.5, false);
  add(0.3, true);
  return mesh;
}

TEST(MeshFill, FillsTheCellsThatACountOfAllFindsInTheirOrder) {
  const TriangleMesh meshes[] = {boxMesh({1, 2, 3}, {0.4, 0, 0}, {0, 0.3, 0}, {0, 0, 0.5}),
                                 boxMesh({-1, 0, 2}, {0.4, 0.1, 0.05}, {-0.1, 0.4, 0.02}, {0.03, -0.1, 0.4}),
                                 slantedNeedle(2, 0.11), shell()};
  for (const TriangleMesh& mesh : meshes)
    for (const double spacing : {0.05, 0.031}) {
      std::vector<Vec3d> centers;
      fillMesh(mesh, spacing, centers);
      const std::vector<Vec3d> expected = filledByCounting(mesh, spacing, centers[0]);
      ASSERT_GT(expected.size(), 50U);
      ASSERT_EQ(centers.size(), expected.size());
      for (std::size_t k = 0; k < centers.size(); ++k)
        ASSERT_LT((centers[k] - expected[k]).norm(), 1e-9) << k;
    }
}

TEST(MeshFill, HoldsTheVolumeOfABoxThatIsNoMultipleOfTheSpacing) {
  // Half a cell beside ten is 5 % of the volume along each axis.
  for (const double length : {0.523, 0.55, 0.577, 0.61})
    for (const double height : {0.5, 0.53, 0.57}) {
      const TriangleMesh mesh = boxMesh({1, 2, 3}, {length, 0, 0}, {0, height, 0}, {0, 0, length});
      std::vector<Vec3d> centers;
      fillMesh(mesh, 0.05, centers);
      const double volume = length * length * height, cell = 0.05 * 0.05 * 0.05;
      // A lattice has whole layers: what the nearest numbers of them along each axis make is as near as it
      // gets.
      double least = volume;
      for (const double i : {std::floor(length / 0.05), std::ceil(length / 0.05)})
        for (const double j : {std::floor(height / 0.05 + 1e-6), std::ceil(height / 0.05 - 1e-6)})
          for (const double k : {std::floor(length / 0.05), std::ceil(length / 0.05)})
            least = std::min(least, std::abs(i * j * k * cell - volume));
      EXPECT_LE(std::abs(static_cast<double>(centers.size()) * cell - volume),
                std::max(least + 1e-9, 0.01 * volume))
          << length << ' ' << height;
    }
}

TEST(MeshFill, ASlantedNeedleCostsItsVolumeAndNotItsBox) {
  // A thousand times as long as wide: its box has a million times its cells.
  constexpr double kWidth = 0.02, kLength = 20, kCell = 0.005;
  const TriangleMesh needle = slantedNeedle(kLength, kWidth);
  std::vector<Vec3d> centers;
  const MeshFillWork work = fillMesh(needle, kCell, centers);
  const double cells = kLength * kWidth * kWidth / (kCell * kCell * kCell);
  EXPECT_NEAR(static_cast<double>(centers.size()), cells, 0.05 * cells);
  const double box = (needle.bounds().size() / kCell).prod(),
               base = box / (needle.bounds().size().y() / kCell);
  ASSERT_GT(base, 20 * cells) << "a column of each is more than all that is filled";
  EXPECT_LT(static_cast<double>(work.lines + work.columns + work.cells), 6 * cells);
  EXPECT_LT(work.mostHeld, 1000U);
}

TEST(MeshFill, TwoNeedlesFarApartCostNothingInBetween) {
  TriangleMesh mesh = boxMesh({0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1});
  const TriangleMesh other = boxMesh({1e4, 1e4, 1e4}, {0.125, 0, 0}, {0, 0.125, 0}, {0, 0, 0.125});
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + 8, b + 8, c + 8});
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  std::vector<Vec3d> centers;
  const MeshFillWork work = fillMesh(mesh, 0.01, centers);
  EXPECT_GT(centers.size(), 2000U);
  EXPECT_LT(work.lines + work.columns, 20000);
}

TEST(MeshFill, TheCountIsNeverBelowWhatIsFilled) {
  for (const TriangleMesh& mesh : {slantedNeedle(2, 0.11), shell()})
    for (const double spacing : {0.2, 0.1, 0.05, 0.02}) {
      const MeshSource source(mesh);
      std::vector<Vec3d> centers;
      source.fill(spacing, centers);
      EXPECT_GE(source.count(spacing), static_cast<double>(centers.size())) << spacing;
    }
}

TEST(MeshFill, AHugeMeshIsRefusedWithASpacingThatDoes) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "migiwa_huge_sheet.obj";
  // Thin: the number of cells at its surface goes with the spacing to the power of -2.
  const TriangleMesh sheet = boxMesh({-50, 0, -50}, {100, 0, 0}, {0, 0.001, 0}, {0, 0, 100});
  {
    std::ofstream out(file);
    for (const Vec3f& v : sheet.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (const auto& [a, b, c] : sheet.triangles)
      out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  }
  const auto read = [&](const std::string& spacing) -> std::string {
    try {
      parseScene(R"({ "format": 1, "particle_spacing": )" + spacing +
                     R"(, "fluid": [ { "shape": "mesh", "file": ")" + file.string() + R"(" } ] })",
                 "huge.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  const std::string refusal = read("0.001");
  std::size_t at = refusal.find("found 0.001 m, which makes ");
  ASSERT_NE(at, std::string::npos) << refusal;
  EXPECT_GT(std::stod(refusal.substr(at + 27)), 2e10) << refusal;
  const std::string lead = "; a spacing of ";
  at = refusal.find(lead);
  ASSERT_NE(at, std::string::npos) << refusal;
  std::string remedy = refusal.substr(at + lead.size());
  remedy = remedy.substr(0, remedy.find(' '));
  EXPECT_EQ(read(remedy).find("expected a spacing that makes at most"), std::string::npos) << read(remedy);
  std::filesystem::remove(file);
}

}  // namespace mesh_fill_test
}  // namespace migiwa::testing
