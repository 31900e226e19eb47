// The simulation's thread on its way to another time: back to a state that is kept, and on from there, frame
// by frame, until it is there or another time is asked for.
#include <algorithm>
#include <utility>

#include "app/session/session.h"

namespace migiwa {

void SimulationThread::goTo(int branch, double time) {
  ask("Going to another time", [=](const Goal&) { return Goal{branch, std::nullopt, time}; });
}

void SimulationThread::stepBack() {
  // From where it is going, so that no press of a key is lost.
  ask("Step back", [](const Goal& from) {
    Goal goal = from;
    ++goal.back;
    return goal;
  });
}

template <class Change>
void SimulationThread::ask(const char* request, const Change& change) {
  const std::lock_guard lock(mutex_);
  if (refuses(request, false)) return;
  const std::optional<Goal>& going = goal_ ? goal_ : travel_;
  if (!going) sooner_ = reset_ || load_ || settings_ || save_ || !captures_.empty();
  goal_ = change(going.value_or(Goal{status_.line.branch, status_.line.frame, status_.line.time}));
  status_.playing = false;
  steps_ = 0;
  wake_.notify_one();
}

/// Begins the way to what was last asked for. What another way has not reached yet is dropped.
void SimulationThread::depart(std::unique_lock<std::mutex>& lock) {
  Goal goal = *std::exchange(goal_, std::nullopt);
  sooner_ = false;
  if (!line_.hasBranch(goal.branch)) goal.branch = line_.branch();
  if (const long back = std::exchange(goal.back, 0); back > 0)
    goal.frame = (goal.frame ? *goal.frame : line_.frameAt(goal.branch, goal.time)) - back;
  // Before its first frame a branch is what it went from, which may have begun at that frame, too.
  while (goal.frame && *goal.frame < line_.firstFrame(goal.branch)) {
    const std::optional<int> parent = line_.parent(goal.branch);
    if (!parent) break;
    goal.branch = *parent;
  }
  if (goal.frame)
    goal.frame = std::clamp(*goal.frame, line_.firstFrame(goal.branch), line_.lastFrame(goal.branch));
  const TimeLine::Origin origin = line_.origin(goal.branch, goal.frame, goal.time);
  const long now = simulation_->frame();
  const bool later = goal.frame ? *goal.frame < now : goal.time < simulation_->time();
  // Where it has thrown, it is between two frames.
  const bool good = !status_.stopped && !simulation_->stopped();
  const bool onTheWay = good && goal.branch == line_.branch() && now >= origin.frame && !later;
  travel_ = goal;
  lock.unlock();
  if (!onTheWay) {
    simulation_->apply(origin.settings);
    origin.image->restore(*simulation_);
    line_.goOn(goal.branch);
    if (const Settings* changed = line_.changeAt(simulation_->frame())) simulation_->apply(*changed);
  }
  lock.lock();
  begin();
  if (onTheWay) return;
  settle();
  publish(lock);  // what is nearest, while it goes on
}

bool SimulationThread::arrived(const Goal& goal) const {
  const long now = simulation_->frame();
  if (simulation_->stopped() || now >= line_.lastFrame(line_.branch())) return true;
  if (goal.frame) return now >= *goal.frame;
  return simulation_->time() + 0.5 * simulation_->settings().solver.timeStep > goal.time;
}

void SimulationThread::travelOn(std::unique_lock<std::mutex>& lock) {
  if (!arrived(*travel_)) {
    const bool watchPressure = watchPressure_;
    lock.unlock();
    advanceFrame(watchPressure);
    lock.lock();
  }
  if (!arrived(*travel_)) return;
  travel_.reset();
  settle();
  publish(lock);
}

/// Along the present branch, with the settings that it has from then on. Without the lock.
void SimulationThread::advanceFrame(bool watchPressure) {
  simulation_->watchPressure(watchPressure);
  simulation_->advanceFrame();
  line_.reached(*simulation_);
  if (const Settings* changed = line_.changeAt(simulation_->frame())) {
    simulation_->apply(*changed);
    const std::lock_guard lock(mutex_);
    settle();
  }
}

}  // namespace migiwa
