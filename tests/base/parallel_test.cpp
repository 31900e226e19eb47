// The promises of core/base/parallel.h: every chunk once, and results that do not depend on the number of
// threads.
#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace migiwa {
namespace parallel_test {

class Parallel : public ::testing::TestWithParam<int> {
 protected:
  ThreadPool pool{GetParam()};
};

TEST_P(Parallel, PoolHasTheThreadsItWasAskedFor) {
  EXPECT_EQ(pool.threads(), GetParam());
}

TEST_P(Parallel, EveryChunkRunsExactlyOnce) {
  for (const std::size_t chunks :
       {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{1000}}) {
    std::vector<std::atomic<int>> visits(chunks);
    pool.run(chunks, [&](std::size_t chunk) { ++visits.at(chunk); });
    for (std::size_t i = 0; i < chunks; ++i) EXPECT_EQ(visits[i], 1) << "chunk " << i << " of " << chunks;
  }
}

TEST_P(Parallel, ForCoversTheRangeWithFixedChunks) {
  for (const std::size_t n :
       {std::size_t{0}, std::size_t{1}, kChunk - 1, kChunk, kChunk + 1, 5 * kChunk + 3}) {
    std::vector<int> visits(n, 0);
    std::vector<int> chunkOf(n, -1);
    parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      EXPECT_LT(begin, end);
      for (std::size_t i = begin; i < end; ++i) ++visits.at(i), chunkOf[i] = static_cast<int>(chunk);
    });
    EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](int v) { return v == 1; })) << n;
    for (std::size_t i = 0; i < n; ++i)
      ASSERT_EQ(chunkOf[i], static_cast<int>(i / kChunk)) << i << " of " << n;
  }
}

TEST_P(Parallel, WhatAChunkWroteIsSeenAfterTheLoop) {
  // Plain memory on purpose: under the thread sanitizer this proves that run() orders the writes before its
  // return.
  constexpr std::size_t n = 20 * kChunk;
  std::vector<std::size_t> values(n, 0);
  for (std::size_t round = 1; round <= 20; ++round) {
    parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) values[i] += i;
    });
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), std::size_t{0}), round * n * (n - 1) / 2);
  }
}

// Terms whose sum depends on the order of adding them: magnitudes over twelve decades, both signs.
std::vector<double> awkwardTerms(std::size_t n) {
  std::vector<double> terms(n);
  std::uint64_t state = 88172645463325252u;
  for (double& term : terms) {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    const double unit = static_cast<double>(state >> 11) * 0x1p-53;
    term = (2 * unit - 1) * std::pow(10.0, static_cast<double>(state % 13) - 6);
  }
  return terms;
}

double chunkSum(const std::vector<double>& terms, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += terms[i];
  return sum;
}

TEST_P(Parallel, SumIsTheSameToTheLastBitForAnyNumberOfThreads) {
  const std::vector<double> terms = awkwardTerms(100 * kChunk + 17);
  // The definition, written without threads: chunk sums, added in chunk order.
  double expected = 0;
  for (std::size_t begin = 0; begin < terms.size(); begin += kChunk)
    expected += chunkSum(terms, begin, std::min(begin + kChunk, terms.size()));
  const double plain = std::accumulate(terms.begin(), terms.end(), 0.0);
  ASSERT_NE(plain, expected) << "the terms do not tell orders of adding apart";

  for (int repeat = 0; repeat < 20; ++repeat) {
    const double sum = parallelReduce(
        pool, terms.size(), 0.0,
        [&](std::size_t begin, std::size_t end) { return chunkSum(terms, begin, end); },
        [](double a, double b) { return a + b; });
    EXPECT_EQ(std::bit_cast<std::uint64_t>(sum), std::bit_cast<std::uint64_t>(expected))
        << sum << " against " << expected;
  }
}

TEST_P(Parallel, ReduceFoldsInChunkOrder) {
  const std::string order = parallelReduce(
      pool, 6 * kChunk + 1, std::string(),
      [](std::size_t begin, std::size_t) { return std::to_string(begin / kChunk); },
      [](const std::string& a, const std::string& b) { return a + b; });
  EXPECT_EQ(order, "0123456");
}

TEST_P(Parallel, ReduceOfNothingIsTheInitialValue) {
  const int result = parallelReduce(
      pool, 0, 42, [](std::size_t, std::size_t) { return 1; }, [](int a, int b) { return a + b; });
  EXPECT_EQ(result, 42);
}

TEST_P(Parallel, AnExceptionReachesTheCallerAndThePoolStaysUsable) {
  for (const std::size_t culprit : {std::size_t{0}, std::size_t{13}, std::size_t{99}}) {
    EXPECT_THROW(pool.run(100,
                          [&](std::size_t chunk) {
                            if (chunk == culprit) throw std::domain_error("chunk fails");
                          }),
                 std::domain_error);
    std::atomic<int> visits = 0;
    pool.run(100, [&](std::size_t) { ++visits; });
    EXPECT_EQ(visits, 100);
  }
}

TEST_P(Parallel, OneOfManyExceptionsReachesTheCaller) {
  EXPECT_THROW(pool.run(64, [](std::size_t chunk) { throw std::out_of_range(std::to_string(chunk)); }),
               std::out_of_range);
}

TEST_P(Parallel, ManyShortRunsInARow) {
  // A lost wake-up or a chunk taken from the run before would hang or miscount sooner or later.
  std::size_t total = 0;
  for (std::size_t round = 0; round < 3000; ++round) {
    std::atomic<std::size_t> visits = 0;
    const std::size_t chunks = round % 9;
    pool.run(chunks, [&](std::size_t) { visits.fetch_add(1, std::memory_order_relaxed); });
    ASSERT_EQ(visits, chunks) << "round " << round;
    total += visits;
  }
  EXPECT_EQ(total, 3000u / 9 * 36 + 0 + 1 + 2);
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, ::testing::Values(1, 2, 3, 8, 64),
                         ::testing::PrintToStringParamName());

TEST(ThreadPool, ZeroTakesWhatTheMachineHas) {
  const ThreadPool pool(0);
  EXPECT_EQ(pool.threads(), static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
}

TEST(ThreadPool, ManyPoolsComeAndGo) {
  for (int i = 0; i < 200; ++i) {
    ThreadPool pool(4);
    std::atomic<int> visits = 0;
    if (i % 2 == 0) pool.run(8, [&](std::size_t) { ++visits; });
    EXPECT_EQ(visits, i % 2 == 0 ? 8 : 0);
  }
}

TEST(ThreadPool, SeveralThreadsWorkAtTheSameTime) {
  // Two chunks that wait for each other can only end on two threads.
  ThreadPool pool(2);
  std::atomic<int> arrived = 0;
  pool.run(2, [&](std::size_t) {
    ++arrived;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (arrived < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    EXPECT_EQ(arrived, 2);
  });
}

}  // namespace parallel_test
}  // namespace migiwa
