// Non-local means with guides, for pictures of few samples.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/raytrace/still.h"

namespace migiwa {
namespace {

/// Rows that are worked on as one; windows of this radius around a pixel; patches of this radius (pixels).
constexpr int kBand = 24, kWindow = 7, kPatch = 3;
/// How unlike patches and guides may be, in standard deviations of their noise.
struct Strength {
  float color, guide;
};
/// From those that keep most to those that take most out: of these each pixel has its own.
constexpr std::array<Strength, 4> kStrengths{{{0.65F, 0.8F}, {0.8F, 1.5F}, {1.4F, 3.0F}, {2.5F, 5.0F}}};
/// Errors are compared as means over squares of this radius, shares of strengths are smoothed over this one.
constexpr int kErrors = 8, kShares = 3;
/// Least differences of guides that count: of normals and albedo, of logarithms of distance.
constexpr float kLeastGuide = 2e-3F, kLeastDistance = 2e-4F;

/// Means over squares of (2 radius + 1)^2 pixels, cut off at the rim.
Channel boxMean(Channel plane, int width, int height, int radius) {
  Channel across(plane.size());
  const auto line = [radius](const float* in, float* out, int count, std::ptrdiff_t stride) {
    double sum = 0;  // in float a single bright pixel would leave its rounding behind
    for (int i = 0; i < std::min(radius, count); ++i) sum += double{in[i * stride]};
    for (int i = 0; i < count; ++i) {
      if (i + radius < count) sum += double{in[(i + radius) * stride]};
      if (i - radius - 1 >= 0) sum -= double{in[(i - radius - 1) * stride]};
      const int used = std::min(i + radius, count - 1) - std::max(i - radius, 0) + 1;
      out[i * stride] = static_cast<float>(std::max(sum, 0.0) / used);
    }
  };
  for (std::ptrdiff_t y = 0; y < height; ++y)
    line(plane.data() + y * width, across.data() + y * width, width, 1);
  for (int x = 0; x < width; ++x) line(across.data() + x, plane.data() + x, height, width);
  return plane;
}

using Halves = std::array<Radiance, 2>;

/// Variances of the mean of a half: those of its samples, scaled by how far the halves are apart, for samples
/// that are evenly spread scatter less in the mean than each by itself.
std::array<std::array<Channel, 3>, 2> calibrated(const Exposure& exposure, ThreadPool& pool) {
  auto variances = exposure.variances;
  pool.run(3, [&](std::size_t c) {
    const std::size_t count = variances[0][c].size();
    Channel apart(count), scatter(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float difference = exposure.halves[0][c][i] - exposure.halves[1][c][i];
      apart[i] = difference * difference;
      scatter[i] = variances[0][c][i] + variances[1][c][i];
    }
    const Channel a = boxMean(std::move(apart), exposure.width, exposure.height, 5),
                  s = boxMean(std::move(scatter), exposure.width, exposure.height, 5);
    for (std::size_t i = 0; i < count; ++i) {
      // Halves that are farther apart than their scatter says are so by chance.
      const float scale = s[i] > 0 ? std::min(a[i] / s[i], 1.0F) : 1.0F;
      for (auto& half : variances) half[c][i] *= scale;
    }
  });
  return variances;
}

/// One over the squared difference that guides may have at a pixel.
std::array<Channel, Exposure::kGuides> guideScales(const Exposure& exposure, ThreadPool& pool) {
  std::array<Channel, Exposure::kGuides> scales;
  const int width = exposure.width, height = exposure.height;
  pool.run(Exposure::kGuides, [&](std::size_t g) {
    const Channel& guide = exposure.guides[g];
    const Channel noise = boxMean(exposure.guideVariances[g], width, height, 1);
    scales[g].resize(guide.size());
    const float least = g + 1 == Exposure::kGuides ? kLeastDistance : kLeastGuide;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto at = [&](int dx, int dy) {
          const int px = std::clamp(x + dx, 0, width - 1), py = std::clamp(y + dy, 0, height - 1);
          return guide[static_cast<std::size_t>(py * width + px)];
        };
        const float slopeX = 0.5F * (at(1, 0) - at(-1, 0)), slopeY = 0.5F * (at(0, 1) - at(0, -1));
        const auto i = static_cast<std::size_t>(y * width + x);
        const float slope2 = std::min(slopeX * slopeX, slopeY * slopeY);
        scales[g][i] = 1 / std::max({least, noise[i], slope2});
      }
    }
  });
  return scales;
}

/// exp(-x) for x >= 0, nearly; 0 from 4 on.
inline float falling(float x) {
  const float a = std::max(1 - 0.25F * x, 0.0F);
  return a * a * a * a;
}

