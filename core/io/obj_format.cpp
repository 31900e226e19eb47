// Wavefront OBJ: a vertex for each particle, and a point element, without which some programs show nothing.
#include <array>
#include <charconv>

#include "core/io/particle_format.h"

namespace migiwa {

namespace {

std::string objText(const ParticleFrame& frame) {
  std::string text = "# particles at " + std::to_string(frame.time) + " s\n";
  std::array<char, 32> digits;
  const auto append = [&](const auto& value) {
    text += ' ';
    // The shortest digits that read back as the same number.
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text.append(digits.data(), end);
  };
  for (const FloatTriple& position : frame.positions) {
    text += 'v';
    for (const float x : position) append(x);
    text += '\n';
  }
  for (std::size_t k = 1; k <= frame.positions.size(); ++k) {
    text += 'p';
    append(k);
    text += '\n';
  }
  return text;
}

}  // namespace

ParticleFormat objFormat() {
  return {"obj", false, "", objText};
}

}  // namespace migiwa
