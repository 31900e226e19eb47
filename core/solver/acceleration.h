// Chebyshev semi-iteration (Golub & Varga 1961; Wang 2015 for position based methods): every Jacobi-like step
// is stretched away from the iterate before the last, x_{k+1} = x_{k-1} + w_k (step(x_k) - x_{k-1}).
#pragma once

#include <vector>

#include "core/solver/iteration_error.h"

namespace migiwa {

/// The weights w_k, one an iteration.
class Chebyshev {
 public:
  /// Of the iteration that follows the given errors, in a solve that ends at `tolerance`. The first two are
  /// 1: they take away the errors that stretching would feed. So is the one that is about to end the solve by
  /// itself, going by how much the one before it achieved: stretched, it would overshoot, and fluid at rest
  /// would never calm down, for nothing pulls back what is pushed apart too far.
  float next(const std::vector<IterationError>& errors, double tolerance) {
    // An estimate of the plain iteration's spectral radius. Larger ones converge faster still at rest, and
    // double the density peaks of impacts.
    constexpr float kRadius2 = 0.9F * 0.9F;
    constexpr std::size_t kPlain = 2;
    if (errors.size() <= kPlain) return 1;
    weight_ = weight_ == 1 ? 2 / (2 - kRadius2) : 4 / (4 - kRadius2 * weight_);
    const double error = errors.back().mean, before = errors[errors.size() - 2].mean;
    return error * error <= tolerance * before ? 1 : weight_;
  }

 private:
  float weight_ = 1;
};

}  // namespace migiwa
