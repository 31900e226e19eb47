// Which way two particles part that are on one point.
#pragma once

#include <cstdint>

#include "core/base/types.h"

namespace migiwa {

/// A unit direction for two particles on one point, from their ids: antisymmetric, so that momentum is
/// conserved.
inline Vec3f coincidentDirection(std::uint32_t id, std::uint32_t other) {
  const std::uint32_t low = id < other ? id : other, high = id < other ? other : id;
  std::uint32_t bits = low * 0x9E3779B1U ^ (high * 0x85EBCA77U + 0xC2B2AE3DU);
  const auto next = [&bits] {
    bits ^= bits >> 15, bits *= 0x2C1B3C6DU, bits ^= bits >> 12, bits *= 0x297A2D39U, bits ^= bits >> 15;
    return static_cast<float>(bits >> 8) / 8388608.0F - 1;
  };
  const float x = next(), y = next(), z = next();
  const Vec3f direction(x, y, z);
  const float length = direction.norm();
  const Vec3f unit = length > 1e-3F ? Vec3f(direction / length) : Vec3f(Vec3f::UnitX());
  return id < other ? unit : Vec3f(-unit);
}

/// How far apart they are taken to be, over the support radius.
inline constexpr float kCoincident = 1e-5F;

}  // namespace migiwa
