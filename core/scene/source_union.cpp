// Sources that are filled together: upright boxes that touch go on with one lattice.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include "core/scene/sources.h"

namespace migiwa {

namespace {

/// Lengths below this are not worth a word, in cells.
constexpr double kSaid = 1e-3;

std::string shown(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

/// "0.02 m along x and 0.03 m along y" of the lengths that are worth saying; empty where none is.
std::string alongAxes(const Vec3d& lengths, double least) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (lengths[axis] < least) continue;
    if (!text.empty()) text += " and ";
    text += shown(lengths[axis]) + " m along " + "xyz"[axis];
  }
  return text;
}

/// Whether two boxes share some extent in the plane across an axis.
bool faceEachOther(const Bounds& a, const Bounds& b, int axis, double tolerance) {
  for (const int across : {(axis + 1) % 3, (axis + 2) % 3})
    if (std::min(a.max[across], b.max[across]) - std::max(a.min[across], b.min[across]) <= tolerance)
      return false;
  return true;
}

}  // namespace

double wholeCells(double length, double spacing) {
  return std::floor(length / spacing + kCellTolerance);
}

SourceUnion::SourceUnion(std::vector<std::shared_ptr<const FluidSource>> sources, double spacing)
    : sources_(std::move(sources)), spacing_(spacing) {
  for (const auto& source : sources_) {
    // What is not trimmed to others does not go by their lattices either.
    blocks_.push_back(source->trim ? source->block() : Bounds{});
    starts_.push_back(blocks_.back().empty() ? Vec3d(Vec3d::Zero()) : blocks_.back().min);
  }
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (!blocks_[k].empty()) order.push_back(k);
  for (int axis = 0; axis < 3; ++axis) {
    // One that a box goes on from begins before it.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return blocks_[a].min[axis] < blocks_[b].min[axis];
    });
    for (const std::size_t k : order) starts_[k][axis] = startAlong(axis, k);
  }
}

double SourceUnion::startAlong(int axis, std::size_t source) const {
  const double tolerance = kCellTolerance * spacing_;
  const Bounds& box = blocks_[source];
  const double own = box.min[axis];
  bool found = false;
  double start = own - spacing_;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Bounds& other = blocks_[k];
    if (k == source || other.empty() || other.min[axis] >= own - tolerance ||
        other.max[axis] < own - tolerance || !faceEachOther(box, other, axis, tolerance))
      continue;
    const double from = starts_[k][axis];
    start = std::max(start, from + spacing_ * wholeCells(own - from, spacing_));
    found = true;
  }
  return found && start < own - tolerance ? start : own;
}

bool SourceUnion::anyHolds(const Vec3d& p, std::size_t except) const {
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (k != except && blocks_[k].contains(p)) return true;
  return false;
}

void SourceUnion::fill(std::size_t source, std::vector<Vec3d>& out) const {
  const Bounds& box = blocks_[source];
  if (box.empty()) {
    sources_[source]->fill(spacing_, out);
    return;
  }
  const Vec3d& start = starts_[source];
  std::array<std::int64_t, 3> n{};
  std::array<bool, 3> before{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    n[at] = static_cast<std::int64_t>(wholeCells(box.max[axis] - start[axis], spacing_));
    before[at] = start[axis] < box.min[axis];
  }
  const double below = kSaid * spacing_;
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i) {
        const Vec3d center =
            start + spacing_ * (Eigen::Array3d(double(i), double(j), double(k)) + 0.5).matrix();
        const std::array<std::int64_t, 3> cell{i, j, k};
        bool supported = true;
        for (int axis = 0; axis < 3 && supported; ++axis) {
          const auto at = static_cast<std::size_t>(axis);
          if (!before[at] || cell[at] != 0) continue;
          Vec3d beneath = center.cwiseMax(box.min + Vec3d::Constant(below));
          beneath[axis] = box.min[axis] - below;
          supported = anyHolds(beneath, source);
        }
        if (supported) out.push_back(center);
      }
}

std::string SourceUnion::remark(std::size_t source) const {
  const Bounds& box = blocks_[source];
  const double least = kSaid * spacing_;
  if (box.empty()) {
    const std::string left = alongAxes(sources_[source]->leftOver(spacing_), least);
    return left.empty() ? left
                        : "no whole cell has room in the last " + left +
                              ", which stay empty: its lengths are no multiples of particle_spacing";
  }
  const Vec3d added = box.min - starts_[source];
  Vec3d left;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box.max[axis] - starts_[source][axis];
    left[axis] = std::max(0.0, length - spacing_ * wholeCells(length, spacing_));
  }
  const std::string more = alongAxes(added, least), less = alongAxes(left, least);
  if (more.empty() && less.empty()) return {};
  std::string text;
  const double share = ((box.size() + added - left).array() / box.size().array()).prod() - 1;
  if (std::abs(share) >= 5e-4)
    text =
        shown(100 * std::abs(share)) + " % of its volume " + (share < 0 ? "stay empty" : "are added") + ": ";
  if (!more.empty()) text += "it begins " + more + " before min, to go on from the box that it touches";
  if (!less.empty())
    text += (more.empty() ? "" : ", and ends ") + less +
            " before max, because no box is filled beyond it and no whole cell has room there";
  return text + "; lengths that are multiples of particle_spacing are filled exactly";
}

}  // namespace migiwa
