// What a command was given may be wrong in several places: all of them are reported, not the first alone.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace migiwa {

class FaultCollector {
 public:
  /// Runs a part of the checks; its faults are kept, and the next part runs all the same.
  template <class Body>
  void operator()(const Body& body) {
    try {
      body();
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults()) add(fault);
    }
  }
  /// Keeps a fault, unless it is known already: a scene that is read twice has each of its own twice.
  void add(const Fault& fault) {
    const auto same = [&](const Fault& known) { return known.text() == fault.text(); };
    if (std::none_of(faults_.begin(), faults_.end(), same)) faults_.push_back(fault);
  }
  /// Throws all that were kept as one error, if there are any.
  void raise() {
    if (!faults_.empty()) throw InputError(std::move(faults_));
  }

 private:
  std::vector<Fault> faults_;
};

}  // namespace migiwa
