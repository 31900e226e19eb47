// What a scene names under one key, such as its shapes or its effects: the program's own entries, and those
// that a program built on the library adds.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

template <class Made>
class Registry {
 public:
  using Make = std::function<std::unique_ptr<Made>()>;
  struct Entry {
    std::string name;
    Make make;
  };

  /// `what` an entry is, for errors.
  Registry(std::string_view what, std::initializer_list<Entry> own) : what_(what) {
    entries_.reserve(kMost);
    for (const Entry& entry : own) add(entry.name, entry.make);
  }
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// After the others. Throws std::invalid_argument for a name that is no lower-case word with digits and
  /// underscores, that is taken, or one too many.
  void add(const std::string& name, Make make) {
    const std::lock_guard lock(mutex_);
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    if (name.empty() || !std::all_of(name.begin(), name.end(), fits))
      throw std::invalid_argument("expected lower-case letters, digits and underscores for the name of " +
                                  what_ + ", found \"" + name + "\"");
    for (const Entry& entry : entries_)
      if (entry.name == name)
        throw std::invalid_argument("expected a new name for " + what_ + ", found \"" + name +
                                    "\", which is taken");
    if (!make)
      throw std::invalid_argument("expected a function that makes " + what_ + " \"" + name +
                                  "\", found none");
    if (entries_.size() == kMost)
      throw std::invalid_argument("expected at most " + std::to_string(kMost) +
                                  " names, found one more for " + what_);
    entries_.push_back({name, std::move(make)});
    names_[entries_.size() - 1] = entries_.back().name;
  }

  /// In the order in which they were added. Stays valid when others are added.
  std::span<const std::string_view> names() const {
    const std::lock_guard lock(mutex_);
    return std::span(names_).first(entries_.size());
  }
  std::unique_ptr<Made> make(int index) const {
    const std::lock_guard lock(mutex_);
    return entries_.at(static_cast<std::size_t>(index)).make();
  }

 private:
  static constexpr std::size_t kMost = 64;

  std::string what_;
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;  ///< never moves: room for all is there from the start
  std::array<std::string_view, kMost> names_;
};

}  // namespace migiwa
