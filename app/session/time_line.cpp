#include "app/session/time_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace {

/// A scene of nothing but settings.
Scene sceneOf(const Settings& settings) {
  Scene result;
  result.solver = settings.solver;
  result.boundary = settings.boundary;
  result.effects = settings.effects;
  return result;
}

/// What the settings were changed to, such as "/solver/tolerance=0.01".
std::string nameOf(const Simulation& simulation, const Settings& before) {
  const std::vector<std::string> changes = changesBetween(before, simulation.settings());
  if (changes.empty()) return "the same settings";
  if (changes.size() == 1) return changes.front();
  return changes.front() + " and " + std::to_string(changes.size() - 1) + " more";
}

}  // namespace

std::vector<std::string> changesBetween(const Settings& before, const Settings& now) {
  return changesBetween(sceneOf(before), sceneOf(now));
}

void TimeLine::begin(Simulation& simulation) {
  meter_.emplace(simulation.scene());
  std::map<int, Branch> branches;
  const auto run = branches.emplace(1, branchFrom(simulation, "run", 0, simulation.settings())).first;
  bytes_ = run->second.moments.begin()->second.bytes;
  newest_ = branch_ = 1;
  branches_.swap(branches);
}

void TimeLine::reached(Simulation& simulation) {
  Branch& branch = branches_.at(branch_);
  const long frame = simulation.frame();
  if (frame <= branch.last || simulation.stopped()) return;
  branch.last = frame;
  branch.end = simulation.time();
  branch.trace.add(meter_->read(simulation));
  const auto& [kept, moment] = *branch.moments.rbegin();
  // Times are sums of time steps, and not exact.
  if (frame - kept < kMostFrames && branch.end - moment.time < kInterval * (1 - 1e-6)) return;
  bytes_ += branch.moments.emplace(frame, momentOf(simulation)).first->second.bytes;
  fitLimit();
}

void TimeLine::changed(Simulation& simulation, const Settings& before) {
  const long frame = simulation.frame();
  Branch& branch = branches_.at(branch_);
  if (frame < branch.last) {
    Branch begun = branchFrom(simulation, nameOf(simulation, before), branch_, before);
    begun.changes[frame] = {simulation.time(), simulation.settings()};
    const std::size_t bytes = begun.moments.begin()->second.bytes;
    branches_.emplace(newest_ + 1, std::move(begun));
    // From here on nothing fails.
    branch_ = ++newest_;
    bytes_ += bytes;
    while (branches_.size() > kMostBranches && dropBranch()) {
    }
    fitLimit();
    return;
  }
  if (frame == branch.first && branch.parent != 0) branch.name = nameOf(simulation, branch.settings);
  branch.changes[frame] = {simulation.time(), simulation.settings()};
}

const Settings* TimeLine::changeAt(long frame) const {
  const auto& changes = branches_.at(branch_).changes;
  const auto found = changes.find(frame);
  return found == changes.end() ? nullptr : &found->second.settings;
}

std::optional<int> TimeLine::parent(int branch) const {
  const int parent = branches_.at(branch).parent;
  return branches_.contains(parent) ? std::optional(parent) : std::nullopt;
}

TimeLine::Origin TimeLine::origin(int branch, std::optional<long> frame, double time) const {
  const Branch& from = branches_.at(branch);
  auto moment = from.moments.begin();
  for (auto next = std::next(moment); next != from.moments.end(); ++next) {
    if (frame ? next->first > *frame : next->second.time > time) break;
    moment = next;
  }
  const Settings* settings = &from.settings;
  for (const auto& [at, changed] : from.changes)
    if (at < moment->first) settings = &changed.settings;
  return {moment->second.image, *settings, moment->first};
}

long TimeLine::frameAt(int branch, double time) const {
  const Branch& in = branches_.at(branch);
  const Origin from = origin(branch, std::nullopt, time);
  long frame = from.frame;
  double now = in.moments.at(frame).time, step = from.settings.solver.timeStep;
  for (; frame < in.last; ++frame) {
    if (const auto changed = in.changes.find(frame); changed != in.changes.end())
      step = changed->second.settings.solver.timeStep;
    if (now + 0.5 * step > time) break;
    now += step;
  }
  return frame;
}

TimeLineView TimeLine::view(const Simulation& simulation) const {
  TimeLineView view;
  view.branch = branch_;
  view.frame = simulation.frame();
  view.time = simulation.time();
  view.bytes = bytes_;
  tellHistory(simulation, view);
  for (const auto& [number, branch] : branches_) {
    TimeLineView::Branch& shown = view.branches.emplace_back();
    shown.number = number;
    shown.name = branch.name;
    shown.from = branch.moments.begin()->second.time;
    shown.until = branch.end;
    for (const auto& [frame, moment] : branch.moments) shown.kept.push_back(moment.time);
    shown.trace = branch.trace.samples();
  }
  return view;
}

/// From the present branch back to the run's start.
void TimeLine::tellHistory(const Simulation& simulation, TimeLineView& view) const {
  long until = simulation.frame();  // a change at this frame counts
  std::vector<TimeLineView::Change> latestFirst;
  const Branch* branch = &branches_.at(branch_);
  while (true) {
    for (auto change = branch->changes.rbegin(); change != branch->changes.rend(); ++change)
      if (change->first <= until) latestFirst.push_back(change->second);
    const auto parent = branches_.find(branch->parent);
    if (parent == branches_.end()) break;
    until = branch->first - 1;
    branch = &parent->second;
  }
  view.historyIsWhole = branch->parent == 0 && branch->first == 0;
  view.history.push_back({branch->moments.begin()->second.time, branch->settings});
  view.history.insert(view.history.end(), latestFirst.rbegin(), latestFirst.rend());
}

