#include "core/base/parallel.h"

#include <algorithm>
#include <exception>
#include <system_error>

#include <pthread.h>

#include "core/base/files.h"
#include "core/base/progress.h"

namespace migiwa {

namespace {

/// Some seventy microseconds: longer than most serial parts of a step. To be woken takes some twenty.
constexpr int kLooksBeforeSleep = 2000;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

/// Whether the condition came true within a short wait that stays awake.
template <class Condition>
bool soon(const Condition& condition) {
  for (int look = 0; look < kLooksBeforeSleep; ++look) {
    if (condition()) return true;
    pause();
  }
  return false;
}

std::uint32_t regionOf(std::uint64_t tickets) {
  return static_cast<std::uint32_t>(tickets >> 32);
}
std::uint32_t leftOf(std::uint64_t tickets) {
  return static_cast<std::uint32_t>(tickets);
}

/// So many that their stacks leave half of the memory, or of the addresses that the process may have, to the
/// rest.
double threadsThatFit() {
  pthread_attr_t attributes;
  std::size_t stack = 0;
  if (pthread_attr_init(&attributes) == 0) {
    pthread_attr_getstacksize(&attributes, &stack);
    pthread_attr_destroy(&attributes);
  }
  constexpr double kMost = 1e6;
  return stack > 0 ? std::min(0.5 * availableMemory() / static_cast<double>(stack), kMost) : kMost;
}

/// Of the region that this thread has called for.
thread_local std::size_t calledChunks = 0;

/// Says how far that region is when `left` of its chunks are not begun.
void tellProgress(std::size_t left) {
  if (Activity::watched() && calledChunks > 0)
    Activity::pulse(1 - static_cast<double>(left) / static_cast<double>(calledChunks));
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  threads = std::clamp(threads, 1, std::clamp(static_cast<int>(threadsThatFit()), 1, 256));
  try {
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // The system gives no more of them: what there are do, and the result is the same.
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::takeChunks(std::uint32_t region) {
  std::uint64_t tickets = tickets_.load();
  while (regionOf(tickets) == region && leftOf(tickets) > 0) {
    if (!tickets_.compare_exchange_weak(tickets, tickets - 1)) continue;
    // This chunk is pending until it is done, so the task of its region stays where it is.
    try {
      (*task_)(leftOf(tickets) - 1);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    tellProgress(leftOf(tickets) - 1);
    if (--pending_ == 0 && callerSleeps_) {
      const std::lock_guard lock(mutex_);
      done_.notify_one();
    }
    tickets = tickets_.load();
  }
}

void ThreadPool::work() {
  std::uint32_t seen = 0;
  const auto called = [&] { return stop_ || regionOf(tickets_) != seen; };
  while (true) {
    if (!soon(called)) {
      std::unique_lock lock(mutex_);
      ++sleepers_;
      wake_.wait(lock, called);
      --sleepers_;
    }
    if (stop_) return;
    seen = regionOf(tickets_);
    takeChunks(seen);
  }
}

void ThreadPool::run(std::size_t chunks, const std::function<void(std::size_t)>& task) {
  calledChunks = chunks;
  if (workers_.empty() || chunks <= 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      task(chunk);
      tellProgress(chunks - chunk - 1);
    }
    return;
  }
  task_ = &task;
  failure_ = nullptr;
  pending_ = chunks;
  const std::uint32_t region = regionOf(tickets_) + 1;
  tickets_ = (static_cast<std::uint64_t>(region) << 32) | chunks;
  if (sleepers_ > 0) {
    const std::lock_guard lock(mutex_);
    wake_.notify_all();
  }
  takeChunks(region);
  const auto finished = [this] { return pending_ == 0; };
  if (!soon(finished)) {
    std::unique_lock lock(mutex_);
    callerSleeps_ = true;
    done_.wait(lock, finished);
    callerSleeps_ = false;
  }
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace migiwa
