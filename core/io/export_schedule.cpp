#include "core/io/export_schedule.h"

#include <cmath>

namespace migiwa {

namespace {

/// Sums of steps are off round times by what a double cannot hold: halfway is rounded up all the same.
constexpr double kTie = 1e-9;

/// The frame on which the k-th time falls.
double frameOf(long k, double stride) {
  return std::floor(static_cast<double>(k) * stride + 0.5 + kTie);
}

}  // namespace

bool ExportSchedule::due(long frame) const {
  return countBefore(frame + 1) > countBefore(frame);
}

long ExportSchedule::countBefore(long frame) const {
  if (frame <= 0) return 0;
  if (stride_ <= 1) return frame;
  // The first k whose frame is not before this one, found near where it would be without rounding.
  long k = std::lround(std::max(std::floor(static_cast<double>(frame) / stride_) - 1, 0.0));
  while (frameOf(k, stride_) < static_cast<double>(frame)) ++k;
  return k;
}

}  // namespace migiwa
