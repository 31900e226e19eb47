// The state of a simulation for saves and copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/solver/state.h"

namespace migiwa {

// All that a save holds, in memory: to go on from one moment again and again, in other simulations of the
// same scene, with other settings.

class Simulation;

class StateImage {
 public:
  /// Takes the state as it is between two frames.
  static StateImage of(Simulation& simulation);

  bool empty() const { return arrays_.empty(); }
  /// Memory of its arrays; the rest is little beside it.
  std::size_t bytes() const;
  /// Puts a simulation of the same scene into this state; its settings stay. Throws StateError where the
  /// scene is another one; the simulation is then of no further use.
  void restore(Simulation& simulation) const;

 private:
  class Writer;
  class Reader;

  std::map<std::string, double, std::less<>> numbers_;
  std::map<std::string, std::int64_t, std::less<>> integers_;
  std::map<std::string, std::string, std::less<>> texts_;
  std::map<std::string, std::vector<std::byte>, std::less<>> arrays_;
};

// How a simulation names what a save has to hold. Each part visits its members once; writing a save and
// reading it back are visitors of that one list (core/io/save_file.h). What holds a state of its own beyond
// the particles adds a line for each member to its visit: names that only one side knows are refused.

/// What is read does not fit the simulation that reads it. The message goes on after "expected ".
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class StateVisitor {
 public:
  virtual ~StateVisitor() = default;

  /// Whether members are overwritten with what was saved.
  virtual bool reading() const = 0;

  // Single values. Names are JSON pointers, such as "/statistics/steps".
  virtual void number(std::string_view name, double& value) = 0;
  virtual void integer(std::string_view name, std::int64_t& value) = 0;
  virtual void text(std::string_view name, std::string& value) = 0;
  void integer(std::string_view name, int& value) {
    std::int64_t wide = value;
    integer(name, wide);
    value = static_cast<int>(wide);
  }
  void number(std::string_view name, float& value) {
    auto wide = static_cast<double>(value);
    number(name, wide);
    value = static_cast<float>(wide);
  }

  /// Values by the thousand, kept bit by bit, such as "particles/id". No element may have padding.
  template <class T>
  void array(std::string_view name, std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!reading()) return store(name, sizeof(T), std::as_bytes(std::span(values)));
    const std::span<const std::byte> bytes = load(name, sizeof(T));
    values.resize(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  }

 protected:
  virtual void store(std::string_view name, std::size_t elementBytes, std::span<const std::byte> bytes) = 0;
  /// Throws StateError when there is no such array or its elements have another size.
  virtual std::span<const std::byte> load(std::string_view name, std::size_t elementBytes) = 0;
};

// What of the solver's state lasts from step to step, visited for a save.

/// Particles in their order, the points at which gamma was last evaluated, and the fields of the last step
/// that pictures show. `neighbours`: counts of the last step. Reading throws StateError, before it changes
/// anything, when what was saved contradicts itself.
void visitStepMemory(StateVisitor& visitor, StepState& state, std::vector<std::uint32_t>& neighbours);

}  // namespace migiwa
