#include "core/simulation/state.h"

#include <array>
#include <utility>

#include "core/simulation/simulation.h"

namespace migiwa {

class StateImage::Writer final : public StateVisitor {
 public:
  explicit Writer(StateImage& image) : image_(image) {}

  bool reading() const override { return false; }
  void number(std::string_view name, double& value) override { image_.numbers_[std::string(name)] = value; }
  void integer(std::string_view name, std::int64_t& value) override {
    image_.integers_[std::string(name)] = value;
  }
  void text(std::string_view name, std::string& value) override { image_.texts_[std::string(name)] = value; }

 protected:
  void store(std::string_view name, std::size_t, std::span<const std::byte> bytes) override {
    image_.arrays_[std::string(name)].assign(bytes.begin(), bytes.end());
  }
  std::span<const std::byte> load(std::string_view, std::size_t) override { return {}; }

 private:
  StateImage& image_;
};

class StateImage::Reader final : public StateVisitor {
 public:
  explicit Reader(const StateImage& image) : image_(image) {}

  bool reading() const override { return true; }
  void number(std::string_view name, double& value) override { value = find(image_.numbers_, name); }
  void integer(std::string_view name, std::int64_t& value) override { value = find(image_.integers_, name); }
  void text(std::string_view name, std::string& value) override { value = find(image_.texts_, name); }

 protected:
  void store(std::string_view, std::size_t, std::span<const std::byte>) override {}
  std::span<const std::byte> load(std::string_view name, std::size_t) override {
    return find(image_.arrays_, name);
  }

 private:
  template <class Map>
  static const typename Map::mapped_type& find(const Map& map, std::string_view name) {
    const auto found = map.find(name);
    if (found == map.end()) throw StateError("\"" + std::string(name) + "\", found another scene's state");
    return found->second;
  }

  const StateImage& image_;
};

StateImage StateImage::of(Simulation& simulation) {
  StateImage image;
  Writer writer(image);
  simulation.visitState(writer);
  return image;
}

std::size_t StateImage::bytes() const {
  std::size_t sum = 0;
  for (const auto& [name, array] : arrays_) sum += array.size();
  return sum;
}

void StateImage::restore(Simulation& simulation) const {
  Reader reader(*this);
  simulation.visitState(reader);
}

namespace {

using Triple = std::array<float, 3>;

Triple tripleOf(const Vec3f& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3f vectorOf(const Triple& t) {
  return {t[0], t[1], t[2]};
}

/// A WallSlot without padding.
struct SavedSlot {
  std::uint32_t particle;
  Triple at;
  float gamma, distance;
  Triple gradient, pairGradient;
};
static_assert(sizeof(SavedSlot) == 48);
static_assert(sizeof(GammaSample) == 32, "a member more belongs into SavedSlot, too");

std::vector<Triple> packed(const std::vector<Float4>& vectors) {
  std::vector<Triple> triples;
  triples.reserve(vectors.size());
  for (const Float4& v : vectors) triples.push_back({v.x, v.y, v.z});
  return triples;
}

std::vector<Float4> unpacked(const std::vector<Triple>& triples) {
  std::vector<Float4> vectors;
  vectors.reserve(triples.size());
  for (const Triple& t : triples) vectors.emplace_back(t[0], t[1], t[2]);
  return vectors;
}

std::vector<SavedSlot> savedSlots(const StepState& state) {
  std::vector<SavedSlot> saved;
  saved.reserve(state.wallSlots.size());
  for (const WallSlot& slot : state.wallSlots) {
    const GammaSample& sample = slot.sample;
    saved.push_back({slot.particle, tripleOf(slot.at.xyz()), sample.gamma, sample.distance,
                     tripleOf(sample.gradient), tripleOf(sample.pairGradient)});
  }
  return saved;
}

void restoreSlots(StepState& state, const std::vector<SavedSlot>& saved) {
  state.wallSlots.clear();
  state.wallSlots.reserve(saved.size());
  state.wallSlot.assign(state.particles.size(), FluidState::kNoWall);
  for (const SavedSlot& slot : saved) {
    state.wallSlot[slot.particle] = static_cast<std::uint32_t>(state.wallSlots.size());
    const GammaSample sample{slot.gamma, slot.distance, vectorOf(slot.gradient), vectorOf(slot.pairGradient)};
    state.wallSlots.push_back({slot.particle, Float4(vectorOf(slot.at)), sample});
  }
}

}  // namespace

void visitStepMemory(StateVisitor& visitor, StepState& state, std::vector<std::uint32_t>& neighbours) {
  std::vector<Triple> position, velocity;
  std::vector<SavedSlot> slots;
  Particles read;
  std::vector<float> density, gamma, lambda, pressure;
  std::vector<IterationError> errors;
  const bool reading = visitor.reading();
  if (!reading) {
    position = packed(state.particles.position), velocity = packed(state.particles.velocity);
    slots = savedSlots(state);
  }
  visitor.array("particles/id", reading ? read.id : state.particles.id);
  visitor.array("particles/position", position);
  visitor.array("particles/velocity", velocity);
  visitor.array("particles/pressure", reading ? pressure : state.projectedPressure);
  visitor.array("walls/slots", slots);
  visitor.array("fields/density", reading ? density : state.density);
  visitor.array("fields/gamma", reading ? gamma : state.gamma);
  visitor.array("fields/lambda", reading ? lambda : state.lambda);
  visitor.array("fields/neighbours", neighbours);
  visitor.array("fields/errors", reading ? errors : state.errors);
  if (!reading) return;

  const std::size_t n = read.id.size();
  for (const std::size_t size :
       {position.size(), velocity.size(), density.size(), gamma.size(), lambda.size(), neighbours.size()}) {
    if (size != n)
      throw StateError("the same number of particles in every array, found " + std::to_string(n) + " and " +
                       std::to_string(size));
  }
  if (!pressure.empty() && pressure.size() != n)
    throw StateError("a pressure for each of " + std::to_string(n) + " particles, found " +
                     std::to_string(pressure.size()));
  for (const SavedSlot& slot : slots) {
    if (slot.particle >= n)
      throw StateError("wall slots of " + std::to_string(n) + " particles, found one of particle " +
                       std::to_string(slot.particle));
  }
  read.position = unpacked(position);
  read.velocity = unpacked(velocity);
  state.particles = std::move(read);
  state.density = std::move(density), state.gamma = std::move(gamma), state.lambda = std::move(lambda);
  state.projectedPressure = std::move(pressure);
  state.errors = std::move(errors);
  restoreSlots(state, slots);
}

}  // namespace migiwa
