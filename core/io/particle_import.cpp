#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/io/surface_files.h"

namespace migiwa {

namespace {

constexpr double kMostImported = 1e9;

/// The text of a file, read from the front.
class ImportText {
 public:
  explicit ImportText(const std::filesystem::path& file)
      : place_(file.string()), text_(readTextFile(file, "a file of particles")) {}

  [[noreturn]] void fail(const std::string& message) const { throw InputError(place_, message); }

  bool startsWith(std::string_view word) const { return std::string_view(text_).starts_with(word); }
  bool atEnd() const { return at_ >= text_.size(); }
  std::string_view line() {
    if (atEnd()) fail("expected more lines, found the end of the file; is it cut off?");
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view found = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    if (found.ends_with('\r')) found.remove_suffix(1);
    return found;
  }
  std::string_view word() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    const std::size_t from = at_;
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) == 0) ++at_;
    return std::string_view(text_).substr(from, at_ - from);
  }
  const char* bytes(double wanted) {
    const double left = static_cast<double>(text_.size()) - static_cast<double>(std::min(at_, text_.size()));
    if (wanted > left)
      fail("expected " + formatNumber("%.0f", wanted) + " more bytes, found " + formatNumber("%.0f", left) +
           "; is the file cut off?");
    const char* const found = text_.data() + at_;
    at_ += static_cast<std::size_t>(wanted);
    return found;
  }
  std::size_t find(std::string_view word) const { return text_.find(word, at_); }
  void goTo(std::size_t at) { at_ = at; }

 private:
  std::string place_, text_;
  std::size_t at_ = 0;
};

std::vector<std::string> wordsOf(std::string_view line) {
  std::istringstream in{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

double importedNumber(const ImportText& text, std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    text.fail("expected a number, found \"" + std::string(word) + "\"");
  return value;
}

double importedCount(const ImportText& text, std::string_view word) {
  const double count = importedNumber(text, word);
  if (!(count >= 0 && count <= kMostImported) || count != std::floor(count))
    text.fail("expected a number of particles, found \"" + std::string(word) + "\"");
  return count;
}

/// "time 0.5 s", wherever it is in a line.
std::optional<double> timeIn(std::string_view line, std::string_view before) {
  const std::size_t from = line.find(before);
  if (from == std::string_view::npos) return std::nullopt;
  const std::string_view rest = line.substr(from + before.size());
  double value = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() ||
      std::string_view(end, static_cast<std::size_t>(rest.data() + rest.size() - end)) != " s")
    return std::nullopt;
  return value;
}

template <class T>
double numberAt(const char* bytes, bool reversed) {
  std::array<char, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (reversed) std::reverse(copy.begin(), copy.end());
  return static_cast<double>(std::bit_cast<T>(copy));
}

/// A type of numbers in files.
struct NumberType {
  std::string_view name, other;
  std::size_t bytes;
  double (*read)(const char* bytes, bool reversed);
};
constexpr std::array<NumberType, 8> kNumberTypes{{{"float", "float32", 4, numberAt<float>},
                                                  {"double", "float64", 8, numberAt<double>},
                                                  {"char", "int8", 1, numberAt<std::int8_t>},
                                                  {"uchar", "uint8", 1, numberAt<std::uint8_t>},
                                                  {"short", "int16", 2, numberAt<std::int16_t>},
                                                  {"ushort", "uint16", 2, numberAt<std::uint16_t>},
                                                  {"int", "int32", 4, numberAt<std::int32_t>},
                                                  {"uint", "uint32", 4, numberAt<std::uint32_t>}}};

const NumberType& numberType(const ImportText& text, const std::string& name) {
  for (const NumberType& type : kNumberTypes)
    if (type.name == name || type.other == name) return type;
  text.fail("expected a type of numbers such as float, found \"" + name + "\"");
}

/// Takes the coordinates of one particle after another.
class ParticleTaker {
 public:
  ParticleTaker(const ImportText& text, const Vec3d& origin) : text_(text), origin_(origin) {}

  void position(const std::array<double, 3>& place) {
    result.positions.push_back(
        finite(Vec3d(place[0], place[1], place[2]) - origin_, "coordinates", result.positions.size()));
  }
  void velocity(const std::array<double, 3>& u) {
    result.velocities.push_back(finite(Vec3d(u[0], u[1], u[2]), "velocities", result.velocities.size()));
  }
  ImportedParticles result;

 private:
  Float4 finite(const Vec3d& value, const std::string& what, std::size_t particle) const {
    if (!value.allFinite() ||
        value.cwiseAbs().maxCoeff() > static_cast<double>(std::numeric_limits<float>::max()))
      text_.fail("expected finite " + what + ", found others for particle " + std::to_string(particle) +
                 ", counted from 0");
    return Float4(value.cast<float>());
  }

  const ImportText& text_;
  Vec3d origin_;
};

struct PlyLayout {
  bool ascii = false;
  double count = -1;
  std::vector<const NumberType*> types;
  std::vector<std::string> names;
  std::size_t bytes = 0;
  std::vector<std::size_t> offsets;

  /// Number of the property, or that of all.
  std::size_t find(std::string_view name) const {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
};

PlyLayout plyLayout(ImportText& text, std::optional<double>& time) {
  PlyLayout layout;
  bool ofVertices = false, known = false;
  while (true) {
    const std::string_view line = text.line();
    const std::vector<std::string> words = wordsOf(line);
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "comment" && !time) time = timeIn(line, "time ");
    if (words[0] == "format") {
      known = words.size() >= 2 && (words[1] == "ascii" || words[1] == "binary_little_endian");
      layout.ascii = known && words[1] == "ascii";
    }
    if (words[0] == "element") {
      if (words.size() != 3)
        text.fail("expected \"element NAME COUNT\", found \"" + std::string(line) + "\"");
      ofVertices = words[1] == "vertex";
      if (ofVertices) layout.count = importedCount(text, words[2]);
      if (!ofVertices && layout.count < 0)
        text.fail("expected the element vertex first, found \"" + words[1] + "\"");
    }
    if (words[0] != "property" || !ofVertices) continue;
    if (words.size() != 3)
      text.fail("expected \"property TYPE NAME\" of a vertex, found \"" + std::string(line) + "\"");
    layout.types.push_back(&numberType(text, words[1]));
    layout.names.push_back(words[2]);
    layout.offsets.push_back(layout.bytes);
    layout.bytes += layout.types.back()->bytes;
  }
  if (!known) text.fail("expected the format ascii or binary_little_endian, found another");
  if (layout.count < 0) text.fail("expected an element vertex, found none");
  return layout;
}

void readPly(ImportText& text, ParticleTaker& taker) {
  const PlyLayout layout = plyLayout(text, taker.result.time);
  std::array<std::size_t, 6> columns{};
  constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "vx", "vy", "vz"};
  bool moving = true;
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    columns[k] = layout.find(kNames[k]);
    const bool there = columns[k] < layout.names.size();
    if (!there && k < 3)
      text.fail("expected the property " + std::string(kNames[k]) + " of vertices, found none");
    moving = moving && there;
  }
  const char* const data =
      layout.ascii ? nullptr : text.bytes(layout.count * static_cast<double>(layout.bytes));
  std::vector<double> row(layout.names.size());
  const auto count = static_cast<std::size_t>(layout.count);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t n = 0; n < row.size(); ++n)
      row[n] = layout.ascii ? importedNumber(text, text.word())
                            : layout.types[n]->read(data + k * layout.bytes + layout.offsets[n], false);
    taker.position({row[columns[0]], row[columns[1]], row[columns[2]]});
    if (moving) taker.velocity({row[columns[3]], row[columns[4]], row[columns[5]]});
  }
}