/// Averages a band of rows: the weights of one half's pixels come from the other half.
class Band {
 public:
  Band(const Exposure& exposure, const std::array<std::array<Channel, 3>, 2>& variances,
       const std::array<Channel, Exposure::kGuides>& scales, const Strength& strength, int top)
      : exposure_(exposure),
        variances_(variances),
        scales_(scales),
        color2_(strength.color * strength.color),
        guide2_(1 / (strength.guide * strength.guide)),
        width_(exposure.width),
        top_(top),
        rows_(std::min(kBand, exposure.height - top)) {
    const auto count = static_cast<std::size_t>(rows_ * width_);
    for (auto& half : sums_)
      for (Channel& plane : half) plane.assign(count, 0);
    for (Channel& plane : weights_) plane.assign(count, 0);
    guides_.assign(count, 0);
    const auto padded = static_cast<std::size_t>((rows_ + 2 * kPatch) * width_);
    unlike_.assign(padded, 0);
    across_.assign(padded, 0);
  }

  void average(Halves& result) {
    for (int dy = -kWindow; dy <= kWindow; ++dy)
      for (int dx = -kWindow; dx <= kWindow; ++dx) {
        compareGuides(dx, dy);
        for (std::size_t half = 0; half < 2; ++half) addNeighbours(half, dx, dy);
      }
    for (int i = 0; i < rows_ * width_; ++i) {
      const auto at = static_cast<std::size_t>(i), to = static_cast<std::size_t>(top_ * width_ + i);
      for (std::size_t half = 0; half < 2; ++half)
        for (std::size_t c = 0; c < 3; ++c) result[half][c][to] = sums_[half][c][at] / weights_[half][at];
    }
  }

 private:
  /// Columns whose neighbour at dx lies in the picture.
  int firstColumn(int dx) const { return std::max(0, -dx); }
  int endColumn(int dx) const { return std::min(width_, width_ - dx); }
  bool hasRow(int y) const { return y >= 0 && y < exposure_.height; }

  void compareGuides(int dx, int dy) {
    std::fill(guides_.begin(), guides_.end(), 0.0F);
    for (int row = 0; row < rows_; ++row) {
      const int y = top_ + row;
      if (!hasRow(y + dy)) continue;
      float* most = guides_.data() + row * width_;
      for (std::size_t g = 0; g < Exposure::kGuides; ++g) {
        const float *f = exposure_.guides[g].data() + y * width_,
                    *v = exposure_.guideVariances[g].data() + y * width_, *s = scales_[g].data() + y * width_;
        const std::ptrdiff_t shift = std::ptrdiff_t{dy} * width_ + dx;
        for (int x = firstColumn(dx); x < endColumn(dx); ++x) {
          const float difference = f[x + shift] - f[x];
          const float beyondNoise = difference * difference - v[x] - std::min(v[x], v[x + shift]);
          most[x] = std::max(most[x], beyondNoise * (guide2_ * s[x]));
        }
      }
    }
  }

  /// How unlike single pixels are, in units of their noise.
  void compareColors(std::size_t half, int dx, int dy) {
    std::fill(unlike_.begin(), unlike_.end(), 0.0F);
    const std::ptrdiff_t shift = std::ptrdiff_t{dy} * width_ + dx;
    for (int row = 0; row < rows_ + 2 * kPatch; ++row) {
      const int y = top_ + row - kPatch;
      if (!hasRow(y) || !hasRow(y + dy)) continue;
      float* to = unlike_.data() + row * width_;
      for (std::size_t c = 0; c < 3; ++c) {
        const float *u = exposure_.halves[half][c].data() + y * width_,
                    *v = variances_[half][c].data() + y * width_;
        for (int x = firstColumn(dx); x < endColumn(dx); ++x) {
          const float difference = u[x + shift] - u[x];
          const float noise = v[x] + std::min(v[x], v[x + shift]);
          // A little of the brightness itself: below that nobody sees a difference.
          const float least = 1e-6F + 1e-5F * u[x] * u[x];
          to[x] += (difference * difference - noise) / (least + color2_ * (v[x] + v[x + shift]));
        }
      }
    }
  }

