// Polygon File Format, binary, with one property for each number of a field.
#include "core/io/binary_text.h"
#include "core/io/particle_format.h"

namespace migiwa {

namespace {

constexpr auto kOrder = std::endian::little;

std::string header(const ParticleFrame& frame) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment time " + std::to_string(frame.time) +
                     " s\nelement vertex " + std::to_string(frame.positions.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  for (const ParticleField& field : frame.fields) {
    if (field.kind == ParticleField::Kind::vectors) {
      // vx, vy, vz is how readers know a velocity.
      const std::string letter(1, field.name.front());
      for (const char* axis : {"x", "y", "z"})
        text.append("property float ").append(letter).append(axis).append("\n");
    } else {
      text += field.kind == ParticleField::Kind::numbers ? "property float " : "property uint ";
      text.append(field.name).append("\n");
    }
  }
  return text + "end_header\n";
}

std::string plyText(const ParticleFrame& frame) {
  std::string text = header(frame);
  text.reserve(text.size() + frame.positions.size() * (12 + 12 * frame.fields.size()));
  for (std::size_t k = 0; k < frame.positions.size(); ++k) {
    for (const float x : frame.positions[k]) appendBytes<kOrder>(text, x);
    for (const ParticleField& field : frame.fields) {
      if (!field.vectors.empty())
        for (const float x : field.vectors[k]) appendBytes<kOrder>(text, x);
      if (!field.numbers.empty()) appendBytes<kOrder>(text, field.numbers[k]);
      if (!field.integers.empty()) appendBytes<kOrder>(text, field.integers[k]);
    }
  }
  return text;
}

}  // namespace

ParticleFormat plyFormat() {
  return {"ply", true, "", plyText};
}

}  // namespace migiwa
