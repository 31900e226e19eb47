// Writing a scene and reading it back gives the same scene.
#include <filesystem>
#include <type_traits>

#include <gtest/gtest.h>

#include "core/scene/json.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace scene_writer_test {

void expectRoundTrip(const Scene& scene) {
  const std::string text = writeScene(scene);
  const Scene again = parseScene(text, scene.file);
  EXPECT_EQ(writeScene(again), text);
  EXPECT_EQ(again.fluid.size(), scene.fluid.size());
  EXPECT_EQ(again.surfaces.size(), scene.surfaces.size());
  EXPECT_EQ(again.effects.size(), scene.effects.size());
}

// Scenes are shared between threads: whoever writes one out only reads it.
template <class T>
concept WritableAsConst = requires(const T& described, FieldWriter& writer) {
  described.describe(writer);
};
static_assert(WritableAsConst<Surface> && WritableAsConst<FluidSource> && WritableAsConst<Effect> &&
              WritableAsConst<Motion> && WritableAsConst<Emitter>);
static_assert(std::is_same_v<decltype(&writeScene), std::string (*)(const Scene&)>);
static_assert(std::is_same_v<decltype(&sceneIdentity), Json (*)(const Scene&)>);
static_assert(std::is_same_v<decltype(&filesNamedBy), std::vector<std::filesystem::path> (*)(const Scene&)>);

TEST(SceneWriter, ShippedScenesComeBackTheSame) {
  for (const auto& entry : std::filesystem::directory_iterator(MIGIWA_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".json" && entry.path().filename() != "scene.schema.json")
      expectRoundTrip(readScene(entry.path()));
}

TEST(SceneWriter, EveryShapeAndChoiceComesBackTheSame) {
  expectRoundTrip(parseScene(R"({ "format": 1, "name": "Quote \" and \\ and é",
      "fluid": [ { "shape": "sphere", "center": [0, 1, 0], "radius": 0.123456789012345 },
                 { "shape": "box", "min": [0, 0, 0], "max": [1, 1, 1], "rotation": { "axis": [1, 1, 0], "degrees": 30 } } ],
      "boundary": { "surfaces": [ { "shape": "plane", "point": [0, 0, 0], "normal": [0, 2, 0] },
                                  { "shape": "box", "fluid": "outside", "min": [0, 0, 0], "max": [1, 1, 1],
                                    "rotation": { "axis": [0, 1, 0], "degrees": -15 } } ] },
      "effects": { "viscosity": {} },
      "view": { "clip": { "axis": "y", "at": 1e-3 }, "color_range": [-1, 1] } })",
                             "shapes.json"));
}

TEST(SceneWriter, WritesDefaultsAndTheChosenCamera) {
  const std::string text = writeScene(parseScene(R"({ "format": 1 })", "short.json"));
  for (const char* line :
       {"\"format\": 1", "\"name\": \"short\"", "\"tolerance\": 0.003", "\"handling\": \"gamma\"",
        "\"gravity\": [0.0, -9.81, 0.0]", "\"method\": \"auto\"", "\"eye\": ["})
    EXPECT_NE(text.find(line), std::string::npos) << line << " is not in\n" << text;
  EXPECT_EQ(text.find("$schema"), std::string::npos);
  EXPECT_EQ(text.find("color_range"), std::string::npos);
}

}  // namespace scene_writer_test
}  // namespace migiwa