  void addNeighbours(std::size_t half, int dx, int dy) {
    compareColors(1 - half, dx, dy);
    constexpr float kMean = 1.0F / (3 * (2 * kPatch + 1) * (2 * kPatch + 1));
    // Sums along the rows, then over them.
    for (int row = 0; row < rows_ + 2 * kPatch; ++row) {
      const float* in = unlike_.data() + row * width_;
      float* out = across_.data() + row * width_;
      for (int x = 0; x < width_; ++x) {
        if (x >= kPatch && x < width_ - kPatch) {
          out[x] = in[x - 3] + in[x - 2] + in[x - 1] + in[x] + in[x + 1] + in[x + 2] + in[x + 3];
        } else {
          out[x] = 0;
          for (int k = -kPatch; k <= kPatch; ++k) out[x] += in[std::clamp(x + k, 0, width_ - 1)];
        }
      }
    }
    const std::ptrdiff_t shift = std::ptrdiff_t{dy} * width_ + dx;
    for (int row = 0; row < rows_; ++row) {
      const int y = top_ + row;
      if (!hasRow(y + dy)) continue;
      const float *s = across_.data() + row * width_, *guides = guides_.data() + row * width_;
      const auto w = static_cast<std::ptrdiff_t>(width_);
      float* weights = weights_[half].data() + row * width_;
      for (int x = firstColumn(dx); x < endColumn(dx); ++x) {
        const float unlike =
            s[x] + s[x + w] + s[x + 2 * w] + s[x + 3 * w] + s[x + 4 * w] + s[x + 5 * w] + s[x + 6 * w];
        const float weight = falling(std::max(std::max(kMean * unlike, guides[x]), 0.0F));
        weights[x] += weight;
        for (std::size_t c = 0; c < 3; ++c)
          sums_[half][c][static_cast<std::size_t>(row * width_ + x)] +=
              weight * exposure_.halves[half][c][static_cast<std::size_t>(y * width_ + x + shift)];
      }
    }
  }

  const Exposure& exposure_;
  const std::array<std::array<Channel, 3>, 2>& variances_;
  const std::array<Channel, Exposure::kGuides>& scales_;
  float color2_, guide2_;
  int width_, top_, rows_;
  std::array<std::array<Channel, 3>, 2> sums_;
  std::array<Channel, 2> weights_;
  Channel guides_, unlike_, across_;
};

static_assert(kPatch == 3, "the sums over patches are written out");

/// How far filtered halves are at a pixel from the other halves as they are, relative to the brightness:
/// their error and what is the same for all strengths [RMZ].
float errorAt(std::size_t i, const Halves& filtered, const Exposure& exposure) {
  float error = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float mean = 0.5F * (filtered[0][c][i] + filtered[1][c][i]);
    for (std::size_t half = 0; half < 2; ++half) {
      const float difference = filtered[half][c][i] - exposure.halves[1 - half][c][i];
      error += difference * difference / (1e-3F + mean * mean);
    }
  }
  return error;
}

/// What each strength makes of a picture, and how far that is off at each pixel.
struct Filtered {
  std::array<Radiance, kStrengths.size()> pictures;
  std::array<Channel, kStrengths.size()> errors;
};
Filtered filtered(const Exposure& exposure, ThreadPool& pool) {
  const auto variances = calibrated(exposure, pool);
  const auto scales = guideScales(exposure, pool);
  const auto bands = static_cast<std::size_t>((exposure.height + kBand - 1) / kBand);
  const std::size_t count = exposure.halves[0][0].size();
  Filtered result;
  Halves halves;
  for (Radiance& half : halves)
    for (Channel& plane : half) plane.resize(count);
  for (std::size_t s = 0; s < kStrengths.size(); ++s) {
    pool.run(bands, [&](std::size_t band) {
      Band(exposure, variances, scales, kStrengths[s], static_cast<int>(band) * kBand).average(halves);
    });
    result.errors[s].resize(count);
    for (Channel& plane : result.pictures[s]) plane.resize(count);
    parallelEach(pool, count, [&](std::size_t i) {
      result.errors[s][i] = errorAt(i, halves, exposure);
      for (std::size_t c = 0; c < 3; ++c)
        result.pictures[s][c][i] = 0.5F * (halves[0][c][i] + halves[1][c][i]);
    });
  }
  return result;
}

}  // namespace

Radiance denoised(const Exposure& exposure, ThreadPool& pool) {
  auto [pictures, planes] = filtered(exposure, pool);
  const auto smooth = [&](int radius) {
    pool.run(planes.size(), [&](std::size_t s) {
      planes[s] = boxMean(std::move(planes[s]), exposure.width, exposure.height, radius);
    });
  };
  smooth(kErrors);
  const std::size_t count = planes[0].size();
  // From here on the planes are the shares of the strengths.
  parallelEach(pool, count, [&](std::size_t i) {
    std::size_t best = 0;
    for (std::size_t s = 1; s < kStrengths.size(); ++s)
      if (planes[s][i] < planes[best][i]) best = s;
    for (std::size_t s = 0; s < kStrengths.size(); ++s) planes[s][i] = s == best ? 1.0F : 0.0F;
  });
  smooth(kShares);
  Radiance result;
  for (Channel& plane : result) plane.resize(count);
  parallelEach(pool, count, [&](std::size_t i) {
    for (std::size_t c = 0; c < 3; ++c) {
      float sum = 0;
      for (std::size_t s = 0; s < kStrengths.size(); ++s) sum += planes[s][i] * pictures[s][c][i];
      result[c][i] = sum;
    }
  });
  return result;
}

}  // namespace migiwa
