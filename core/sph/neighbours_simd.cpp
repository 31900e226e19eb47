// The lists, several candidates at a time: squared distances of a run of particles that are neighbours in
// memory, and those within the radius stored without gaps.
#include <algorithm>
#include <array>
#include <limits>

#include "core/sph/neighbours.h"

#ifndef MIGIWA_SORTED_COORDINATES
#define MIGIWA_SORTED_COORDINATES
namespace migiwa {

/// The particles' coordinates by themselves, so that vectors of candidates load without a transpose; a group
/// beyond the last particle may be read.
struct SortedCoordinates {
  const float *x, *y, *z;
  std::uint32_t ghost;  ///< offset of the particle that fills up the lists
};

/// For each set of eight lanes, which lane comes k-th when those of the set come first, in bits 4k.
inline constexpr auto kLanesOfSet = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t set = 0; set < table.size(); ++set) {
    std::uint32_t place = 0;
    for (const bool listed : {true, false})
      for (std::uint32_t lane = 0; lane < 8; ++lane)
        if (((set >> lane & 1U) != 0) == listed) table[set] |= lane << (4 * place++);
  }
  return table;
}();

/// The particles of the cells around one cell, one after the other, with their offsets.
struct Candidates {
  float *x, *y, *z;
  std::uint32_t* offset;
};

}  // namespace migiwa
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/sph/neighbours_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Group = hn::CappedTag<float, NeighbourLists::kGroup>;

/// Gathers the particles of nine rows of cells. What fills up the last vector is out of everyone's reach.
HWY_INLINE std::size_t gatherCandidates(const SortedCoordinates& sorted, const CellGrid::Places* rows,
                                        const Candidates& candidates) {
  const Group d;
  const hn::RebindToUnsigned<Group> du;
  const auto lanes = hn::Iota(du, 0);
  std::size_t count = 0;
  for (int row = 0; row < 9; ++row) {
    for (std::uint32_t k = 0; k < rows[row].to - rows[row].from;
         k += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const std::uint32_t from = rows[row].from + k;
      hn::StoreU(hn::LoadU(d, sorted.x + from), d, candidates.x + count + k);
      hn::StoreU(hn::LoadU(d, sorted.y + from), d, candidates.y + count + k);
      hn::StoreU(hn::LoadU(d, sorted.z + from), d, candidates.z + count + k);
      hn::StoreU(hn::ShiftLeft<4>(hn::Add(lanes, hn::Set(du, from))), du, candidates.offset + count + k);
    }
    count += rows[row].to - rows[row].from;
  }
  hn::StoreU(hn::Set(d, std::numeric_limits<float>::infinity()), d, candidates.x + count);
  return count;
}

using Offsets = hn::RebindToUnsigned<Group>;

/// Stores those of the offsets that are listed, without gaps, and beyond them anything. Returns their number.
HWY_INLINE std::size_t storeListed(hn::Vec<Offsets> offsets, hn::Mask<Offsets> listed, std::uint32_t* out) {
  const Offsets d;
#if HWY_TARGET == HWY_AVX2
  // Highway's own has its table on the stack, where GCC copies it for every vector: four fifths of a search.
  alignas(32) static constexpr std::uint32_t kShifts[] = {0, 4, 8, 12, 16, 20, 24, 28};
  std::uint8_t bits[8];
  hn::StoreMaskBits(d, listed, bits);
  const auto lanes = hn::Shr(hn::Set(d, kLanesOfSet[bits[0]]), hn::Load(d, kShifts));
  const auto first = hn::IndicesFromVec(d, hn::And(lanes, hn::Set(d, 7U)));
  hn::StoreU(hn::TableLookupLanes(offsets, first), d, out);
  return hwy::PopCount(bits[0]);
#else
  hn::StoreU(hn::Compress(offsets, listed), d, out);
  return hn::CountTrue(d, listed);
#endif
}

/// Appends to `out` the offsets of the candidates within the radius of the particle, the particle's own left
/// out. Writes up to one vector beyond the end. Returns the new end.
HWY_INLINE std::uint32_t* appendNeighbours(const Candidates& candidates, std::size_t count, const Float4& p,
                                           float radius2, std::uint32_t ownOffset,
                                           std::uint32_t* HWY_RESTRICT out) {
  const Group d;
  const hn::RebindToUnsigned<Group> du;
  const auto px = hn::Set(d, p.x), py = hn::Set(d, p.y), pz = hn::Set(d, p.z);
  const auto reach = hn::Set(d, radius2);
  const auto own = hn::Set(du, ownOffset);
  const float *const x = candidates.x, *const y = candidates.y, *const z = candidates.z;
  const std::uint32_t* const offsets = candidates.offset;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const auto dx = hn::Sub(px, hn::LoadU(d, x + k));
    const auto dy = hn::Sub(py, hn::LoadU(d, y + k));
    const auto dz = hn::Sub(pz, hn::LoadU(d, z + k));
    const auto squared = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const auto offset = hn::LoadU(du, offsets + k);
    const auto near = hn::RebindMask(du, hn::Lt(squared, reach));
    const auto listed = hn::AndNot(hn::Eq(offset, own), near);
    out += storeListed(offset, listed, out);
  }
  return out;
}

