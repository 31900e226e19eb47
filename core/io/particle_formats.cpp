// Numbers as bytes in a given order, whatever the machine's own.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>

#include "core/io/particle_export.h"

namespace migiwa {

/// Appends the bytes of a number of 32 or 64 bits.
template <std::endian kOrder, class T>
void appendBytes(std::string& text, T value) {
  static_assert(sizeof(T) == 4 || sizeof(T) == 8);
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if constexpr (kOrder != std::endian::native) std::reverse(bytes, bytes + sizeof(T));
  text.append(bytes, sizeof(T));
}

std::array<double, 3> ParticleFrame::placeOf(std::size_t particle) const {
  const auto& [x, y, z] = positions[particle];
  return {origin.x() + static_cast<double>(x), origin.y() + static_cast<double>(y),
          origin.z() + static_cast<double>(z)};
}

// Wavefront OBJ: a vertex for each particle, and a point element, without which some programs show nothing.

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
  for (std::size_t k = 0; k < frame.positions.size(); ++k) {
    text += 'v';
    if (frame.far()) {
      for (const double x : frame.placeOf(k)) append(x);
    } else {
      for (const float x : frame.positions[k]) append(x);
    }
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

// Polygon File Format, binary, with one property for each number of a field.

namespace {

std::string header(const ParticleFrame& frame) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment time " + std::to_string(frame.time) +
                     " s\nelement vertex " + std::to_string(frame.positions.size()) + "\n";
  for (const char axis : {'x', 'y', 'z'})
    text.append(frame.far() ? "property double " : "property float ").append(1, axis).append("\n");
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
  text.reserve(text.size() + frame.positions.size() * (24 + 12 * frame.fields.size()));
  for (std::size_t k = 0; k < frame.positions.size(); ++k) {
    if (frame.far()) {
      for (const double x : frame.placeOf(k)) appendBytes<std::endian::little>(text, x);
    } else {
      for (const float x : frame.positions[k]) appendBytes<std::endian::little>(text, x);
    }
    for (const ParticleField& field : frame.fields) {
      if (!field.vectors.empty())
        for (const float x : field.vectors[k]) appendBytes<std::endian::little>(text, x);
      if (!field.numbers.empty()) appendBytes<std::endian::little>(text, field.numbers[k]);
      if (!field.integers.empty()) appendBytes<std::endian::little>(text, field.integers[k]);
    }
  }
  return text;
}

}  // namespace

ParticleFormat plyFormat() {
  return {"ply", true, "", plyText};
}

// VTK's legacy format, binary (which is big-endian): points, a vertex cell for each, and point data. As
// arrays of a FIELD, for of several SCALARS some readers show only the first; also where there is no
// particle, so that a sequence has the same arrays throughout.

namespace {

void appendTriples(std::string& text, const std::vector<FloatTriple>& triples) {
  for (const FloatTriple& triple : triples)
    for (const float x : triple) appendBytes<std::endian::big>(text, x);
}

void appendField(std::string& text, const ParticleField& field) {
  const bool vectors = field.kind == ParticleField::Kind::vectors,
             integers = field.kind == ParticleField::Kind::integers;
  const std::size_t count = field.vectors.size() + field.numbers.size() + field.integers.size();
  text.append(field.name).append(vectors ? " 3 " : " 1 ").append(std::to_string(count));
  text += integers ? " unsigned_int\n" : " float\n";
  appendTriples(text, field.vectors);
  for (const float x : field.numbers) appendBytes<std::endian::big>(text, x);
  for (const std::uint32_t x : field.integers) appendBytes<std::endian::big>(text, x);
  text += '\n';
}

std::string vtkText(const ParticleFrame& frame) {
  const std::string n = std::to_string(frame.positions.size());
  std::string text = "# vtk DataFile Version 3.0\nparticles at " + std::to_string(frame.time) +
                     " s\nBINARY\nDATASET POLYDATA\nPOINTS " + n + (frame.far() ? " double\n" : " float\n");
  text.reserve(text.size() + frame.positions.size() * (32 + 12 * frame.fields.size()));
  if (frame.far()) {
    for (std::size_t k = 0; k < frame.positions.size(); ++k)
      for (const double x : frame.placeOf(k)) appendBytes<std::endian::big>(text, x);
  } else {
    appendTriples(text, frame.positions);
  }
  text += "\nVERTICES " + n + " " + std::to_string(2 * frame.positions.size()) + "\n";
  for (std::uint32_t k = 0; k < frame.positions.size(); ++k) {
    appendBytes<std::endian::big>(text, std::uint32_t{1});
    appendBytes<std::endian::big>(text, k);
  }
  text += "\nPOINT_DATA " + n + "\n";
  if (!frame.fields.empty()) text += "FIELD FieldData " + std::to_string(frame.fields.size()) + "\n";
  for (const ParticleField& field : frame.fields) appendField(text, field);
  return text;
}

}  // namespace

ParticleFormat vtkFormat() {
  return {"vtk", true, ".vtk.series", vtkText};
}

std::span<const ParticleFormat> particleFormats() {
  static const std::array kFormats{plyFormat(), vtkFormat(), objFormat()};
  return kFormats;
}

namespace {

std::vector<FloatTriple> triples(std::span<const Float4> vectors) {
  std::vector<FloatTriple> result;
  result.reserve(vectors.size());
  for (const Float4& v : vectors) result.push_back({v.x, v.y, v.z});
  return result;
}

using Kind = ParticleField::Kind;

constexpr std::array<ParticleFieldInfo, 6> kFields{{
    {"velocity", "m/s", "velocity", Kind::vectors,
     [](const FrameView& view, ParticleField& out) { out.vectors = triples(view.velocities); }},
    {"density", "1", "density over the density at rest", Kind::numbers,
     [](const FrameView& view, ParticleField& out) {
       out.numbers.assign(view.density.begin(), view.density.end());
     }},
    {"gamma", "1", "part of the neighbourhood that no wall covers", Kind::numbers,
     [](const FrameView& view, ParticleField& out) {
       out.numbers.assign(view.gamma.begin(), view.gamma.end());
     }},
    {"lambda", "1", "multiplier of the density constraint over the squared support radius", Kind::numbers,
     [](const FrameView& view, ParticleField& out) {
       out.numbers.assign(view.lambda.begin(), view.lambda.end());
     }},
    {"neighbours", "1", "particles within the support radius", Kind::integers,
     [](const FrameView& view, ParticleField& out) {
       out.integers.assign(view.neighbours.begin(), view.neighbours.end());
     }},
    {"id", "1", "tells particles apart from frame to frame", Kind::integers,
     [](const FrameView& view, ParticleField& out) {
       out.integers.assign(view.ids.begin(), view.ids.end());
     }},
}};

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::uint32_t from : order) sorted.push_back(values[from]);
  values.swap(sorted);
}

}  // namespace

