// Wall time of named stages, in the order in which they first ran. A stage that never ran has no entry.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

struct StageTime {
  std::string name;
  double seconds = 0;
};

class StageTimes {
 public:
  void add(std::string_view name, double seconds) {
    for (StageTime& stage : stages_) {
      if (stage.name == name) {
        stage.seconds += seconds;
        return;
      }
    }
    stages_.push_back({std::string(name), seconds});
  }
  void add(const StageTimes& other) {
    for (const StageTime& stage : other.stages_) add(stage.name, stage.seconds);
  }
  double seconds(std::string_view name) const {
    for (const StageTime& stage : stages_)
      if (stage.name == name) return stage.seconds;
    return 0;
  }
  const std::vector<StageTime>& stages() const { return stages_; }
  void clear() { stages_.clear(); }

  /// Runs `body` and books its wall time under `name`.
  template <class Body>
  void time(std::string_view name, const Body& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

 private:
  std::vector<StageTime> stages_;
};

}  // namespace migiwa
