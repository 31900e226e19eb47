#include "core/simulation/fill.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/simulation/frame_view.h"
#include "core/solver/step.h"

namespace migiwa {

namespace {

/// What filling takes for a particle (bytes): a centre and the particle itself, in arrays that grow by
/// doubling.
constexpr double kBytesWhileFilling = 200;

/// Particles of different sources are no nearer to each other than this, in spacings.
constexpr double kNearestOther = 0.9;

/// Particles of one source that are there, from `begin` to `end`, and their extent.
struct Filled {
  std::size_t begin, end;
  Bounds bounds;
};

NearPoints placesWithin(const Bounds& region, const std::vector<Filled>& filled, const Particles& particles,
                        double reach) {
  std::vector<Vec3f> taken;
  for (const Filled& other : filled) {
    if ((other.bounds.min.array() > region.max.array()).any() ||
        (other.bounds.max.array() < region.min.array()).any())
      continue;
    for (std::size_t k = other.begin; k < other.end; ++k)
      if (const Vec3f p = particles.position[k].xyz(); region.contains(p.cast<double>())) taken.push_back(p);
  }
  return {std::move(taken), reach};
}

bool anyWithin(const NearPoints& points, const Vec3f& p) {
  bool found = false;
  if (!points.empty())
    points.within(p, [&](std::uint32_t) {
      found = true;
      return false;
    });
  return found;
}

std::string shareOf(std::size_t part, std::size_t all) {
  std::ostringstream text;
  text.precision(3);
  text << 100 * static_cast<double>(part) / static_cast<double>(all) << " % of its particles (" << part
       << " of " << all << ")";
  return text.str();
}

/// What is said of a source, one sentence each.
std::vector<std::string> remarksOn(std::size_t all, std::size_t inWalls, std::size_t inOthers,
                                   std::string lattice) {
  std::vector<std::string> remarks;
  if (all == 0)
    remarks.emplace_back("no particle has room in this source; it is thinner than particle_spacing");
  else if (inWalls == all)
    remarks.emplace_back("no particle is left of this source; it lies within or too near the walls");
  else if (inWalls + inOthers == all)
    remarks.emplace_back("no particle is left of this source; earlier sources fill it already");
  else if (!lattice.empty())
    remarks.push_back(std::move(lattice));
  if (inWalls > 0 && inWalls < all)
    remarks.push_back(shareOf(inWalls, all) + " lie within or too near the walls and are left out");
  if (inOthers > 0 && inOthers < all)
    remarks.push_back(shareOf(inOthers, all) +
                      " lie where those of earlier sources are already and are left out");
  return remarks;
}

/// Fewer layers than this resolve neither a surface nor what flows below it.
constexpr int kFewLayers = 3;

/// Layers of particles above each other where there are most, none where there are more than a few.
std::optional<int> fewLayers(const Particles& particles, const Vec3d& gravity, double spacing) {
  if (gravity.isZero() || particles.size() == 0) return std::nullopt;
  const Vec3d up = -gravity.normalized(), x = up.unitOrthogonal(), y = up.cross(x);
  const Vec3d first = particles.position[0].xyz().cast<double>();
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<double, double>> columns;
  double deepest = 0;
  for (const Float4& position : particles.position) {
    const Vec3d p = position.xyz().cast<double>() - first;
    const auto along = [&](const Vec3d& axis) { return std::llround(p.dot(axis) / spacing); };
    const double height = p.dot(up);
    auto& [low, high] = columns.try_emplace({along(x), along(y)}, height, height).first->second;
    low = std::min(low, height), high = std::max(high, height);
    deepest = std::max(deepest, (high - low) / spacing);
    if (deepest > kFewLayers - 0.5) return std::nullopt;
  }
  return static_cast<int>(std::lround(deepest)) + 1;
}

/// The most that a wall's stated error counts, in spacings.
constexpr double kMostError = 0.25;

/// Whether there is room at p, half a `spacing` (m) from every wall. Where a wall stands for a shape that it
/// is not quite, there is as soon as there may be before that shape; p then moves away from the wall.
bool hasRoom(const Boundary& boundary, Vec3f& p, double spacing) {
  // A lattice that fills a tank to its walls has its first layer at exactly half a spacing, give or take
  // rounding.
  const auto margin = static_cast<float>((0.5 - 1e-3) * spacing);
  const auto mostError = static_cast<float>(kMostError * spacing);
  const float distance = boundary.distance(p);
  if (!(distance < margin)) return true;
  if (distance < margin - mostError) return false;
  Vec3f ignored;
  for (const Surface* wall : boundary.near(p, margin))
    if (const float missing = margin - wall->distance(p, ignored);
        missing > 0 && missing > wall->statedError(p))
      return false;
  // In a corner that is rounded each round comes a part of the way.
  constexpr int kRounds = 16;
  Vec3f moved = p, before = p;
  for (int round = 0; round < kRounds && (round == 0 || (moved - before).norm() > 1e-4F * margin); ++round) {
    before = moved;
    boundary.project(moved, static_cast<float>(0.5 * spacing));
  }
  if (boundary.distance(moved) < margin || (moved - p).norm() > 2 * mostError) return false;
  p = moved;
  return true;
}

}  // namespace

void fillScene(Scene& scene, const Boundary& boundary, Particles& particles) {
  const double spacing = scene.particleSpacing;
  double most = 0;
  for (const auto& source : scene.fluid) most += source->count(spacing);
  requireMemory(kBytesWhileFilling * most, "particles", scene.file.string() + ":/particle_spacing");
  const SourceUnion sources(scene.fluid, spacing);
  std::vector<Filled> filled;
  std::vector<Vec3d> centers;
  for (std::size_t k = 0; k < scene.fluid.size(); ++k) {
    const FluidSource& source = *scene.fluid[k];
    centers.clear();
    sources.fill(k, centers);
    const NearPoints taken =
        placesWithin(source.bounds().grown(3 * spacing), filled, particles, kNearestOther * spacing);
    Filled own{particles.size(), 0, {}};
    std::size_t inWalls = 0, inOthers = 0;
    constexpr std::size_t kTold = 4096;
    for (const Vec3d& center : centers) {
      if (const auto done = static_cast<std::size_t>(&center - centers.data()); done % kTold == 0)
        Activity::pulse(static_cast<double>(done) / static_cast<double>(centers.size()));
      Vec3f p = center.cast<float>();
      if (source.trim && !hasRoom(boundary, p, spacing)) {
        ++inWalls;
      } else if (source.trim && anyWithin(taken, p)) {
        ++inOthers;
      } else {
        particles.position.emplace_back(p);
        particles.velocity.emplace_back(Vec3f(source.velocityAt(p.cast<double>()).cast<float>()));
        particles.id.push_back(static_cast<std::uint32_t>(particles.size()));
        own.bounds.include(p.cast<double>());
      }
    }
    own.end = particles.size();
    if (own.end > own.begin) filled.push_back(own);
    for (const std::string& remark : remarksOn(centers.size(), inWalls, inOthers, sources.remark(k)))
      scene.warnings.push_back("/fluid/" + std::to_string(k) + ": " + remark);
  }
  if (const auto layers = fewLayers(particles, scene.gravity, spacing))
    scene.warnings.push_back(
        "/particle_spacing: the fluid is " + std::to_string(*layers) + (*layers == 1 ? " layer" : " layers") +
        " of particles deep, too thin for its flow to be resolved; a particle_spacing of " +
        formatNumber("%.2g", *layers * spacing / 8) + " m makes 8 of them");
}

namespace {

/// Particles that there may ever be, those that are gone included: ids have 32 bits.
constexpr std::int64_t kMostIds = std::int64_t{1} << 32;

/// Makes room for `size` particles and some more, so that layers do not move the buffers one by one. False
/// where that memory cannot be had.
bool makeRoom(StepState& state, std::size_t size) {
  const std::size_t capacity = state.particles.id.capacity();
  if (size <= capacity) return true;
  const std::size_t room = size + size / 2 + 1024;
  if (kBytesPerParticle * static_cast<double>(room - capacity) > availableMemory()) return false;
  state.particles.position.reserve(room);
  state.particles.velocity.reserve(room);
  state.particles.id.reserve(room);
  const std::size_t withGhost = room + NeighbourLists::kScratchExtra;
  state.current.reserve(withGhost);
  state.previous.reserve(withGhost);
  state.paired.reserve(withGhost);
  if (!state.before.position.empty()) {
    state.before.position.reserve(room);
    state.before.velocity.reserve(room);
  }
  state.spareIds.reserve(room);
  state.wallSlot.reserve(room);
  state.gamma.reserve(room);
  state.density.reserve(room);
  state.lambda.reserve(room);
  return true;
}

/// Places of a mouth that are as near to a wall (in spacings) are left out, unless they look out of it.
constexpr double kLeftOut = 0.25;

/// Where a particle of a mouth begins: at its place, or ahead of one at or in a wall that the fluid comes out
/// of, where it is half a `spacing` (m) away from walls, up to a spacing ahead. Nothing where it has no room.
std::optional<Vec3d> openPlace(const Boundary& boundary, const Vec3d& place, const Vec3d& ahead,
                               double spacing) {
  const double margin = (0.5 - 1e-3) * spacing;
  constexpr int kRounds = 8;
  double first = 0, way = 0;
  for (int round = 0; round < kRounds && way <= spacing; ++round) {
    const Vec3d at = place + way * ahead;
    const auto distance = static_cast<double>(boundary.distance(at.cast<float>()));
    if (distance >= margin) return at;
    if (round == 0) first = distance;
    way += 0.5 * spacing - distance;
  }
  return first < kLeftOut * spacing ? std::nullopt : std::optional(place);
}

}  // namespace

Emission::Emission(Scene& scene, const Boundary& boundary, double most)
    : given_(scene.emitters.size()), most_(most) {
  for (std::size_t k = 0; k < scene.emitters.size(); ++k) {
    const Emitter& emitter = scene.emitters[k];
    // Also of one that begins after the duration, whose particles the reader has not counted.
    requireMemory(kBytesPerParticle * emitter.area() / (scene.particleSpacing * scene.particleSpacing),
                  "the particles of a layer", scene.file.string() + ":/emitters/" + std::to_string(k));
    MouthLayer layer = mouthLayer(emitter, scene.particleSpacing);
    const Vec3d ahead = emitter.direction.normalized();
    const std::size_t all = layer.places.size();
    const auto open = static_cast<std::size_t>(
        std::count_if(layer.places.begin(), layer.places.end(), [&](const Vec3d& place) {
          return openPlace(boundary, place, ahead, scene.particleSpacing).has_value();
        }));
    const std::string named = "/emitters/" + std::to_string(k) + ": ";
    if (open == 0)
      scene.warnings.push_back(
          named +
          "it gives nothing, for all of its mouth lies within the walls or outside of the "
          "vessel. Move its \"center\" to where fluid has room");
    else if (open < all)
      scene.warnings.push_back(named + shareOf(all - open, all) +
                               " lie within or too near the walls and are left out: it gives so much less");
    const double interval = layer.thickness / emitter.mouthSpeed();
    mouths_.push_back({emitter, std::move(layer), ahead, emitter.mouthSpeed() * ahead, interval});
  }
}

void Emission::openPlaces(const Mouth& mouth, const Boundary& boundary, double spacing) {
  open_.clear();
  for (const Vec3d& place : mouth.layer.places)
    if (const auto open = openPlace(boundary, place, mouth.ahead, spacing)) open_.push_back(*open);
}

void Emission::addLayer(const Mouth& mouth, double age, std::int64_t firstId, StepState& state) const {
  std::int64_t id = firstId;
  Particles& particles = state.particles;
  const bool slots = state.wallSlot.size() == particles.size();
  for (const Vec3d& place : open_) {
    Vec3f p = (place + age * mouth.velocity).cast<float>();
    // The step would throw out what stands in a wall, or has passed through it.
    p = clipMove(state.collisionWalls, place.cast<float>(), false, p, state.wallMargin());
    state.boundary.project(p, state.wallMargin());
    particles.position.emplace_back(p);
    particles.velocity.emplace_back(Vec3f(mouth.velocity.cast<float>()));
    particles.id.push_back(static_cast<std::uint32_t>(id++));
    if (slots) state.wallSlot.push_back(FluidState::kNoWall);
  }
}

void Emission::emit(double time, StepState& state, RunStatistics& statistics) {
  for (std::size_t k = 0; k < mouths_.size(); ++k) {
    const Mouth& mouth = mouths_[k];
    EmitterState& given = given_[k];
    while (true) {
      const double leaves = mouth.emitter.start + static_cast<double>(given.layers) * mouth.interval;
      if (leaves > time || leaves >= mouth.emitter.stop) break;
      openPlaces(mouth, state.boundary, static_cast<double>(state.spacing));
      const auto layer = static_cast<std::int64_t>(open_.size());
      if (given.particles + layer > mouth.emitter.particles) {
        statistics.note("emitter_limit", statistics.steps,
                        "/emitters/" + std::to_string(k) + " has given the " +
                            std::to_string(given.particles) + " particles that it may give");
        break;
      }
      if (static_cast<double>(state.particles.size()) + static_cast<double>(layer) > most_) {
        std::ostringstream detail;
        detail << "/emitters/" << k << " gives nothing more: with another " << layer
               << " particles there would be more than the " << most_ << " that a simulation may have";
        statistics.note("particle_limit", statistics.steps, detail.str());
        break;
      }
      if (!makeRoom(state, state.particles.size() + open_.size())) {
        statistics.note("emitter_memory", statistics.steps,
                        "/emitters/" + std::to_string(k) +
                            " gives nothing more: there is no memory left for " + std::to_string(layer) +
                            " particles beside " + std::to_string(state.particles.size()));
        break;
      }
      if (statistics.fluid.made() + layer > kMostIds) {
        statistics.note("particle_limit", statistics.steps,
                        "/emitters/" + std::to_string(k) + " gives nothing more: all " +
                            std::to_string(kMostIds) + " ids that tell particles apart are used");
        break;
      }
      addLayer(mouth, time - leaves, statistics.fluid.made(), state);
      ++given.layers;
      given.particles += layer;
      statistics.fluid.emitted += layer;
    }
  }
}

void Emission::visit(StateVisitor& visitor) {
  if (empty()) return;
  visitor.array("emitters/given", given_);
  if (given_.size() != mouths_.size())
    throw StateError("the state of " + std::to_string(mouths_.size()) + " emitters, found that of " +
                     std::to_string(given_.size()));
}

double Emission::largestSpeed(double from, double to) const {
  double speed = 0;
  for (const Mouth& mouth : mouths_)
    if (mouth.emitter.start <= to && mouth.emitter.stop > from)
      speed = std::max(speed, mouth.emitter.mouthSpeed());
  return speed;
}

void FrameSnapshot::assign(const FrameView& view) {
  info = view.info;
  positions.assign(view.positions.begin(), view.positions.end());
  velocities.assign(view.velocities.begin(), view.velocities.end());
  density.assign(view.density.begin(), view.density.end());
  gamma.assign(view.gamma.begin(), view.gamma.end());
  lambda.assign(view.lambda.begin(), view.lambda.end());
  pressure.assign(view.pressure.begin(), view.pressure.end());
  neighbours.assign(view.neighbours.begin(), view.neighbours.end());
  ids.assign(view.ids.begin(), view.ids.end());
  walls = view.walls;
  water = view.water;
}

}  // namespace migiwa
