// Directions in groups of four that lie close together, each with the cone that holds them: a small ball is
// seen by few groups.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/base/types.h"

namespace migiwa {

/// Unit vectors, coordinate by coordinate.
struct DirectionSet {
  std::span<const float> x, y, z;
  std::size_t size() const { return x.size(); }
};

/// Four floats, a vector of the compiler's: every x86-64 has it.
using FourFloats = float __attribute__((vector_size(16)));

class DirectionBins {
 public:
  static constexpr std::size_t kLanes = 4;

  /// Whether these are the bins of exactly these directions.
  bool matches(const DirectionSet& directions) const;
  void build(const DirectionSet& directions);

  struct Bin {
    FourFloats x, y, z;
    std::uint32_t index[kLanes];  ///< of the directions; kNone where there is none
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::span<const Bin> bins() const { return bins_; }
  /// Calls visit(bin) for every bin that may hold a direction within the angle from `axis` whose cosine and
  /// sine are given.
  template <class Visit>
  void visitCone(const Vec3f& axis, float cosine, float sine, const Visit& visit) const;

 private:
  void split(std::span<std::uint32_t> order);

  std::vector<float> known_;  ///< x, y, z of the directions
  std::vector<Bin> bins_;
  /// Cones of the bins, four at a time.
  std::vector<FourFloats> axisX_, axisY_, axisZ_, cosine_, sine_;
};

template <class Visit>
void DirectionBins::visitCone(const Vec3f& axis, float cosine, float sine, const Visit& visit) const {
  const float ax = axis.x(), ay = axis.y(), az = axis.z();
  for (std::size_t group = 0; group < axisX_.size(); ++group) {
    const FourFloats towards = ax * axisX_[group] + ay * axisY_[group] + az * axisZ_[group];
    // cos(a + b); half-angles of bins are small, those of cones at most a right angle.
    const FourFloats least = cosine * cosine_[group] - sine * sine_[group];
    const auto seen = towards >= least;
    std::uint64_t halves[2];
    std::memcpy(halves, &seen, sizeof halves);
    if ((halves[0] | halves[1]) == 0) continue;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if (seen[lane] != 0 && group * kLanes + lane < bins_.size()) visit(bins_[group * kLanes + lane]);
  }
}

}  // namespace migiwa
