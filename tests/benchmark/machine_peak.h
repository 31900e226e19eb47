// What this machine can do at most, for the shares that the benchmark reports.
#pragma once

#include <cstddef>

#include "core/base/parallel.h"

namespace migiwa::benchmarks {

/// One round of a[i] = b[i] + s c[i] over arrays too large for the caches (McCalpin's triad); bytes moved.
std::size_t triad(ThreadPool& pool);
/// Multiply-adds that do not wait for each other, on every thread; floating-point operations done.
double multiplyAdds(ThreadPool& pool);

}  // namespace migiwa::benchmarks
