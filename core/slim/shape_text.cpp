#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "core/slim/shape_import.h"
#include "core/slim/text_lines.h"

namespace migiwa {

namespace {

/// In diagonals of the shape: where a float's last digit is a quarter of a millionth of it.
constexpr double kFar = 4;

/// One number of a file: where it is, and what it says.
struct Coordinate {
  std::size_t at, length;
  double value;
};

/// Three for each point.
struct Coordinates {
  std::vector<Coordinate> numbers;
  bool binary = false, bigEndian = false;
};

/// Adds the next three words of a line; false where they are no numbers.
bool addThree(TextLines& lines, std::string_view content, std::vector<Coordinate>& out) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = lines.word();
    Coordinate coordinate{static_cast<std::size_t>(word.data() - content.data()), word.size(), 0};
    if (!isNumber(word, coordinate.value) || !std::isfinite(coordinate.value)) return false;
    out.push_back(coordinate);
  }
  return true;
}

/// Of lines that begin with a word.
std::optional<Coordinates> ofLines(std::string_view content, std::string_view keyword) {
  Coordinates result;
  TextLines lines(content);
  while (lines.next())
    if (lines.word() == keyword && !addThree(lines, content, result.numbers)) return std::nullopt;
  return result;
}

/// Places of x, y and z among an element's properties, which are all single numbers.
std::optional<std::array<std::size_t, 3>> placesOf(const PlyElement& element) {
  std::array<std::size_t, 3> places{};
  std::array<bool, 3> found{};
  for (std::size_t k = 0; k < element.properties.size(); ++k) {
    const PlyProperty& property = element.properties[k];
    if (property.listCount.bytes > 0) return std::nullopt;
    const std::size_t axis = std::string_view("xyz").find(property.name);
    if (property.name.size() == 1 && axis < 3) places[axis] = k, found[axis] = true;
  }
  if (!found[0] || !found[1] || !found[2]) return std::nullopt;
  return places;
}

double doubleAt(std::string_view content, std::size_t at, bool bigEndian) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < 8; ++k)
    bits = bits << 8U | static_cast<unsigned char>(content[at + (bigEndian ? k : 7 - k)]);
  return std::bit_cast<double>(bits);
}

std::optional<Coordinates> ofPly(std::string_view content) {
  PlyHeader header;
  if (!readPlyHeader(content, header).empty() || header.elements.empty()) return std::nullopt;
  const PlyElement& vertices = header.elements.front();
  const auto places = placesOf(vertices);
  if (vertices.name != "vertex" || !places) return std::nullopt;
  Coordinates result;
  if (header.format == PlyHeader::Format::ascii) {
    TextLines lines(header.body, header.lines);
    for (std::uint64_t k = 0; k < vertices.count; ++k) {
      if (!lines.next()) return std::nullopt;
      std::array<Coordinate, 3> point{};
      for (std::size_t word = 0; word < vertices.properties.size(); ++word) {
        const std::string_view text = lines.word();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if ((*places)[axis] != word) continue;
          point[axis] = {static_cast<std::size_t>(text.data() - content.data()), text.size(), 0};
          if (!isNumber(text, point[axis].value) || !std::isfinite(point[axis].value)) return std::nullopt;
        }
      }
      result.numbers.insert(result.numbers.end(), point.begin(), point.end());
    }
    return result;
  }
  result.binary = true;
  result.bigEndian = header.format == PlyHeader::Format::bigEndian;
  std::vector<std::size_t> offsets;
  std::size_t stride = 0;
  for (const PlyProperty& property : vertices.properties) {
    offsets.push_back(stride);
    stride += property.type.bytes;
  }
  for (const std::size_t place : *places)
    if (vertices.properties[place].type.bytes != 8) return std::nullopt;
  std::size_t at = content.size() - header.body.size();
  for (std::uint64_t k = 0; k < vertices.count; ++k, at += stride)
    for (const std::size_t place : *places) {
      const double value = doubleAt(content, at + offsets[place], result.bigEndian);
      if (!std::isfinite(value)) return std::nullopt;
      result.numbers.push_back({at + offsets[place], 8, value});
    }
  return result;
}

std::optional<Coordinates> coordinatesOf(std::string_view content, std::string_view ending) {
  if (ending == "obj") return ofLines(content, "v");
  if (ending == "stl" && content.starts_with("solid")) return ofLines(content, "vertex");
  if (ending == "ply") return ofPly(content);
  return std::nullopt;
}

