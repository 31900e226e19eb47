// `migiwa view [SCENE]`: the window.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "app/render/png.h"
#include "app/viewer/window_loop.h"
#include "core/base/error.h"
#include "core/io/output_file.h"
#include "core/simulation/settings.h"

namespace migiwa {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::string scene;
  bool paused = false;
  std::optional<long> frames;
};

/// The scene to begin with: in the current folder's scenes/, or in the repository that the program was built
/// in.
fs::path defaultScene() {
  const fs::path name = fs::path("scenes") / "dam_break.json";
  std::error_code error;
  if (fs::exists(name, error)) return name;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (fs::exists(folder / name, error)) return folder / name;
  }
  throw InputError("SCENE", "expected a scene file, found none given and no " + name.string() +
                                " here or in a folder above the program");
}

/// migiwa_0001.png and so on: the first that is not there yet.
fs::path freePictureName() {
  for (int number = 1;; ++number) {
    std::string digits = std::to_string(number);
    digits.insert(0, digits.size() < 4 ? 4 - digits.size() : 0, '0');
    const fs::path file = "migiwa_" + digits + ".png";
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return file;
  }
}

void savePicture(const Image& image) {
  try {
    const fs::path file = freePictureName();
    writeTextFile(file, encodePng(image));
    std::cout << file.string() << std::endl;
  } catch (const std::exception& error) {
    // A full disk is no reason to close the window.
    std::cerr << "migiwa: " << error.what() << '\n';
  }
}

int view(const ViewOptions& options, const CommonOptions& common) {
  const Scene scene =
      readScene(options.scene.empty() ? defaultScene() : fs::path(options.scene), common.overrides);
  requireSteppable(scene.boundary, scene.file);
  runWindow(scene, {common.threads, common.overrides, !options.paused, options.frames, savePicture});
  return kDone;
}

}  // namespace

Command viewCommand() {
  return {
      "view", "Opens a window on a scene.", [](CLI::App& parser) {
        const auto options = std::make_shared<ViewOptions>();
        parser.add_option("scene", options->scene, "Scene file; left out: scenes/dam_break.json.")
            ->type_name("SCENE");
        parser.add_flag("--paused", options->paused, "Does not start by itself.");
        parser.add_option("--frames", options->frames, "Closes after so many drawn frames.")
            ->type_name("N")
            ->check(CLI::PositiveNumber);
        parser.footer(
            "Mouse: left turns, right or middle or shift moves, wheel zooms, a double click looks there.\n"
            "Keys: space plays and pauses, right arrow steps, R resets, C corrects or not, H hides the "
            "panels,\n"
            "P saves a picture here as migiwa_0001.png and so on.\n"
            "The scene's file is watched: a change to it is taken over as soon as it is saved.\n"
            "MIGIWA_SHADERS=FOLDER in the environment takes the shaders from there.");
        return [options](const CommonOptions& common) { return view(*options, common); };
      }};
}

}  // namespace migiwa
