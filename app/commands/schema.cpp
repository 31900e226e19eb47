// `migiwa schema`: the scene format, for editors and for people.
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "core/scene/scene_schema.h"

namespace migiwa {

Command schemaCommand() {
  return {"schema", "Prints the scene format as JSON Schema.", [](CLI::App& parser) {
            const auto markdown = std::make_shared<bool>(false);
            parser.add_flag("--markdown", *markdown, "Prints a reference of all keys for people instead.");
            return [markdown](const CommonOptions&) {
              std::cout << (*markdown ? sceneReference() : sceneSchema());
              return kDone;
            };
          }};
}

}  // namespace migiwa
