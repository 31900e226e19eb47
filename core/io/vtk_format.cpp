// VTK's legacy format, binary (which is big-endian): points, a vertex cell for each, and point data.
#include "core/io/binary_text.h"
#include "core/io/particle_format.h"

namespace migiwa {

namespace {

constexpr auto kOrder = std::endian::big;

void appendTriples(std::string& text, const std::vector<FloatTriple>& triples) {
  for (const FloatTriple& triple : triples)
    for (const float x : triple) appendBytes<kOrder>(text, x);
}

void appendField(std::string& text, const ParticleField& field) {
  const std::string name(field.name);
  if (field.kind == ParticleField::Kind::vectors) {
    text += "VECTORS " + name + " float\n";
    appendTriples(text, field.vectors);
  } else {
    text += "SCALARS " + name +
            (field.kind == ParticleField::Kind::numbers ? " float 1" : " unsigned_int 1") +
            "\nLOOKUP_TABLE default\n";
    for (const float x : field.numbers) appendBytes<kOrder>(text, x);
    for (const std::uint32_t x : field.integers) appendBytes<kOrder>(text, x);
  }
  text += '\n';
}

std::string vtkText(const ParticleFrame& frame) {
  const std::string n = std::to_string(frame.positions.size());
  std::string text = "# vtk DataFile Version 3.0\nparticles at " + std::to_string(frame.time) +
                     " s\nBINARY\nDATASET POLYDATA\nPOINTS " + n + " float\n";
  text.reserve(text.size() + frame.positions.size() * (20 + 12 * frame.fields.size()));
  appendTriples(text, frame.positions);
  if (frame.positions.empty()) return text;
  text += "\nVERTICES " + n + " " + std::to_string(2 * frame.positions.size()) + "\n";
  for (std::uint32_t k = 0; k < frame.positions.size(); ++k) {
    appendBytes<kOrder>(text, std::uint32_t{1});
    appendBytes<kOrder>(text, k);
  }
  text += "\nPOINT_DATA " + n + "\n";
  for (const ParticleField& field : frame.fields) appendField(text, field);
  return text;
}

}  // namespace

ParticleFormat vtkFormat() {
  return {"vtk", true, ".vtk.series", vtkText};
}

}  // namespace migiwa
