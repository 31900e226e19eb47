#include "app/commands/picture_file.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "app/render/png.h"
#include "core/base/state_hash.h"
#include "core/io/output_file.h"

namespace migiwa {
namespace {

using Json = nlohmann::ordered_json;

/// Sums of steps miss round times by what a double cannot hold.
double roundedTime(double seconds) {
  return std::round(seconds * 1e9) / 1e9;
}

Json json(const PictureContext& context, const Image& image) {
  return {{"scene", context.scene},
          {"size", {image.width, image.height}},
          {"panels", context.panels},
          {"color",
           {{"field", context.colorField},
            {"unit", context.colorUnit},
            {"low", context.colorRange[0]},
            {"high", context.colorRange[1]}}},
          {"renderer", context.renderer}};
}

Json json(const PictureRecord& record) {
  return {{"overrides", record.overrides},
          {"time", roundedTime(record.time)},
          {"steps", record.steps},
          {"particles", record.particles},
          {"handling", record.handling},
          {"iterations", record.iterations},
          {"state_hash", hexDigits(record.stateHash)}};
}

void write(const std::filesystem::path& file, const Image& image, const Json& sidecar) {
  std::filesystem::path beside = file;
  beside.replace_extension(".json");
  writeTextFile(file, encodePng(image));
  writeTextFile(beside, sidecar.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

}  // namespace

PictureRecord pictureRecord(const FrameView& frame, const std::vector<Override>& overrides) {
  const FrameInfo& info = frame.info;
  PictureRecord record{info.time,      info.steps, frame.positions.size(), info.handling, info.iterations,
                       info.stateHash, {}};
  for (const Override& change : overrides) record.overrides.push_back(change.pointer + "=" + change.value);
  return record;
}

void writePicture(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                  const PictureRecord& record) {
  Json sidecar = json(context, image);
  sidecar.update(json(record));
  write(file, image, sidecar);
}

void writeSheet(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                const std::vector<std::vector<PictureRecord>>& rows) {
  Json sidecar = json(context, image);
  sidecar["rows"] = Json::array();
  for (const std::vector<PictureRecord>& row : rows) {
    Json cells = Json::array();
    for (const PictureRecord& cell : row) cells.push_back(json(cell));
    sidecar["rows"].push_back(cells);
  }
  write(file, image, sidecar);
}

}  // namespace migiwa
