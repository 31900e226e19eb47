// What is fuzzed: everything that reads what a person, or another program, has written. A target takes any
// bytes; an InputError is the right answer to most of them, and anything else that gets out is a fault.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace migiwa::fuzz {

struct Target {
  std::string_view name;  ///< also of its corpus in tests/fuzz/corpus
  void (*run)(std::string_view input);
};

std::span<const Target> targets();

}  // namespace migiwa::fuzz
