// Whole pictures: the same for any number of threads, and what taking out the noise keeps and does.
#include "app/raytrace/still.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/slim/points.h"
#include "tests/raytrace/stages.h"

namespace migiwa {
namespace still_test {

Exposure smallPicture(const Stage& stage, const Camera& camera, int samples, int threads,
                      std::uint32_t seed = 0) {
  ThreadPool pool(threads);
  return expose(stage, camera, {.width = 80, .height = 50, .samples = samples, .seed = seed}, pool);
}

TEST(Still, IsTheSameForAnyNumberOfThreads) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const testing::WavyTank tank;
  const Stage stage(tank.content(Surround::studio, true));
  ThreadPool one(1), two(2);
  const auto picture = [&](ThreadPool& pool) {
    return developed(denoised(
        expose(stage, tank.scene.view.camera, {.width = 80, .height = 50, .samples = 5}, pool), pool));
  };
  EXPECT_EQ(picture(one), picture(two));
}

TEST(Still, DependsOnItsSeedAlone) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const testing::WavyTank tank;
  const Stage stage(tank.content(Surround::studio, true));
  const Camera& camera = tank.scene.view.camera;
  const Radiance one = meanOf(smallPicture(stage, camera, 4, 2, 1));
  EXPECT_EQ(one, meanOf(smallPicture(stage, camera, 4, 2, 1)));
  EXPECT_NE(one, meanOf(smallPicture(stage, camera, 4, 2, 2)));
}

TEST(Still, InAFurnaceIsWhite) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const testing::WavyTank tank;
  const Stage stage(tank.content());
  ThreadPool pool(2);
  const Radiance picture = meanOf(expose(stage, tank.scene.view.camera,
                                         {.width = 60, .height = 40, .samples = 8, .bounces = 2000}, pool));
  for (const Channel& channel : picture) {
    double sum = 0;
    for (const float value : channel) sum += static_cast<double>(value);
    EXPECT_NEAR(sum / static_cast<double>(channel.size()), 1, 0.002);
  }
}

/// Two flat halves, with noise of this standard deviation in each sample's half.
Exposure madeUp(float left, float right, float noise, int width = 64, int height = 48) {
  Exposure exposure;
  exposure.width = width, exposure.height = height;
  const auto count = static_cast<std::size_t>(width * height);
  RandomSequence random(9);
  for (std::size_t half = 0; half < 2; ++half)
    for (std::size_t c = 0; c < 3; ++c) {
      exposure.variances[half][c].assign(count, noise * noise);
      for (std::size_t i = 0; i < count; ++i) {
        const float value = static_cast<int>(i) % width < width / 2 ? left : right;
        const double even = std::sqrt(3.0) * (2 * random.unit() - 1);
        exposure.halves[half][c].push_back(value + noise * static_cast<float>(even));
      }
    }
  for (auto& plane : exposure.guides) plane.assign(count, 0);
  for (auto& plane : exposure.guideVariances) plane.assign(count, 0);
  return exposure;
}

TEST(Denoised, LeavesWhatHasNoNoise) {
  ThreadPool pool(2);
  const Exposure exposure = madeUp(0.2F, 0.9F, 0);
  const Radiance picture = denoised(exposure, pool);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < picture[c].size(); ++i)
      ASSERT_NEAR(picture[c][i], exposure.halves[0][c][i], 1e-5F);
}

TEST(Denoised, TakesNoiseOutAndKeepsEdges) {
  ThreadPool pool(2);
  const Exposure exposure = madeUp(0.2F, 0.9F, 0.05F);
  const Radiance noisy = meanOf(exposure), picture = denoised(exposure, pool);
  const auto error = [&](const Radiance& of) {
    double sum = 0;
    for (std::size_t i = 0; i < of[0].size(); ++i) {
      const double wanted = static_cast<int>(i) % exposure.width < exposure.width / 2 ? 0.2 : 0.9;
      sum += std::pow(static_cast<double>(of[0][i]) - wanted, 2);
    }
    return sum;
  };
  EXPECT_LT(error(picture), 0.05 * error(noisy));
}

TEST(Denoised, TakesTheStrengthThatSuitsEachPixel) {
  ThreadPool pool(2);
  // Left: flat, and what guides is as noisy; right: stripes of one pixel that are hardly beyond the noise.
  constexpr float kNoise = 0.02F, kContrast = 3 * kNoise;
  Exposure exposure = madeUp(0.5F, 0.5F, kNoise, 128, 64);
  RandomSequence random(4);
  for (std::size_t i = 0; i < exposure.guides[0].size(); ++i) {
    if (i % 128 < 64) {
      for (std::size_t g = 0; g < Exposure::kGuides; ++g) {
        exposure.guides[g][i] = 0.1F * static_cast<float>(std::sqrt(3.0) * (2 * random.unit() - 1));
        exposure.guideVariances[g][i] = 0.01F;
      }
    } else {
      for (auto& half : exposure.halves)
        for (Channel& plane : half) plane[i] += i % 2 == 0 ? kContrast / 2 : -kContrast / 2;
    }
  }
  const Radiance picture = denoised(exposure, pool);
  double noise = 0, contrast = 0;
  int flat = 0, striped = 0;
  for (std::size_t i = 0; i < picture[1].size(); ++i) {
    const double off = static_cast<double>(picture[1][i]) - 0.5;
    if (i % 128 < 40) noise += off * off, ++flat;
    if (i % 128 >= 88) contrast += i % 2 == 0 ? 2 * off : -2 * off, ++striped;
  }
  // The weakest strength alone leaves 16 % of the noise, the strongest 31 % of the contrast.
  EXPECT_LT(std::sqrt(noise / flat), 0.06 * static_cast<double>(kNoise));
  EXPECT_NEAR(contrast / striped, static_cast<double>(kContrast), 0.05 * static_cast<double>(kContrast));
}

TEST(Denoised, FarFromABrightPixelIsAsWithoutIt) {
  ThreadPool pool(2);
  Exposure exposure = madeUp(0.2F, 0.2F, 0.05F);
  const Radiance without = denoised(exposure, pool);
  exposure.halves[0][0][5 * 64 + 3] = 1e3F;
  const Radiance with = denoised(exposure, pool);
  for (std::size_t i = 0; i < with[1].size(); ++i) {
    if (i % 64 >= 40 || i / 64 >= 40) {
      ASSERT_EQ(with[1][i], without[1][i]) << i;
    }
  }
}

TEST(Developed, BlackIsBlackAndBrighterIsNotDarker) {
  Channel ramp;
  for (int k = 0; k < 400; ++k) ramp.push_back(0.05F * static_cast<float>(k));
  const std::vector<std::uint8_t> rgba = developed({ramp, ramp, ramp});
  EXPECT_EQ(rgba[0], 0);
  EXPECT_GE(rgba[rgba.size() - 2], 250);
  for (std::size_t i = 4; i < rgba.size(); i += 4) {
    EXPECT_GE(rgba[i], rgba[i - 4]);
    EXPECT_EQ(rgba[i + 3], 255);
  }
}

}  // namespace still_test
}  // namespace migiwa
