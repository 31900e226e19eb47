#include "core/base/messages.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>

#include "core/base/fields.h"
#include "core/base/progress.h"

namespace migiwa {

std::string InputError::join(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    if (!text.empty()) text += '\n';
    text += fault.text();
  }
  return text;
}

std::string formatNumber(const char* format, double value) {
  char text[64];
  const int length = std::snprintf(text, sizeof(text), format, value);
  return std::string(text,
                     static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(sizeof(text)) - 1)));
}

std::string groupedDigits(std::size_t value) {
  std::string text = std::to_string(value);
  for (std::size_t place = text.size(); place > 3;) text.insert(place -= 3, ",");
  return text;
}

std::string milliseconds(double seconds, bool shown) {
  if (!shown) return "–";
  const double ms = 1e3 * seconds;
  return formatNumber(ms < 9.995 ? "%.2f" : ms < 99.95 ? "%.1f" : "%.0f", ms);
}

Ticks roundTicks(double low, double high, int wanted) {
  if (!(high > low) || !std::isfinite(high - low)) return {};
  const double rough = (high - low) / std::max(wanted - 1, 1);
  const double exponent = std::floor(std::log10(rough));
  const double digits = rough / std::pow(10, exponent);
  const double step = (digits < 1.5 ? 1 : digits < 3.5 ? 2 : digits < 7.5 ? 5 : 10) * std::pow(10, exponent);
  Ticks ticks;
  ticks.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double slack = 1e-6 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k) {
    ticks.values.push_back(k == 0 ? 0 : k * step);
  }
  return ticks;
}

int editDistance(std::string_view a, std::string_view b) {
  // Rows of the usual table: the distances of prefixes of a to all prefixes of b. A swap looks two rows back.
  std::vector<int> before(b.size() + 1);
  std::vector<int> above(b.size() + 1);
  std::vector<int> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = static_cast<int>(k);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = static_cast<int>(i);
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const int replaced = above[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1);
      row[k] = std::min({replaced, above[k] + 1, row[k - 1] + 1});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        row[k] = std::min(row[k], before[k - 2] + 1);
    }
  }
  return row.back();
}

std::string_view nearestName(std::string_view word, std::span<const std::string_view> names) {
  // No name is longer than this: the rest of a longer word changes nothing in which one is nearest.
  constexpr std::size_t kEnough = 100;
  std::string_view best;
  int least = 0;
  for (const std::string_view name : names) {
    const int distance = editDistance(word.substr(0, kEnough), name);
    if (best.empty() || distance < least) {
      best = name;
      least = distance;
    }
  }
  return best;
}

std::string quotedList(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  return text;
}

std::string Range::text() const {
  std::ostringstream out;
  if (!std::isfinite(min) && !std::isfinite(max)) return "of any size";
  if (min == max) {
    out << min;
  } else if (!std::isfinite(max)) {
    out << (openMin ? "more than " : "at least ") << min;
  } else if (!std::isfinite(min)) {
    out << (openMax ? "less than " : "at most ") << max;
  } else {
    out << "in " << (openMin ? "(" : "[") << min << ", " << max << (openMax ? ")" : "]");
  }
  return out.str();
}

// How far something is that takes long (core/base/progress.h).

namespace {

thread_local ProgressObserver* watching = nullptr;
thread_local Activity* current = nullptr;

}  // namespace

ProgressScope::ProgressScope(ProgressObserver& observer) : before_(std::exchange(watching, &observer)) {}

ProgressScope::~ProgressScope() {
  watching = before_;
}

Activity::Activity(std::string what) : what_(std::move(what)), outer_(std::exchange(current, this)) {
  if (watching != nullptr) watching->reached(what_, 0);
}

Activity::~Activity() {
  current = outer_;
  if (watching != nullptr && outer_ == nullptr) watching->ended();
}

void Activity::reach(double part) {
  part_ = std::clamp(part, 0.0, 1.0);
  if (watching != nullptr) watching->reached(what_, part_);
}

void Activity::pulse(double part) {
  if (watched()) watching->reached(current->what_, current->part_ < 0 ? part : current->part_);
}

bool Activity::watched() {
  return watching != nullptr && current != nullptr;
}

}  // namespace migiwa
