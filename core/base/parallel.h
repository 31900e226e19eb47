// Parallel loops over fixed chunks. The chunks do not depend on the number of threads and every chunk is
// worked on by one thread, so a result put together from per-chunk results in chunk order is the same for any
// number of threads. Waiting threads look for work for some microseconds, as long as the next region of a
// step takes to come, and then sleep: on a busy machine a pool that spins loses a scheduler slice in every
// region. Written with standard primitives only, so that the thread sanitizer sees all of it.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace migiwa {

class ThreadPool {
 public:
  /// `threads` in [1, 256], the caller of run() included; 0 takes what the machine has.
  explicit ThreadPool(int threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(chunk) once for every chunk in [0, chunks) and returns when all are done.
  /// The first exception of a task is thrown again here. Not re-entrant.
  void run(std::size_t chunks, const std::function<void(std::size_t)>& task);

 private:
  void work();
  void takeChunks(std::uint32_t region);

  std::vector<std::thread> workers_;
  /// The number of the region in the upper half, how many of its chunks nobody has taken in the lower: one
  /// word, so that a thread that comes late can never take a chunk of another region.
  std::atomic<std::uint64_t> tickets_ = 0;
  std::atomic<std::size_t> pending_ = 0;
  std::atomic<int> sleepers_ = 0;
  std::atomic<bool> callerSleeps_ = false;
  std::atomic<bool> stop_ = false;
  const std::function<void(std::size_t)>* task_ = nullptr;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  std::exception_ptr failure_;
};

/// Particles a chunk: small enough to balance, large enough that taking one costs nothing.
inline constexpr std::size_t kChunk = 512;

inline std::size_t chunkCount(std::size_t n) {
  return (n + kChunk - 1) / kChunk;
}

/// Calls body(begin, end, chunk) for every chunk of [0, n).
template <class Body>
void parallelFor(ThreadPool& pool, std::size_t n, const Body& body) {
  pool.run(chunkCount(n), [&](std::size_t chunk) {
    const std::size_t begin = chunk * kChunk;
    body(begin, begin + kChunk < n ? begin + kChunk : n, chunk);
  });
}

/// Folds per-chunk results in chunk order: value = body(begin, end), total = fold(total, value).
template <class T, class Body, class Fold>
T parallelReduce(ThreadPool& pool, std::size_t n, T initial, const Body& body, const Fold& fold) {
  std::vector<T> parts(chunkCount(n), initial);
  parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    parts[chunk] = body(begin, end);
  });
  T total = initial;
  for (const T& part : parts) total = fold(total, part);
  return total;
}

/// body(i) for i < n.
template <class Body>
void parallelEach(ThreadPool& pool, std::size_t n, const Body& body) {
  parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// The sum of term(i) over i < n, in one order whatever the number of threads.
template <class Term>
double parallelSum(ThreadPool& pool, std::size_t n, const Term& term) {
  return parallelReduce(
      pool, n, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += term(i);
        return sum;
      },
      [](double a, double b) { return a + b; });
}

// Wall time of named stages, in the order in which they first ran. A stage that never ran has no entry.

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
