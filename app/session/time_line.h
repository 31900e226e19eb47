// The past of a run in memory: states to go back to, and the branches that other settings have made of it.
// Between two states a time is reached by stepping again, which gives the same bits. No window, no OpenGL.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session/ui_state.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "core/simulation/statistics.h"

namespace migiwa {

/// Where settings differ, as changesBetween() says it of two scenes; empty: nowhere.
std::vector<std::string> changesBetween(const Settings& before, const Settings& now);

class Meter {
 public:
  explicit Meter(const Scene& scene);

  /// height: twice that of the centre of mass above the lowest place of the scene, which is the level of
  /// water at rest in an upright tank (m). front: how far the farthest fluid has come along the longest level
  /// side of the scene, from the end where the fluid began (m). The others are those of the last step.
  MeasureSample read(const Simulation& simulation) const;

 private:
  Vec3d up_ = Vec3d::UnitY(), along_ = Vec3d::UnitX();
  double floor_ = 0, end_ = 0;  ///< where height and front are zero (m)
  double halfSpacing_;          ///< (m)
};

/// Samples of one run, thinned where they are many.
class Trace {
 public:
  void add(const MeasureSample& sample);
  /// With the last sample; the same object until another is added.
  MeasureSamples samples() const;

 private:
  static constexpr std::size_t kMost = 1024;

  std::vector<MeasureSample> history_;
  Thinning thinning_{kMost};
  MeasureSample last_;
  mutable MeasureSamples shown_;
};

class TimeLine {
 public:
  /// States are kept this far apart, or this many frames, whichever comes first.
  static constexpr double kInterval = 0.1;  // (s)
  static constexpr long kMostFrames = 8;
  static constexpr std::size_t kLimit = std::size_t{512} << 20U;
  /// Branches that there may be; beyond that the oldest go, but for the first and the one that runs.
  static constexpr std::size_t kMostBranches = 12;

  /// `limit`: bytes that states may take. The start of the first branch and that of the present one are kept
  /// whatever they take.
  explicit TimeLine(std::size_t limit = kLimit) : limit_(limit) {}

  // Where memory runs out, no branch is begun, and those that there are have their first states.

  /// Forgets everything: the run begins with the state of now.
  void begin(Simulation& simulation);
  /// The simulation has reached another frame of the present branch.
  void reached(Simulation& simulation);
  /// The settings were `before`, and have been changed between two frames. At the end of a branch it goes on
  /// with them; at an earlier frame another branch begins.
  void changed(Simulation& simulation, const Settings& before);

  /// Settings that the present branch has from this frame on; nothing: those of the frame before.
  const Settings* changeAt(long frame) const;
  bool hasBranch(int branch) const { return branches_.contains(branch); }
  long firstFrame(int branch) const { return branches_.at(branch).first; }
  long lastFrame(int branch) const { return branches_.at(branch).last; }
  /// The frame of a branch that is nearest to a time (s).
  long frameAt(int branch, double time) const;
  /// The branch from which this one went; nothing: the run began with it, or that one is no longer kept.
  std::optional<int> parent(int branch) const;
  int branch() const { return branch_; }

  /// Where to step from: the last state at or before a place.
  struct Origin {
    std::shared_ptr<const StateImage> image;
    Settings settings;  ///< in force before that frame's own change
    long frame = 0;
  };
  Origin origin(int branch, std::optional<long> frame, double time) const;
  /// The branch that the simulation is on from now on.
  void goOn(int branch) { branch_ = branch; }

  TimeLineView view(const Simulation& simulation) const;

 private:
  struct Moment {
    double time;  ///< (s)
    std::shared_ptr<const StateImage> image;
    std::size_t bytes;
  };
  struct Branch {
    std::string name;
    int parent = 0;
    long first = 0, last = 0;  ///< frames
    double end = 0;            ///< time of the last one (s)
    Settings settings;         ///< with which it came to its first frame
    std::map<long, TimeLineView::Change> changes;
    std::map<long, Moment> moments;  ///< the first frame's is always there
    Trace trace;
  };

  static Moment momentOf(Simulation& simulation);
  void tellHistory(const Simulation& simulation, TimeLineView& view) const;
  Branch branchFrom(Simulation& simulation, std::string name, int parent, const Settings& settings);
  void fitLimit();
  bool thin();
  bool dropBranch();
  void erase(Branch& branch, std::map<long, Moment>::iterator moment);

  std::size_t limit_, bytes_ = 0;
  std::optional<Meter> meter_;  ///< of the scene that was begun with
  int branch_ = 0, newest_ = 0;
  std::map<int, Branch> branches_;  ///< by number, from 1 in the order in which they began
};

}  // namespace migiwa
