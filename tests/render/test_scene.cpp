#include "tests/render/test_scene.h"

#include "core/scene/scene_file.h"

namespace migiwa {

Scene smallScene() {
  return parseScene(R"({
    "format": 1, "name": "Small", "duration": 0.1, "particle_spacing": 0.1, "gravity": [0, -9.81, 0],
    "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [0.5, 0.6, 0.5]}],
    "boundary": {"surfaces": [{"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5]}]},
    "solver": {"time_step": 0.005, "max_iterations": 4},
    "view": {"camera": {"eye": [0.5, 0.8, 2.5], "target": [0.5, 0.4, 0.25], "up": [0, 1, 0], "fov_degrees": 40}}
  })",
                    "small.json");
}

FrameSnapshot frameOf(const std::vector<Vec3f>& centers, float diameter, float speed) {
  FrameSnapshot frame;
  frame.info.spacing = diameter;
  for (const Vec3f& center : centers) {
    frame.positions.emplace_back(center);
    frame.velocities.emplace_back(speed, 0.0F, 0.0F);
    frame.density.push_back(1);
    frame.gamma.push_back(1);
    frame.lambda.push_back(0);
    frame.neighbours.push_back(0);
  }
  return frame;
}

std::filesystem::path freshFolder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace migiwa