/// Legacy VTK, binary, which is big-endian: POINTS, and "velocity", an array of a FIELD or VECTORS.
void readVtk(ImportText& text, ParticleTaker& taker) {
  text.line();
  taker.result.time = timeIn(text.line(), " at ");
  if (text.line() != "BINARY") text.fail("expected a binary VTK file, found another; PLY can be ASCII");
  const auto triples = [&](double count, const std::string& typeName, const auto& take) {
    const NumberType& type = numberType(text, typeName);
    const char* data = text.bytes(3 * count * static_cast<double>(type.bytes));
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k, data += 3 * type.bytes)
      take({type.read(data, true), type.read(data + type.bytes, true),
            type.read(data + 2 * type.bytes, true)});
  };
  const std::size_t points = text.find("POINTS ");
  if (points == std::string::npos) text.fail("expected POINTS, found none");
  text.goTo(points);
  const std::vector<std::string> words = wordsOf(text.line());
  if (words.size() != 3) text.fail("expected \"POINTS COUNT TYPE\", found something else");
  const double count = importedCount(text, words[1]);
  triples(count, words[2], [&](const std::array<double, 3>& p) { taker.position(p); });
  // Bytes of the data could spell the name: only what goes on as an array of it counts.
  for (const std::string& array : {"\nvelocity 3 " + words[1] + " ", std::string("\nVECTORS velocity ")}) {
    const std::size_t velocity = text.find(array);
    if (velocity == std::string::npos) continue;
    text.goTo(velocity + array.size());
    triples(count, std::string(text.line()), [&](const std::array<double, 3>& u) { taker.velocity(u); });
    return;
  }
}

}  // namespace

ImportedParticles readParticles(const std::filesystem::path& file, const Vec3d& origin) {
  ImportText text(file);
  ParticleTaker taker(text, origin);
  if (text.startsWith("ply\n") || text.startsWith("ply\r\n")) {
    readPly(text, taker);
  } else if (text.startsWith("# vtk DataFile")) {
    readVtk(text, taker);
  } else {
    text.fail("expected particles as PLY or legacy VTK, found a file that begins otherwise");
  }
  return std::move(taker.result);
}

}  // namespace migiwa
