#include "core/base/parallel.h"

#include <algorithm>
#include <exception>

namespace migiwa {

ThreadPool::ThreadPool(int threads) {
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  threads = std::min(threads, 256);
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::takeChunks(std::unique_lock<std::mutex>& lock) {
  while (next_ < chunks_) {
    const std::size_t chunk = next_++;
    const auto* task = task_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      (*task)(chunk);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && !failure_) failure_ = failure;
    if (--pending_ == 0) done_.notify_all();
  }
}

void ThreadPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || next_ < chunks_; });
    if (stop_) return;
    takeChunks(lock);
  }
}

void ThreadPool::run(std::size_t chunks, const std::function<void(std::size_t)>& task) {
  if (workers_.empty() || chunks <= 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) task(chunk);
    return;
  }
  std::unique_lock lock(mutex_);
  task_ = &task;
  next_ = 0;
  chunks_ = pending_ = chunks;
  failure_ = nullptr;
  wake_.notify_all();
  takeChunks(lock);
  done_.wait(lock, [this] { return pending_ == 0; });
  chunks_ = next_ = 0;
  task_ = nullptr;
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace migiwa