/// Appends the lists of the particles [begin, end) of one cell to `lists`, which has room for all of their
/// candidates and is `used` so far; start and count are those of the first of them.
void listCell(const SortedCoordinates& sorted, const CellGrid::Places* rows, float radius2,
              std::uint32_t begin, std::uint32_t end, const Candidates& candidates, std::uint32_t* lists,
              std::size_t& used, std::uint32_t* start, std::uint32_t* count) {
  const std::size_t candidateCount = gatherCandidates(sorted, rows, candidates);
  for (std::uint32_t i = begin; i < end; ++i) {
    const Float4 p(sorted.x[i], sorted.y[i], sorted.z[i]);
    std::uint32_t* const list = lists + used;
    std::uint32_t* const listEnd = appendNeighbours(candidates, candidateCount, p, radius2, i << 4U, list);
    for (std::size_t k = 0; k < NeighbourLists::kGroup; ++k) listEnd[k] = sorted.ghost;
    const auto found = static_cast<std::uint32_t>(listEnd - list);
    start[i - begin] = static_cast<std::uint32_t>(used);
    count[i - begin] = found;
    used += NeighbourLists::wholeGroups(found);
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(listCell);

static_assert(sizeof(Float4) == 16, "offsets are indices shifted by four bits");

void NeighbourLists::Chunk::assign(std::span<const std::uint32_t> lists) {
  if (lists.size() > capacity) {
    // A little more, for the next step's lists are about as long.
    capacity = lists.size() + lists.size() / 16;
    offsets = std::make_unique_for_overwrite<std::uint32_t[]>(capacity);
  }
  std::copy(lists.begin(), lists.end(), offsets.get());
}

void NeighbourLists::Chunk::makeValues() {
  // A chunk without any pair has a place for them, too.
  if (values != nullptr && valueCapacity >= capacity) return;
  values = std::make_unique_for_overwrite<ValueGroup[]>(capacity / kGroup + 1);
  valueCapacity = capacity;
}

namespace {

/// Buffers that a thread fills the lists of a chunk in: candidates by far outnumber neighbours, and only the
/// neighbours are kept.
struct ListBuffers {
  std::vector<float> coordinates;
  std::vector<std::uint32_t> offsets, lists;

  Candidates candidates(std::size_t count) {
    if (offsets.size() < count) coordinates.resize(3 * count), offsets.resize(count);
    return {&coordinates[0], &coordinates[count], &coordinates[2 * count], offsets.data()};
  }
};

}  // namespace

void NeighbourLists::build(const CellGrid& grid, std::span<const Float4> positions, float radius,
                           ThreadPool& pool) {
  std::vector<Float4> scratch(positions.size() + kScratchExtra);
  build(grid, positions, radius, scratch, pool);
}

void NeighbourLists::build(const CellGrid& grid, std::span<const Float4> positions, float radius,
                           std::span<Float4> scratch, ThreadPool& pool) {
  const std::size_t n = positions.size();
  chunks_.resize(chunkCount(n));
  start_.resize(n);
  count_.resize(n);
  const Vec3f outside = grid.origin() - Vec3f::Constant(1e6F * radius);
  ghost_ = Float4(outside);

  // Loads may run past the last particle by less than a group.
  const std::size_t stride = n + kGroup;
  float *x = &scratch.front().x, *y = x + stride, *z = y + stride;
  parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      x[i] = positions[i].x, y[i] = positions[i].y, z[i] = positions[i].z;
  });
  for (std::size_t i = n; i < stride; ++i) x[i] = y[i] = z[i] = 0;

  const SortedCoordinates sorted{x, y, z, static_cast<std::uint32_t>(n * sizeof(Float4))};
  parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t number) {
    thread_local ListBuffers buffers;
    std::size_t used = 0;
    const auto last = static_cast<std::uint32_t>(end);
    for (auto i = static_cast<std::uint32_t>(begin); i < last;) {
      // The particles of a cell share its rows of candidates.
      const CellGrid::Cell cell = grid.cellOf(positions[i]);
      CellGrid::Places rows[9];
      std::size_t candidates = 0;
      for (int row = 0; row < 9; ++row) {
        rows[row] = grid.row(cell.x - 1, cell.x + 1, cell.y + row % 3 - 1, cell.z + row / 3 - 1);
        candidates += rows[row].to - rows[row].from;
      }
      const std::uint32_t cellEnd = std::min(last, grid.places(cell).to);
      const std::size_t needed = used + (cellEnd - i) * (candidates + 2 * kGroup);
      if (buffers.lists.size() < needed) buffers.lists.resize(needed);
      HWY_DYNAMIC_DISPATCH(listCell)
      (sorted, rows, radius * radius, i, cellEnd, buffers.candidates(candidates + kGroup),
       buffers.lists.data(), used, &start_[i], &count_[i]);
      i = cellEnd;
    }
    chunks_[number].assign(std::span(buffers.lists).first(used));
  });
}

std::size_t NeighbourLists::bytes() const {
  std::size_t total = (start_.capacity() + count_.capacity()) * sizeof(std::uint32_t);
  for (const Chunk& chunk : chunks_)
    total += chunk.capacity * sizeof(std::uint32_t) + chunk.valueCapacity * sizeof(float);
  return total;
}

}  // namespace migiwa
#endif  // HWY_ONCE
