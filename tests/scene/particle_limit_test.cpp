#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/scene/scene.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace particle_limit_test {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

TEST(ParticleLimit, SaysNothingWhenTheyFit) {
  EXPECT_FALSE(tooManyParticles(9216, 0.05, kGiB).has_value());
  EXPECT_FALSE(tooManyParticles(0, 0.05, 0).has_value());
}

TEST(ParticleLimit, ComparesWithTheMemory) {
  const auto fault = tooManyParticles(1e8, 0.01, 2 * kGiB);
  ASSERT_TRUE(fault.has_value());
  EXPECT_NE(fault->find("2 GiB are available"), std::string::npos) << *fault;
  EXPECT_NE(fault->find("found 0.01 m, which makes 100000000 (about 56 GiB)"), std::string::npos) << *fault;
}

TEST(ParticleLimit, NumbersOfParticlesFitInto32Bits) {
  const double unlimited = std::numeric_limits<double>::infinity();
  // As offsets of 16 bytes a particle, and the ghost after the last.
  EXPECT_FALSE(tooManyParticles(0x1p28 - 1, 0.01, unlimited).has_value());
  EXPECT_TRUE(tooManyParticles(0x1p28, 0.01, unlimited).has_value());
  EXPECT_TRUE(tooManyParticles(std::numeric_limits<double>::infinity(), 1e-300, unlimited).has_value());
}

TEST(ParticleLimit, TheRemedyIsOne) {
  const double memory = 0.3 * kGiB;
  for (const double spacing : {0.0007, 0.001, 0.0023}) {
    const double particles = 1 / (spacing * spacing * spacing);  // a cubic metre
    const auto fault = tooManyParticles(particles, spacing, memory);
    ASSERT_TRUE(fault.has_value());
    const std::string lead = "; a spacing of ";
    const std::size_t at = fault->find(lead);
    ASSERT_NE(at, std::string::npos) << *fault;
    const double remedy = std::stod(fault->substr(at + lead.size()));
    EXPECT_GT(remedy, spacing);
    EXPECT_LE(std::pow(std::round(1 / remedy), 3) * kBytesPerParticle, memory) << *fault;
    EXPECT_GT(std::pow(1 / remedy, 3) * kBytesPerParticle, 0.5 * memory) << "needlessly coarse: " << *fault;
  }
}

TEST(ParticleLimit, CountsAllSources) {
  const Scene scene = parseScene(R"({ "format": 1, "particle_spacing": 0.1, "fluid": [
      { "shape": "box", "min": [0, 0, 0], "max": [1, 1, 1] },
      { "shape": "box", "min": [0, 0, 0], "max": [1, 0.2, 0.1] } ] })",
                                 "memory.json");
  EXPECT_EQ(particleCount(scene), 1000 + 20);
}

}  // namespace particle_limit_test
}  // namespace migiwa
