// Chebyshev semi-iteration (Golub & Varga 1961; Wang 2015 for position based methods): every Jacobi-like step
// is stretched away from the iterate before the last, x_{k+1} = x_{k-1} + w_k (step(x_k) - x_{k-1}).
#pragma once

namespace migiwa {

/// The weights w_k, one an iteration.
class Chebyshev {
 public:
  /// Of the next iteration. The first two are 1: they take away the errors that stretching would feed.
  float next() {
    // An estimate of the plain iteration's spectral radius. Larger ones converge faster still at rest, and
    // double the density peaks of impacts.
    constexpr float kRadius2 = 0.9F * 0.9F;
    constexpr int kPlain = 2;
    if (iteration_++ < kPlain) return 1;
    weight_ = weight_ == 1 ? 2 / (2 - kRadius2) : 4 / (4 - kRadius2 * weight_);
    return weight_;
  }

 private:
  int iteration_ = 0;
  float weight_ = 1;
};

}  // namespace migiwa
