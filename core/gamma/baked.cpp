// gamma from a grid about the walls that is made once and kept on disk: for walls that stand still and cost
// much to look at. Where a thin wall is near, deep in the solid and outside the grid, directions take its
// place.
#include "core/gamma/baked.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <limits>
#include <system_error>
#include <type_traits>
#include <typeinfo>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/gamma/batches.h"
#include "core/gamma/gamma_method.h"

namespace migiwa {

namespace {

/// Cells along a support radius: with these the grid is within 0.005.
constexpr float kCellsPerSupport = 5;
/// Some seconds on one core: blocks with coefficients, and all of them.
constexpr double kQuickUsed = 2e4, kQuickBlocks = 1e6;

class BakedGamma final : public GridGamma {
 public:
  /// A grid of more blocks than `mostBlocks` is not even laid out.
  explicit BakedGamma(const GammaContext& context, bool curvedOnly = false,
                      double mostBlocks = std::numeric_limits<double>::infinity())
      : boundary_(context.boundary),
        exact_(exactWalls(boundary_)),
        support_(context.supportRadius),
        elsewhere_(makeDirectionsGamma(fine(context))),
        ownPool_(context.pool != nullptr ? nullptr : std::make_unique<ThreadPool>(1)),
        pool_(context.pool != nullptr ? *context.pool : *ownPool_) {
    Bounds region = context.region;
    if (region.empty())
      for (const auto& surface : boundary_.surfaces()) region.include(surface->bounds());
    if (region.empty()) {
      reason_ = "walls without end and no fluid: 1024 directions instead of a grid";
      return;
    }
    settings_ = {context.kernel,
                 support_,
                 support_ / kCellsPerSupport,
                 region.grown(static_cast<double>(support_)),
                 curvedOnly,
                 context.place};
    if (blocksIn(settings_) <= mostBlocks) grid_ = layOut(exact_, settings_, pool_);
  }

  bool laidOut() const { return !grid_.blocks.empty(); }
  /// Blocks to be filled.
  double used() const {
    return static_cast<double>(
        std::count_if(grid_.blocks.begin(), grid_.blocks.end(), [](auto at) { return at >= 0; }));
  }

  /// Reads the grid or makes it.
  void fill() {
    if (!laidOut()) return;
    const std::string source = readOrMake();
    const double mebibytes = static_cast<double>(grid_.coefficients.size() * sizeof(float)) / (1024.0 * 1024);
    char text[64];
    std::snprintf(text, sizeof text, "a grid of %.1f MiB, ", mebibytes);
    reason_ = text + source;
  }

  GammaChoice choice() const override { return {"baked", reason_}; }
  long takeOutOfRange() const override { return elsewhere_->takeOutOfRange(); }
  bool covers(const Vec3f& p) const override { return laidOut() && grid_.placeOf(p).state >= 0; }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    measure(boundary_, points, out);
    evaluateMeasured(points, out);
  }

  void evaluateMeasured(std::span<const Float4> points, std::span<GammaSample> out) const override {
    std::array<GammaGrid::Place, kBatch> places;
    for (std::size_t begin = 0; begin < points.size(); begin += kBatch) {
      const std::size_t count = std::min(kBatch, points.size() - begin);
      const auto at = points.subspan(begin, count);
      const auto samples = out.subspan(begin, count);
      for (std::size_t i = 0; i < count; ++i) {
        places[i].state = GammaGrid::kFar;
        if (samples[i].distance < support_) places[i] = grid_.placeOf(at[i].xyz());
        if (places[i].state == GammaGrid::kElsewhere)
          elsewhere_->evaluate(at.subspan(i, 1), samples.subspan(i, 1));
      }
      interpolate(grid_, support_, std::span(places).first(count), samples);
    }
  }

 private:
  static constexpr std::size_t kBatch = 64;

  static Boundary exactWalls(const Boundary& boundary) {
    std::vector<std::shared_ptr<const Surface>> surfaces;
    for (const auto& surface : boundary.surfaces()) {
      const std::shared_ptr<const Surface> exact = surface->exact();
      surfaces.push_back(exact != nullptr ? exact : surface);
    }
    return Boundary::atRest(std::move(surfaces));
  }

  static GammaContext fine(GammaContext context) {
    context.directions = 1024;
    return context;
  }

  /// Says what it did.
  std::string readOrMake() {
    const std::string key = keyOf(settings_);
    const std::filesystem::path folder = cacheFolder();
    const std::filesystem::path file = folder.empty() ? folder : gridFile(folder, key);
    if (!file.empty()) {
      if (std::optional<GammaGrid> known = readGrid(file, key)) {
        grid_ = *std::move(known);
        return "read from " + file.string();
      }
    }
    bake(exact_, settings_, pool_, grid_);
    const bool kept = !file.empty() && writeGrid(file, key, grid_);
    return kept ? "made and kept in " + file.string()
                : "made and not kept: no folder to write to; MIGIWA_CACHE in the environment can name one";
  }

  /// Everything that the grid depends on.
  std::string keyOf(const BakeSettings& settings) const {
    char text[256];
    std::snprintf(text, sizeof text, "kernel %d support %a cell %a curved %d region %a %a %a %a %a %a\n",
                  static_cast<int>(settings.kernel), static_cast<double>(settings.supportRadius),
                  static_cast<double>(settings.cell), settings.curvedOnly ? 1 : 0, settings.region.min.x(),
                  settings.region.min.y(), settings.region.min.z(), settings.region.max.x(),
                  settings.region.max.y(), settings.region.max.z());
    return text + describeWalls(exact_);
  }

  const Boundary& boundary_;
  Boundary exact_;  ///< the same walls without grids of distances: what the grid of gamma is made from
  float support_;
  std::unique_ptr<GammaMethod> elsewhere_;
  std::unique_ptr<ThreadPool> ownPool_;
  ThreadPool& pool_;
  BakeSettings settings_{};
  GammaGrid grid_;
  std::string reason_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeBakedGamma(const GammaContext& context) {
  if (context.boundary.moves()) return makeMovingGamma(context, makeBakedGamma);
  auto method = std::make_unique<BakedGamma>(context);
  method->fill();
  return method;
}

std::unique_ptr<GridGamma> makeBakedGammaIfQuick(const GammaContext& context) {
  auto method = std::make_unique<BakedGamma>(context, true, kQuickBlocks);
  if (!method->laidOut() || method->used() == 0 || method->used() > kQuickUsed) return nullptr;
  method->fill();
  return method;
}

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
  if (CacheBypass::active()) return std::nullopt;
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
