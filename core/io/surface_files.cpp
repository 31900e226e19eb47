#include "core/io/surface_files.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>

namespace migiwa {

namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written as it is in memory");

template <class T>
void appendRaw(std::string& text, const T& value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Polygon File Format, binary: normals and velocities are properties of the vertices, `wet` one of the faces.

std::string surfacePly(const SurfaceFrame& frame) {
  const SurfaceMesh& mesh = frame.mesh;
  const bool far = !frame.origin.isZero(0);
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment time " + std::to_string(frame.time) +
                     " s\nelement vertex " + std::to_string(mesh.positions.size()) + "\n";
  for (const char* name : {"x", "y", "z"})
    text.append(far ? "property double " : "property float ").append(name) += '\n';
  for (const char* name : {"nx", "ny", "nz", "vx", "vy", "vz"})
    text.append("property float ").append(name) += '\n';
  text += "element face " + std::to_string(mesh.triangles.size()) +
          "\nproperty list uchar uint vertex_indices\nproperty uchar wet\nend_header\n";
  text.reserve(text.size() + mesh.positions.size() * (far ? 48 : 36) + mesh.triangles.size() * 14);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (far) {
      const Vec3d place = frame.origin + mesh.positions[v].cast<double>();
      for (int axis = 0; axis < 3; ++axis) appendRaw(text, place[axis]);
    } else {
      appendRaw(text, std::array{mesh.positions[v].x(), mesh.positions[v].y(), mesh.positions[v].z()});
    }
    const Vec3f &n = mesh.normals[v], &u = mesh.velocities[v];
    appendRaw(text, std::array{n.x(), n.y(), n.z(), u.x(), u.y(), u.z()});
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    text += '\3';
    appendRaw(text, mesh.triangles[t]);
    text += static_cast<char>(mesh.wet[t]);
  }
  return text;
}

// Wavefront OBJ: free and wet faces are groups of their own.

class ObjText {
 public:
  template <class T>
  void line(const char* word, const std::array<T, 3>& values) {
    text_ += word;
    for (const T value : values) number(value);
    text_ += '\n';
  }
  void face(const std::array<std::uint32_t, 3>& triangle) {
    text_ += 'f';
    for (const std::uint32_t v : triangle) {
      number(v + 1);
      text_ += "//";
      digits(v + 1);
    }
    text_ += '\n';
  }
  void add(const std::string& text) { text_ += text; }
  std::string take() { return std::move(text_); }

 private:
  template <class T>
  void number(T value) {
    text_ += ' ';
    digits(value);
  }
  /// The fewest digits that read back as the same number.
  template <class T>
  void digits(T value) {
    std::array<char, 32> buffer;
    text_.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
  }

  std::string text_;
};

std::string surfaceObj(const SurfaceFrame& frame) {
  const SurfaceMesh& mesh = frame.mesh;
  ObjText text;
  text.add("# surface at " + std::to_string(frame.time) + " s\n");
  for (const Vec3f& p : mesh.positions) {
    if (frame.origin.isZero(0)) {
      text.line("v", std::array{p.x(), p.y(), p.z()});
    } else {
      const Vec3d place = frame.origin + p.cast<double>();
      text.line("v", std::array{place.x(), place.y(), place.z()});
    }
  }
  for (const Vec3f& n : mesh.normals) text.line("vn", std::array{n.x(), n.y(), n.z()});
  for (const bool wet : {false, true}) {
    text.add(wet ? "g wet\n" : "g free\n");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if ((mesh.wet[t] != 0) == wet) text.face(mesh.triangles[t]);
  }
  return text.take();
}

constexpr std::array<SurfaceFormat, 2> kFormats{{
    {"ply", "binary; normals, velocities, and which faces are wet", surfacePly},
    {"obj", "normals, and the groups free and wet", surfaceObj},
}};

}  // namespace

std::span<const SurfaceFormat> surfaceFormats() {
  return kFormats;
}

}  // namespace migiwa
