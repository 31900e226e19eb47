// The particles of one frame on their way to a file: positions and the chosen fields, in the order of the
// ids, so that a line of two files is the same particle as long as none came or went.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/simulation/frame_view.h"

namespace migiwa {

using FloatTriple = std::array<float, 3>;

/// One field of all particles.
struct ParticleField {
  enum class Kind { vectors, numbers, integers };
  std::string_view name;
  Kind kind = Kind::numbers;
  // The one that the kind names has the values.
  std::vector<FloatTriple> vectors;
  std::vector<float> numbers;
  std::vector<std::uint32_t> integers;
};

/// What can be written of a particle beside its position. An entry in the list of these is all that a field
/// takes.
struct ParticleFieldInfo {
  std::string_view name;  ///< as asked for, and as in the files
  std::string_view unit;
  std::string_view meaning;
  ParticleField::Kind kind;
  void (*copy)(const FrameView& view, ParticleField& out);
};
std::span<const ParticleFieldInfo> particleFields();

struct ParticleFrame {
  double time = 0;  ///< (s)
  long frame = 0;   ///< number of the frame in the run
  std::uint64_t stateHash = 0;
  std::vector<FloatTriple> positions;  ///< (m)
  std::vector<ParticleField> fields;
  std::vector<std::uint32_t> ids;

  /// Brings the particles into the order of their ids.
  void sortById();
};

/// A copy of a simulation's view with the named fields, in the view's order.
ParticleFrame copyParticles(const FrameView& view, long frame, std::span<const std::string> fields);

}  // namespace migiwa
