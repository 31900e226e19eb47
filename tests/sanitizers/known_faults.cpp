// Faults made on purpose: a sanitizer that does not report its own here watches nothing. The program makes
// the fault that it is asked for; Python loads the same as a library and calls race() from two of its
// threads.
#include <atomic>
#include <cstdio>
#include <limits>
#include <string_view>
#include <thread>
#include <vector>

/// Writes what another thread writes, too, unguarded. Waits for a second thread that calls it: relaxed
/// atomics put the two writes in no order, so that the race does not depend on which is faster.
extern "C" __attribute__((visibility("default"))) int race() {
  static std::atomic<int> arrived;
  static int unguarded;
  arrived.fetch_add(1, std::memory_order_relaxed);
  while (arrived.load(std::memory_order_relaxed) < 2) std::this_thread::yield();
  return ++unguarded;
}

namespace {

int readBeyondTheEnd(int count) {
  const std::vector<int> values(static_cast<std::size_t>(count));
  return values.data()[count];
}

int overflow(int more) {
  return std::numeric_limits<int>::max() + more;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view fault = argc == 2 ? argv[1] : "";
  if (fault == "race") {
    std::thread other(race);
    race();
    other.join();
  } else if (fault == "read_beyond_the_end") {
    std::printf("%d\n", readBeyondTheEnd(argc));
  } else if (fault == "overflow") {
    std::printf("%d\n", overflow(argc));
  } else {
    std::fputs("expected race, read_beyond_the_end or overflow\n", stderr);
    return 2;
  }
  return 0;
}
