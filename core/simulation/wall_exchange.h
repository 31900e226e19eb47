// Other walls in the place of those that a simulation has: for as long as it is not certain that they stay.
#pragma once

#include <type_traits>
#include <utility>

#include "core/boundary/boundary.h"

namespace migiwa {

class WallExchange {
 public:
  explicit WallExchange(Boundary& place) : place_(place) {}
  /// Puts the old walls back, unless the new ones are to be kept.
  ~WallExchange() {
    if (put_) std::swap(place_, other_);
  }
  WallExchange(const WallExchange&) = delete;
  WallExchange& operator=(const WallExchange&) = delete;

  /// Once. What refers to the old surfaces goes on doing so: they last as long as this exchange.
  void put(Boundary walls) {
    other_ = std::move(walls);
    std::swap(place_, other_);
    put_ = true;
  }
  void keep() { put_ = false; }

 private:
  static_assert(std::is_nothrow_move_constructible_v<Boundary> &&
                std::is_nothrow_move_assignable_v<Boundary>);

  Boundary& place_;
  Boundary other_;
  bool put_ = false;
};

}  // namespace migiwa