/// The same content with other numbers.
std::string rewritten(const std::string& content, const Coordinates& coordinates, const Vec3d& origin) {
  std::string result;
  result.reserve(content.size());
  std::size_t from = 0;
  // Properties may come in any order; the text may not.
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t k = 0; k < coordinates.numbers.size(); ++k)
    order.emplace_back(coordinates.numbers[k].at, k);
  std::sort(order.begin(), order.end());
  for (const auto& [at, k] : order) {
    const Coordinate& number = coordinates.numbers[k];
    const double moved = number.value - origin[static_cast<Eigen::Index>(k % 3)];
    result.append(content, from, at - from);
    if (coordinates.binary) {
      const auto bits = std::bit_cast<std::uint64_t>(moved);
      for (std::size_t byte = 0; byte < 8; ++byte)
        result += static_cast<char>(bits >> (8 * (coordinates.bigEndian ? 7 - byte : byte)) & 0xFFU);
    } else {
      std::array<char, 32> text{};
      const auto end = std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(moved));
      result.append(text.data(), end.ptr);
    }
    from = at + number.length;
  }
  return result.append(content, from);
}

}  // namespace

Vec3d moveToOrigin(std::string& content, std::string_view ending) {
  const std::optional<Coordinates> coordinates = coordinatesOf(content, ending);
  Bounds bounds;
  if (coordinates)
    for (std::size_t k = 0; k + 2 < coordinates->numbers.size(); k += 3)
      bounds.include(Vec3d(coordinates->numbers[k].value, coordinates->numbers[k + 1].value,
                           coordinates->numbers[k + 2].value));
  if (bounds.empty() || bounds.center().norm() <= kFar * bounds.size().norm()) return Vec3d::Zero();
  const Vec3d origin = bounds.center();
  content = rewritten(content, *coordinates, origin);
  return origin;
}

namespace {

/// Whether a word of a heading names the axis: X, "x" or //X.
bool names(std::string_view word, char axis) {
  while (!word.empty() && (word.front() == '/' || word.front() == '"')) word.remove_prefix(1);
  if (!word.empty() && word.back() == '"') word.remove_suffix(1);
  return word.size() == 1 && (word[0] | 0x20) == axis;
}

}  // namespace

std::string readXyz(std::string_view content, XyzPoints& points, std::vector<std::string>& notes) {
  constexpr std::size_t kMost = 16;
  TextLines lines(content, 0, " \t\r\v\f,;");
  std::optional<std::uint64_t> promised;
  std::size_t width = 0;
  bool unit = true;
  while (lines.next()) {
    std::array<double, kMost> numbers{};
    std::size_t count = 0;
    for (std::string_view word = lines.word(); !word.empty() && !word.starts_with('#'); word = lines.word()) {
      // The names of the columns, before the first point.
      if (width == 0 && count == 0 && names(word, 'x') && names(lines.word(), 'y') &&
          names(lines.word(), 'z'))
        break;
      if (count == kMost || !isNumber(word, numbers[count]))
        return "expected a line of numbers (x y z, or x y z nx ny nz) in " + lines.place() + ", found \"" +
               std::string(word.substr(0, 40)) + '"';
      ++count;
    }
    if (count == 0) continue;
    if (count == 1 && width == 0 && !promised && numbers[0] >= 0 && numbers[0] < 1e15 &&
        numbers[0] == std::floor(numbers[0])) {
      promised = static_cast<std::uint64_t>(numbers[0]);
      continue;
    }
    if (width == 0) width = count;
    if (count != width || count < 3)
      return "expected " + (width >= 3 ? std::to_string(width) : std::string("3 or 6")) + " numbers in " +
             lines.place() + (width >= 3 ? ", as in the lines before" : " (x y z, or x y z nx ny nz)") +
             ", found " + std::to_string(count);
    const Vec3d position(numbers[0], numbers[1], numbers[2]), normal(numbers[3], numbers[4], numbers[5]);
    points.positions.push_back(position);
    if (count < 6) continue;
    const double length = normal.norm();
    unit = unit && length < 1.1;
    points.normals.push_back(length > 1e-6 ? Vec3f((normal / length).cast<float>()) : Vec3f(Vec3f::Zero()));
  }
  if (promised && *promised != points.positions.size())
    return "expected " + std::to_string(*promised) + " points, as the first line says, found " +
           std::to_string(points.positions.size());
  if (!unit) points.normals.clear();
  if (width > 3 && points.normals.empty())
    notes.push_back("only x y z of the " + std::to_string(width) +
                    " numbers in a line were taken: the next three are no unit normals");
  else if (width > 6)
    notes.push_back("only the first 6 of the " + std::to_string(width) + " numbers in a line were taken");
  return {};
}

}  // namespace migiwa
