// A file format for the particles of a frame. A format is one file that defines it and one line in
// particle_format_registry.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/io/particle_frame.h"

namespace migiwa {

struct ParticleFormat {
  std::string_view name;  ///< as asked for; also the ending of the files
  bool holdsFields;       ///< or positions only
  /// Endings of a list of all files and their times that programs for this format know; empty: none.
  std::string_view seriesEnding;
  /// The content of the file.
  std::string (*text)(const ParticleFrame& frame);
};

ParticleFormat plyFormat();
ParticleFormat vtkFormat();
ParticleFormat objFormat();

std::span<const ParticleFormat> particleFormats();

}  // namespace migiwa
