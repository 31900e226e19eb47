// A picture on disk: the PNG, and beside it a JSON file that says what it shows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/render/image.h"
#include "app/viewer/viewer.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

/// What one picture, or one cell of a sheet, shows. Holds no wall time: two runs write the same bytes.
struct PictureRecord {
  double time = 0;  ///< simulated (s)
  long steps = 0;
  std::size_t particles = 0;
  std::string handling;
  int iterations = 0;
  std::uint64_t stateHash = 0;
  std::vector<std::string> overrides;  ///< `/json/pointer=VALUE`, in order
};
PictureRecord pictureRecord(const FrameView& frame, const std::vector<Override>& overrides);

/// What all cells of a picture file share.
struct PictureContext {
  std::string scene;     ///< the scene file as it was given
  std::string renderer;  ///< driver and version
  bool panels = false;
  std::string colorField, colorUnit;
  std::array<double, 2> colorRange{0, 1};
};

/// Writes `file` (.png) and its sidecar (.json).
void writePicture(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                  const PictureRecord& record);
/// The same for a sheet of cells, row by row.
void writeSheet(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                const std::vector<std::vector<PictureRecord>>& rows);

}  // namespace migiwa
