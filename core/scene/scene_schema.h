// The scene format for editors and for people, made from the list of fields that the reader uses.
#pragma once

#include <string>

namespace migiwa {

/// JSON Schema (draft 2020-12) of a scene file, `scenes/scene.schema.json`.
std::string sceneSchema();

/// Every key in Markdown tables, the reference in `scenes/README.md`.
std::string sceneReference();

}  // namespace migiwa
