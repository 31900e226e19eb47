#include "app/raytrace/paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <Eigen/Geometry>

namespace migiwa {
namespace {

constexpr int kSurelyBounces = 4;
/// Starts of a stretch that are tried where its ends disagree.
constexpr int kStarts = 6;

struct Ray {
  Vec3f origin, direction;
  Place place;
};

/// The way on from an event, as random numbers choose it.
struct Departure {
  Ray arrival;
  Event event;
  float one = 0, two = 0;  ///< random, in [0, 1)
};

/// A direction with a density of cosine / pi about a normal.
Vec3f cosineDirection(const Vec3f& normal, float one, float two) {
  const float radius = std::sqrt(one), turn = 2 * std::numbers::pi_v<float> * two;
  const Vec3f u = normal.unitOrthogonal(), v = normal.cross(u);
  return (radius * std::cos(turn) * u + radius * std::sin(turn) * v +
          std::sqrt(std::max(1 - one, 0.0F)) * normal)
      .normalized();
}

Medium otherFluid(Medium medium) {
  return medium == Medium::water ? Medium::air : Medium::water;
}

/// Where an interface sends light that `chance` lets through or not.
Ray throughInterface(const Departure& from, Place beyond) {
  const Event& event = from.event;
  const Vec3f& direction = from.arrival.direction;
  const float here = refractiveIndex(from.arrival.place.medium), there = refractiveIndex(beyond.medium);
  if (here == there) return {event.point, direction, beyond};
  // The smooth normal counts unless it would send light to the wrong side of the triangle.
  for (const Vec3f& normal : {event.shading, event.normal}) {
    if (direction.dot(normal) >= 0) continue;
    const Interface optics = interfaceAt(direction, normal, here, there);
    const bool back = from.one < optics.reflectance;
    const Vec3f onward = back ? reflected(direction, normal) : optics.refracted;
    if ((onward.dot(event.normal) > 0) == back)
      return {event.point, onward, back ? from.arrival.place : beyond};
  }
  return {event.point, reflected(direction, event.normal), from.arrival.place};
}

/// The ray that leaves; of several starts each is another way to read a place where rounding decides.
Ray depart(const Departure& from, const Stage& stage, int start) {
  const Event& event = from.event;
  const bool other = start == 1 || start == 3;
  Ray ray;
  if (event.kind == Event::Kind::matt) {
    ray = {event.point, cosineDirection(event.shading, from.one, from.two), from.arrival.place};
    if (ray.place.medium != Medium::glass) {
      ray.place.medium = other ? otherFluid(event.before) : event.before;
    }
    if (ray.direction.dot(event.normal) <= 0) ray.direction = reflected(ray.direction, event.normal);
  } else {
    Place beyond = event.beyond;
    if (event.byLabel && other) beyond.medium = otherFluid(beyond.medium);
    // A face of the water may be one too many, where its triangles pass through each other.
    const bool passed = other && !event.byLabel && beyond.medium != Medium::glass;
    ray = passed ? Ray{event.point, from.arrival.direction, from.arrival.place}
                 : throughInterface(from, beyond);
  }
  // The ray may have come from the other side of the water's surface than it seemed: where that ends at
  // glass, which throws light back above and below it, or where it passes through itself.
  if (start >= 4 && ray.place.medium != Medium::glass) ray.place.medium = otherFluid(ray.place.medium);
  constexpr float kOffsets[kStarts] = {1, 1, 30, 30, 1, 30};
  const float off = (event.meshed || start > 0 ? kOffsets[start] : 0.0F) * stage.offset();
  ray.origin += (ray.direction.dot(event.normal) > 0 ? off : -off) * event.normal;
  return ray;
}

/// Light that comes straight from the area light, weighted against paths that find it by themselves
/// ([VG], balance heuristic).
Vec3f directLight(const Stage& stage, const Event& event, PixelSamples& random) {
  const Stage::Light& light = stage.light();
  const auto [a, b] = random.next();
  if (light.area <= 0) return Vec3f::Zero();
  const Vec3f way = light.center + (2 * a - 1) * light.u + (2 * b - 1) * light.v - event.point;
  const float distance2 = way.squaredNorm(), distance = std::sqrt(distance2);
  const Vec3f direction = way / distance;
  const float cosine = direction.dot(event.shading), emitted = -direction.dot(light.normal);
  if (cosine <= 0 || emitted <= 0 || direction.dot(event.normal) <= 0) return Vec3f::Zero();
  if (stage.blocked(event.point + stage.offset() * event.normal, direction, distance)) return Vec3f::Zero();
  const float density = distance2 / (emitted * light.area), own = cosine / std::numbers::pi_v<float>;
  return light.radiance * (own / (density + own));
}

/// The density with which directLight would have chosen this way to the light.
float lightDensity(const Stage& stage, const Vec3f& direction, float distance) {
  const Stage::Light& light = stage.light();
  return distance * distance / (-direction.dot(light.normal) * light.area);
}

}  // namespace

PathSample tracePath(const Stage& stage, const Vec3f& eye, const Vec3f& direction, const Place& place,
                     PixelSamples& random, PathCounts& counts, int bounces) {
  PathSample sample;
  Vec3f throughput = Vec3f::Ones();
  Departure last;
  Ray ray{eye, direction, place};
  bool smooth = true;  // nothing but smooth surfaces so far
  float sampled = 0;   // density of the direction where the light was asked for directly; 0: it was not
  float distance = 0;
  ++counts.paths;
  for (int bounce = 0; bounce < bounces; ++bounce) {
    Event event = stage.next(ray.origin, ray.direction, ray.place);
    ++counts.stretches;
    if (event.before != ray.place.medium) {
      ++counts.contradictions;
      if (bounce == 0) {
        ray.place.medium = event.before;  // the eye is in water
      } else {
        int start = 1;
        for (; start < kStarts && event.before != ray.place.medium; ++start) {
          ray = depart(last, stage, start);
          event = stage.next(ray.origin, ray.direction, ray.place);
        }
        // A matt wall lets nothing through: the path goes on by what its place says.
        if (event.before != ray.place.medium && event.kind != Event::Kind::matt) {
          ++counts.leaked;
          return sample;
        }
      }
    }
    if (event.kind != Event::Kind::sky) {
      throughput = throughput.cwiseProduct(stage.transmittance(ray.place.medium, event.distance));
      distance += event.distance;
    }
    if (event.kind == Event::Kind::sky) {
      if (smooth) sample.distance = distance + 10 * stage.extent();
      sample.radiance += throughput.cwiseProduct(stage.sky(ray.direction));
      return sample;
    }
    if (event.kind == Event::Kind::light) {
      if (smooth) sample.distance = distance;
      const float weight =
          sampled > 0 ? sampled / (sampled + lightDensity(stage, ray.direction, event.distance)) : 1.0F;
      sample.radiance += weight * throughput.cwiseProduct(stage.light().radiance);
      return sample;
    }
    if (event.kind == Event::Kind::matt) {
      if (smooth) {
        sample.normal = event.shading;
        sample.albedo = event.albedo;
        sample.distance = distance;
      }
      smooth = false;
      if (event.haze > 0) {
        Vec3f level = ray.direction - ray.direction.dot(event.normal) * event.normal;
        level = level.norm() > 0 ? Vec3f(level.normalized()) : ray.direction;
        sample.radiance += event.haze * throughput.cwiseProduct(stage.sky(level));
        throughput *= 1 - event.haze;
        if (event.haze >= 1) return sample;
      }
      throughput = throughput.cwiseProduct(event.albedo);
      const bool inAir = ray.place.medium == Medium::air;
      if (inAir) sample.radiance += throughput.cwiseProduct(directLight(stage, event, random));
      last = {ray, event};
      std::tie(last.one, last.two) = random.next();
      ray = depart(last, stage, 0);
      sampled = inAir ? ray.direction.dot(event.shading) / std::numbers::pi_v<float> : 0.0F;
    } else {
      last = {ray, event};
      std::tie(last.one, last.two) = random.next();
      ray = depart(last, stage, 0);
      sampled = 0;
    }
    if (bounce >= kSurelyBounces) {
      const float survives = std::min(throughput.maxCoeff(), 1.0F);
      if (survives < 1) {
        if (random.next().first >= survives) return sample;
        throughput /= survives;
      }
    }
  }
  return sample;
}

}  // namespace migiwa
