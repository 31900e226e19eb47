// The same work on every instruction set that this processor has.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace migiwa::testing {

/// Whether state is promised to be the same to the last bit as on every other such processor: AVX2 and what
/// came after it, which Highway numbers downwards.
constexpr bool promisesEqualState(std::int64_t target) {
  return target <= HWY_AVX2;
}

/// Runs a check once for each instruction set for which `wanted`, and sets the processor's own again.
template <class Wanted, class Check>
void onTargets(const Wanted& wanted, const Check& check) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (!wanted(target)) continue;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

template <class Check>
void onEveryTarget(const Check& check) {
  onTargets([](std::int64_t) { return true; }, check);
}

}  // namespace migiwa::testing
