#include <array>

#include "core/io/particle_format.h"

namespace migiwa {

std::span<const ParticleFormat> particleFormats() {
  static const std::array kFormats{plyFormat(), vtkFormat(), objFormat()};
  return kFormats;
}

}  // namespace migiwa
