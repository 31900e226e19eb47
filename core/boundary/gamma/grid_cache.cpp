#include "core/boundary/gamma/grid_cache.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <type_traits>
#include <typeinfo>

#include "core/base/checksum.h"
#include "core/base/disk_cache.h"

namespace migiwa {

namespace fs = std::filesystem;

namespace {

/// Writes all fields one after another, numbers with every bit, and files by their content.
class TextVisitor final : public FieldWriter {
 public:
  const std::string& written() const { return written_; }

  void number(std::string_view key, const double& value, const Range&, const FieldDoc&) override {
    add(key);
    add(value);
  }
  void integer(std::string_view key, const int& value, const Range&, const FieldDoc&) override {
    add(key);
    add(static_cast<double>(value));
  }
  void boolean(std::string_view key, const bool& value, const FieldDoc&) override {
    add(key);
    add(value ? 1.0 : 0.0);
  }
  void text(std::string_view key, const std::string& value, const FieldDoc&) override {
    add(key);
    add(value);
  }
  void file(std::string_view key, const FileName& value, const FieldDoc&) override {
    add(key);
    if (value.empty()) return;
    add(value.identity.text());
    add(value.path.extension().string());  // the reader goes by it
  }
  void vector(std::string_view key, const Vec3d& value, const FieldDoc&) override {
    add(key);
    for (const double coordinate : value) add(coordinate);
  }
  void pair(std::string_view key, const std::array<double, 2>& value, const FieldDoc&, const bool*) override {
    add(key);
    for (const double end : value) add(end);
  }
  void triples(std::string_view key, const std::vector<std::array<double, 3>>& values,
               const FieldDoc&) override {
    add(key);
    for (const auto& triple : values)
      for (const double value : triple) add(value);
  }
  void choice(std::string_view key, const int& index, std::span<const std::string_view> names,
              const FieldDoc&) override {
    add(key);
    add(names[static_cast<std::size_t>(index)]);
  }
  void object(std::string_view key, const FieldDoc&, const Fields& fields, const bool*) override {
    add(key);
    fields(*this);
  }
  void list(std::string_view key, std::size_t size, const FieldDoc&, const Element& element) override {
    add(key);
    for (std::size_t at = 0; at < size; ++at) element(*this, at);
  }
  void variant(std::string_view key, const int& index, std::span<const std::string_view> names,
               const FieldDoc&, const Variant& fields) override {
    add(key);
    add(names[static_cast<std::size_t>(index)]);
    fields(*this, index);
  }
  void add(std::string_view word) { (written_ += word) += ' '; }
  void add(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%a ", value);
    written_ += digits;
  }
  using FieldWriter::choice;

 private:
  std::string written_;
};

constexpr std::array<char, 8> kMagic{'m', 'i', 'g', 'i', 'w', 'a', 'g', 'g'};
/// Raised whenever the file or what it means changes.
constexpr std::uint32_t kVersion = 2;
/// Tells a machine with another order of bytes.
constexpr std::uint32_t kOrder = 0x01020304;

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version, order;
  std::uint64_t keyBytes, blocks, floats;
  std::uint64_t checksum;  ///< of all that follows
  std::array<float, 3> origin;
  float cell;
  std::array<std::int32_t, 3> size;
  std::uint32_t unused;
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 80);

std::uint64_t checksumOf(const std::string& key, const GammaGrid& grid) {
  std::uint64_t sum = checksum(kEmptyChecksum, key.data(), key.size());
  const std::array<float, 4> place{grid.origin.x(), grid.origin.y(), grid.origin.z(), grid.cell};
  sum = checksum(sum, place.data(), sizeof place);
  sum = checksum(sum, grid.size.data(), sizeof grid.size);
  sum = checksum(sum, grid.blocks.data(), grid.blocks.size() * sizeof(std::int32_t));
  return checksum(sum, grid.coefficients.data(), grid.coefficients.size() * sizeof(float));
}

template <class T>
bool readInto(std::ifstream& in, std::vector<T>& values, std::uint64_t count) {
  values.resize(count);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
  return in.good();
}

}  // namespace

std::string describeWalls(const Boundary& boundary) {
  TextVisitor visitor;
  for (const auto& surface : boundary.surfaces()) {
    const Surface& one = *surface;
    visitor.add(typeid(one).name());
    one.describe(visitor);
  }
  return visitor.written();
}

fs::path gridFile(const fs::path& folder, const std::string& key) {
  char name[32];
  std::snprintf(name, sizeof name, "gamma_%016llx.grid",
                static_cast<unsigned long long>(checksum(kEmptyChecksum, key.data(), key.size())));
  return folder / name;
}

std::optional<GammaGrid> readGrid(const fs::path& file, const std::string& key) {
  if (MadeAnew::active()) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  Header header{};
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in || header.magic != kMagic || header.version != kVersion || header.order != kOrder)
    return std::nullopt;
  // Sizes are believed only where they make up the file.
  std::error_code code;
  const std::uint64_t bytes = fs::file_size(file, code);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
  if (code || header.keyBytes != key.size() || header.blocks > kMost || header.floats > kMost ||
      bytes != sizeof header + header.keyBytes + header.blocks * sizeof(std::int32_t) +
                   header.floats * sizeof(float))
    return std::nullopt;
  std::string found(key.size(), ' ');
  in.read(found.data(), static_cast<std::streamsize>(found.size()));
  if (!in || found != key) return std::nullopt;
  GammaGrid grid;
  grid.origin = Vec3f(header.origin[0], header.origin[1], header.origin[2]);
  grid.cell = header.cell;
  grid.size = header.size;
  if (!readInto(in, grid.blocks, header.blocks) || !readInto(in, grid.coefficients, header.floats) ||
      checksumOf(key, grid) != header.checksum)
    return std::nullopt;
  return grid;
}

bool writeGrid(const fs::path& file, const std::string& key, const GammaGrid& grid) {
  Header header{};
  header.magic = kMagic;
  header.version = kVersion;
  header.order = kOrder;
  header.keyBytes = key.size();
  header.blocks = grid.blocks.size();
  header.floats = grid.coefficients.size();
  header.checksum = checksumOf(key, grid);
  header.origin = {grid.origin.x(), grid.origin.y(), grid.origin.z()};
  header.cell = grid.cell;
  header.size = grid.size;
  return writeCacheFile(file, [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(key.data(), static_cast<std::streamsize>(key.size()));
    out.write(reinterpret_cast<const char*>(grid.blocks.data()),
              static_cast<std::streamsize>(grid.blocks.size() * sizeof(std::int32_t)));
    out.write(reinterpret_cast<const char*>(grid.coefficients.data()),
              static_cast<std::streamsize>(grid.coefficients.size() * sizeof(float)));
  });
}

}  // namespace migiwa
