#include "core/scene/scene_schema.h"

#include "core/scene/include.h"
#include "core/scene/reference_writer.h"
#include "core/scene/scene_reader.h"
#include "core/scene/schema_writer.h"

namespace migiwa {

namespace {

Json includeSchema() {
  return {{"type", "string"}, {"minLength", 1}, {"description", std::string(kIncludeDoc.description)}};
}

Json setSchema() {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", "^(/([^~]|~[01])*)+$"}}},
          {"description", std::string(kSetDoc.description)}};
}

}  // namespace

std::string sceneSchema() {
  const auto fields = [](FieldVisitor& visitor) {
    Scene scene;
    describeScene(visitor, scene);
  };
  SchemaWriter::Definitions lists;
  Json scene = SchemaWriter::write(fields, lists, false);
  Json variant = SchemaWriter::write(fields, lists, true);
  scene["properties"][std::string(kSetKey)] = setSchema();
  variant["properties"][std::string(kSetKey)] = setSchema();
  variant["properties"][std::string(kIncludeKey)] = includeSchema();

  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Migiwa scene, format 1"},
              {"description", "Written by `./run schema` from the program's own list of keys."},
              {"type", "object"},
              {"if", {{"required", Json::array({std::string(kIncludeKey)})}}},
              {"then", {{"$ref", "#/$defs/variant"}}},
              {"else", {{"$ref", "#/$defs/scene"}}}};
  Json& definitions = schema["$defs"];
  definitions["scene"] = std::move(scene);
  definitions["variant"] = std::move(variant);
  for (auto& [name, list] : lists) definitions[name] = std::move(list);
  return prettyJson(schema);
}

std::string sceneReference() {
  return ReferenceWriter::write([](FieldVisitor& visitor) {
    std::string none;
    visitor.text(kIncludeKey, none, kIncludeDoc);
    visitor.object(kSetKey, kSetDoc, [](FieldVisitor&) {});
    Scene scene;
    describeScene(visitor, scene);
  });
}

}  // namespace migiwa
