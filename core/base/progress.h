// How far something is that takes long before the first step: fits, grids, filling. Whoever does it names it;
// who wants to know watches, on the same thread. Costs nothing where nobody does.
#pragma once

#include <string>
#include <string_view>

namespace migiwa {

/// Told of what the thread is doing that made its ProgressScope.
class ProgressObserver {
 public:
  virtual ~ProgressObserver() = default;
  /// `what` is being done, such as "fitting 2000 points"; of that `part`, from 0 to 1, as far as that is
  /// known: of several passes each counts for itself. Called often, from the start of an activity on.
  virtual void reached(std::string_view what, double part) = 0;
  /// The outermost activity has ended.
  virtual void ended() = 0;
};

/// Has `observer` told of the activities of this thread while it lives.
class ProgressScope {
 public:
  explicit ProgressScope(ProgressObserver& observer);
  ~ProgressScope();
  ProgressScope(const ProgressScope&) = delete;
  ProgressScope& operator=(const ProgressScope&) = delete;

 private:
  ProgressObserver* before_;
};

/// Something that may take long, from its making to its end. One within another is shown instead of it.
class Activity {
 public:
  explicit Activity(std::string what);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// So much of it, from 0 to 1, is done.
  void reach(double part);
  /// The thread is in a loop of which `part` is done. Where the activity says itself how far it is, that
  /// counts.
  static void pulse(double part);
  /// Whether anybody wants to know.
  static bool watched();

 private:
  const std::string what_;
  Activity* const outer_;
  double part_ = -1;  ///< negative: it does not say
};

}  // namespace migiwa