std::span<const ParticleFieldInfo> particleFields() {
  return kFields;
}

ParticleFrame copyParticles(const FrameView& view, long frame, std::span<const std::string> fields,
                            const Vec3d& origin) {
  ParticleFrame copy;
  copy.origin = origin;
  copy.time = view.info.time;
  copy.frame = frame;
  copy.stateHash = view.info.stateHash;
  copy.positions = triples(view.positions);
  copy.ids.assign(view.ids.begin(), view.ids.end());
  for (const std::string& name : fields) {
    for (const ParticleFieldInfo& info : kFields) {
      if (info.name != name) continue;
      ParticleField field{info.name, info.kind, {}, {}, {}};
      info.copy(view, field);
      copy.fields.push_back(std::move(field));
    }
  }
  return copy;
}

void ParticleFrame::sortById() {
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0U);
  const std::uint32_t largest = ids.empty() ? 0 : *std::max_element(ids.begin(), ids.end());
  if (largest + std::size_t{1} == ids.size()) {
    // Every number up to the last is there once: an id is a place.
    for (std::uint32_t k = 0; k < order.size(); ++k) order[ids[k]] = k;
  } else {
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
  }
  reorder(positions, order);
  for (ParticleField& field : fields) {
    reorder(field.vectors, order);
    reorder(field.numbers, order);
    reorder(field.integers, order);
  }
  reorder(ids, order);
}

}  // namespace migiwa
