// The header of a PLY file: which elements follow, and of which numbers each consists.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

/// A number of a binary file; of text only the word matters.
struct PlyType {
  std::size_t bytes = 0;  ///< 0: none
  bool whole = false;     ///< an integer
  bool negative = false;  ///< may be below 0
};

/// One number of an element, or a list of them: how many, then so many.
struct PlyProperty {
  PlyType type;
  PlyType listCount;  ///< of no bytes: a single number
};

struct PlyElement {
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { ascii, littleEndian, bigEndian } format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;  ///< up to and with `end_header`
  std::string_view body;  ///< what follows
};

/// Reads the header of a file of this content, which has to outlive the result. Returns what is wrong with
/// it, as "expected ..., found ..."; empty where nothing is.
std::string readPlyHeader(std::string_view content, PlyHeader& header);

}  // namespace migiwa
