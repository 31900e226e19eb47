// Readers of particle files for tests, written from the formats' descriptions and apart from the program's
// writers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace migiwa::testing {

/// Columns by name; every value as the four bytes that it has in memory.
struct ParticleTable {
  std::size_t count = 0;
  std::map<std::string, std::vector<std::uint32_t>> columns;
};

/// Takes `count` words of four bytes from a text.
class WordReader {
 public:
  WordReader(const std::string& text, std::size_t at, std::endian order)
      : text_(text), at_(at), swap_(order != std::endian::native) {}
  std::uint32_t next() {
    std::array<char, 4> bytes;
    if (at_ + 4 > text_.size()) throw std::runtime_error("the file ends too early");
    std::memcpy(bytes.data(), text_.data() + at_, 4);
    at_ += 4;
    if (swap_) {
      std::swap(bytes[0], bytes[3]);
      std::swap(bytes[1], bytes[2]);
    }
    return std::bit_cast<std::uint32_t>(bytes);
  }
  std::size_t at() const { return at_; }

 private:
  const std::string& text_;
  std::size_t at_;
  bool swap_;
};

/// A binary PLY file of vertices with properties of four bytes.
inline ParticleTable readPly(const std::string& text) {
  ParticleTable table;
  std::vector<std::string> names;
  std::istringstream in(text);
  std::string line, word, type, name;
  std::endian order = std::endian::native;
  while (std::getline(in, line) && line != "end_header") {
    std::istringstream words(line);
    words >> word;
    if (word == "format") {
      words >> type;
      order = type == "binary_big_endian" ? std::endian::big : std::endian::little;
    } else if (word == "element") {
      words >> type >> table.count;
    } else if (word == "property") {
      words >> type >> name;
      if (type != "float" && type != "uint") throw std::runtime_error("unforeseen type " + type);
      names.push_back(name);
    }
  }
  WordReader words(text, static_cast<std::size_t>(in.tellg()), order);
  for (std::size_t k = 0; k < table.count; ++k)
    for (const std::string& column : names) table.columns[column].push_back(words.next());
  if (words.at() != text.size()) throw std::runtime_error("something follows the vertices");
  return table;
}

/// A binary legacy VTK file of points, a vertex cell for each, and point data of four bytes a number. A
/// vector v has the columns v0, v1 and v2.
inline ParticleTable readVtk(const std::string& text) {
  ParticleTable table;
  std::size_t at = 0;
  const auto line = [&] {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) throw std::runtime_error("a line does not end");
    std::string found = text.substr(at, end - at);
    at = end + 1;
    return found;
  };
  const auto take = [&](const std::string& name, int components) {
    WordReader words(text, at, std::endian::big);
    for (std::size_t k = 0; k < table.count; ++k)
      for (int c = 0; c < components; ++c)
        table.columns[components > 1 ? name + std::to_string(c) : name].push_back(words.next());
    // Also those that hold nothing.
    for (int c = 0; c < components; ++c) table.columns[components > 1 ? name + std::to_string(c) : name];
    at = words.at();
  };
  const auto expect = [](const std::string& found, const std::string& expected) {
    if (found != expected) throw std::runtime_error("expected " + expected + ", found " + found);
  };
  expect(line(), "# vtk DataFile Version 3.0");
  line();
  expect(line(), "BINARY");
  expect(line(), "DATASET POLYDATA");
  while (at < text.size()) {
    std::istringstream words(line());
    std::string keyword, name, type;
    if (!(words >> keyword)) continue;  // an empty line after an array
    if (keyword == "POINTS") {
      words >> table.count >> type;
      expect(type, "float");
      take("position", 3);
    } else if (keyword == "VERTICES") {
      std::size_t cells = 0, numbers = 0;
      words >> cells >> numbers;
      expect(std::to_string(numbers), std::to_string(2 * cells));
      WordReader cell(text, at, std::endian::big);
      for (std::uint32_t k = 0; k < cells; ++k) {
        expect(std::to_string(cell.next()), "1");
        expect(std::to_string(cell.next()), std::to_string(k));
      }
      at = cell.at();
    } else if (keyword == "POINT_DATA") {
      std::size_t count = 0;
      words >> count;
      expect(std::to_string(count), std::to_string(table.count));
    } else if (keyword == "FIELD") {
      int arrays = 0;
      words >> name >> arrays;
      for (; arrays > 0; --arrays) {
        std::string heading = line();
        if (heading.empty()) heading = line();
        std::istringstream array(heading);
        int components = 0;
        std::size_t count = 0;
        array >> name >> components >> count >> type;
        if (type != "float" && type != "unsigned_int") throw std::runtime_error("unforeseen type " + type);
        expect(std::to_string(count), std::to_string(table.count));
        take(name, components);
      }
    } else {
      throw std::runtime_error("unforeseen keyword " + keyword);
    }
  }
  return table;
}

}  // namespace migiwa::testing
