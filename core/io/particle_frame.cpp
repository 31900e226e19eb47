#include "core/io/particle_frame.h"

#include <algorithm>
#include <numeric>

namespace migiwa {

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

ParticleFrame copyParticles(const FrameView& view, long frame, std::span<const std::string> fields) {
  ParticleFrame copy;
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
