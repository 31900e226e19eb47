#include "app/commands/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <unistd.h>

namespace migiwa {

namespace {

std::string duration(double seconds) {
  char text[32];
  if (seconds < 60) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else if (seconds < 3600) {
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  }
  return text;
}

}  // namespace

ProgressBar::ProgressBar(double from, double until, bool quiet)
    : from_(from), until_(until), shown_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double time) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  constexpr int kCells = 30;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double part = until_ > from_ ? std::clamp((time - from_) / (until_ - from_), 0.0, 1.0) : 1;
  const int filled = static_cast<int>(part * kCells);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kCells - filled), '.');
  const std::string left = part > 0 ? duration(elapsed * (1 - part) / part) + " left" : "";
  std::fprintf(stderr, "\r[%s] %.2f of %.2f s, %.2f x real time, %s\033[K", bar.c_str(), time, until_,
               (time - from_) / elapsed, left.c_str());
  std::fflush(stderr);
}

}  // namespace migiwa
