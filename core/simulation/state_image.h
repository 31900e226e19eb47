// All that a save holds, in memory: to go on from one moment again and again, in other simulations of the
// same scene, with other settings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace migiwa {

class Simulation;

class StateImage {
 public:
  /// Takes the state as it is between two frames.
  static StateImage of(Simulation& simulation);

  bool empty() const { return arrays_.empty(); }
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

}  // namespace migiwa
