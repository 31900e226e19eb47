// Which frames of a run a sequence has: those nearest to 0, S, 2 S, ... seconds.
#pragma once

namespace migiwa {

class ExportSchedule {
 public:
  /// `every` and `timeStep` in s, both positive.
  ExportSchedule(double every, double timeStep) : stride_(every / timeStep) {}

  bool due(long frame) const;
  /// How many frames before this one are due: the number of its file.
  long countBefore(long frame) const;

 private:
  double stride_;  ///< frames, not necessarily whole
};

}  // namespace migiwa
