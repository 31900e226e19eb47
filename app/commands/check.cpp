// `migiwa check SCENE...`: reads and validates only.
#include <cmath>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "core/base/error.h"
#include "core/scene/particle_limit.h"
#include "core/scene/scene_writer.h"

namespace migiwa {

namespace {

struct CheckOptions {
  std::vector<std::string> files;
  bool print = false;
};

int check(const CheckOptions& options, const CommonOptions& common) {
  std::vector<Fault> faults;
  // With --print the scenes have the standard output to themselves.
  std::ostream& verdicts = options.print ? std::cerr : std::cout;
  for (const std::string& file : options.files) {
    try {
      const Scene scene = readScene(file, common.overrides);
      verdicts << file << ": ok (" << std::llround(particleCount(scene)) << " particles at most)\n";
      for (const std::string& warning : scene.warnings) std::cerr << file << ": warning: " << warning << '\n';
      if (options.print) std::cout << writeScene(scene);
    } catch (const InputError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  return kDone;
}

}  // namespace

Command checkCommand() {
  return {"check", "Reads scenes and lists everything that is wrong with them.", [](CLI::App& parser) {
            const auto options = std::make_shared<CheckOptions>();
            parser.add_option("scenes", options->files, "Scene files.")->required()->type_name("SCENE");
            parser.add_flag("--print", options->print,
                            "Prints each scene with every key and its value in force.");
            return [options](const CommonOptions& common) { return check(*options, common); };
          }};
}

}  // namespace migiwa
