// Files of shapes in a folder of each test's own.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/slim/shape_import.h"

namespace migiwa::testing {

namespace fs = std::filesystem;

/// A file in a folder of the test's own.
class ShapeImport : public ::testing::Test {
 protected:
  ShapeImport() {
    folder_ = fs::temp_directory_path() / (std::string("migiwa_shape_import_") +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  ~ShapeImport() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string faultOf(const fs::path& file) const {
    try {
      importShape(file);
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.starts_with(file.string() + ": ")) << text;
      return text.substr(std::min(text.size(), file.string().size() + 2));
    }
    return "accepted";
  }

  fs::path folder_;
};

inline const std::string kCubeVertices =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
/// Outward.
inline const std::string kCubeFaces = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

inline double volumeOf(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.vertices[a].cast<double>().dot(
                  mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>())) /
              6;
  return volume;
}

}  // namespace migiwa::testing