TimeLine::Moment TimeLine::momentOf(Simulation& simulation) {
  auto image = std::make_shared<const StateImage>(StateImage::of(simulation));
  const std::size_t bytes = image->bytes();
  return {simulation.time(), std::move(image), bytes};
}

/// With its first moment, so that a branch is never without one.
TimeLine::Branch TimeLine::branchFrom(Simulation& simulation, std::string name, int parent,
                                      const Settings& settings) {
  const long frame = simulation.frame();
  Branch branch{std::move(name), parent, frame, frame, simulation.time(), settings, {}, {}, {}};
  branch.moments.emplace(frame, momentOf(simulation));
  branch.trace.add(meter_->read(simulation));
  return branch;
}

void TimeLine::fitLimit() {
  while (bytes_ > limit_ && (thin() || dropBranch())) {
  }
}

/// Takes out the state that leaves the smallest gap, of several the oldest. False where only first ones are
/// left.
bool TimeLine::thin() {
  double smallest = std::numeric_limits<double>::infinity();
  Branch* owner = nullptr;
  std::map<long, Moment>::iterator least;
  for (auto& [number, branch] : branches_) {
    for (auto moment = std::next(branch.moments.begin()); moment != branch.moments.end(); ++moment) {
      const auto next = std::next(moment);
      const double until = next == branch.moments.end() ? branch.end + kInterval : next->second.time;
      const double gap = until - std::prev(moment)->second.time;
      if (gap >= smallest * (1 - 1e-6)) continue;
      smallest = gap;
      owner = &branch;
      least = moment;
    }
  }
  if (owner != nullptr) erase(*owner, least);
  return owner != nullptr;
}

/// The oldest that is neither the first nor the present one.
bool TimeLine::dropBranch() {
  for (auto branch = std::next(branches_.begin()); branch != branches_.end(); ++branch) {
    if (branch->first == branch_) continue;
    while (!branch->second.moments.empty()) erase(branch->second, branch->second.moments.begin());
    branches_.erase(branch);
    return true;
  }
  return false;
}

void TimeLine::erase(Branch& branch, std::map<long, Moment>::iterator moment) {
  bytes_ -= moment->second.bytes;
  branch.moments.erase(moment);
}

namespace {

/// The axis along which the scene is longest, of those that are level.
Vec3d longestLevel(const Bounds& bounds, const Vec3d& up) {
  Eigen::Index steepest = 0;
  up.cwiseAbs().maxCoeff(&steepest);
  Vec3d size = bounds.empty() || !bounds.size().allFinite() ? Vec3d::Ones() : bounds.size();
  size[steepest] = -1;
  Eigen::Index longest = 0;
  size.maxCoeff(&longest);
  return Vec3d::Unit(longest);
}

/// The least of direction . x within the bounds; 0 where they have no end.
double leastAlong(const Vec3d& direction, const Bounds& bounds) {
  const double least =
      bounds.empty() ? 0 : direction.dot(bounds.center()) - 0.5 * direction.cwiseAbs().dot(bounds.size());
  return std::isfinite(least) ? least : 0;
}

}  // namespace

Meter::Meter(const Scene& scene) : halfSpacing_(0.5 * scene.particleSpacing) {
  const Bounds bounds = scene.bounds();
  if (scene.gravity.norm() > 0) up_ = -scene.gravity.normalized();
  along_ = longestLevel(bounds, up_);
  Bounds fluid;
  for (const auto& source : scene.fluid) fluid.include(source->bounds());
  if (!bounds.empty() && !fluid.empty() && along_.dot(fluid.center() - bounds.center()) > 0) along_ = -along_;
  floor_ = leastAlong(up_, bounds);
  end_ = leastAlong(along_, bounds);
}

MeasureSample Meter::read(const Simulation& simulation) const {
  const FrameView view = simulation.view();
  MeasureSample sample;
  sample.time = simulation.time();
  sample.values.fill(std::numeric_limits<float>::quiet_NaN());
  const auto put = [&sample](RunMeasure measure, double value) {
    sample.values[static_cast<std::size_t>(measure)] = static_cast<float>(value);
  };
  double sum = 0, farthest = -std::numeric_limits<double>::infinity();
  for (const Float4& p : view.positions) {
    const Vec3d place = p.xyz().cast<double>();
    sum += up_.dot(place);
    farthest = std::max(farthest, along_.dot(place));
  }
  if (!view.positions.empty()) {
    put(RunMeasure::height, 2 * (sum / static_cast<double>(view.positions.size()) - floor_));
    put(RunMeasure::front, farthest + halfSpacing_ - end_);
  }
  if (view.info.steps == 0) return sample;
  if (!view.info.errors.empty()) put(RunMeasure::densityError, 100 * view.info.errors.back().mean);
  put(RunMeasure::iterations, view.info.iterations);
  put(RunMeasure::milliseconds, 1e3 * view.info.stepSeconds);
  return sample;
}

void Trace::add(const MeasureSample& sample) {
  last_ = sample;
  thinning_.add(history_, sample);
  shown_.reset();
}

MeasureSamples Trace::samples() const {
  if (shown_ != nullptr) return shown_;
  auto all = std::make_shared<std::vector<MeasureSample>>(history_);
  if (!all->empty() && all->back().time < last_.time) all->push_back(last_);
  shown_ = std::move(all);
  return shown_;
}

}  // namespace migiwa
