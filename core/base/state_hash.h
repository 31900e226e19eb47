// A hash of what a simulation's future depends on. It sums over particles, so neither their order nor the
// number of threads matters; one changed bit changes it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/parallel.h"
#include "core/base/types.h"

namespace migiwa {

std::uint64_t stateHash(std::span<const std::uint32_t> ids, std::span<const Float4> positions,
                        std::span<const Float4> velocities, ThreadPool& pool);

/// A hash as people read it: 16 hexadecimal digits.
std::string hexDigits(std::uint64_t hash);

}  // namespace migiwa
