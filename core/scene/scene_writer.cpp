#include "core/scene/scene_writer.h"

#include "core/scene/json_writer.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

std::string writeScene(const Scene& scene) {
  return prettyJson(JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); }));
}

}  // namespace migiwa
