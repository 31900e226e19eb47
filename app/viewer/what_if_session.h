// Between the "What if" panel, the simulation that runs, and the copy that tries settings in the background.
#pragma once

#include <future>
#include <memory>

#include "app/ui/what_if_panel.h"
#include "app/viewer/simulation_thread.h"
#include "core/study/what_if.h"

namespace migiwa {

class WhatIfSession {
 public:
  /// `threads` as for a Simulation.
  explicit WhatIfSession(int threads) : threads_(threads) {}

  /// Begins what the panel asks for and takes in what is done; returns whether something is new to be seen.
  /// The simulation waits meanwhile, so that the times are those of a machine that does nothing else, and
  /// then plays on if it did, unless it was paused in between.
  bool poll(WhatIfModel& model, SimulationThread& simulation, const Settings& now);
  /// Forgets what was tried, and lets the simulation go: another scene takes its place. What is under way is
  /// dropped when it is done.
  void forget(WhatIfModel& model, SimulationThread& simulation);
  /// Waits for what is under way.
  void wait() const;

 private:
  /// What lasts from one question to the next: the copy, whose walls take long to prepare, and the moment
  /// that all points are of.
  struct Outcome {
    std::shared_ptr<WhatIf> copy;
    std::shared_ptr<const StateImage> moment;
    double time = 0;  ///< of the moment (s)
    std::vector<WhatIfPoint> points;
    std::string fault;
  };
  void begin(WhatIfModel& model, SimulationThread& simulation, const Settings& now);

  int threads_;
  std::shared_ptr<WhatIf> copy_;
  std::shared_ptr<const StateImage> moment_;  ///< none: the next question is of that of now
  std::future<Outcome> asking_;
  bool dropped_ = false;
  bool holds_ = false;  ///< the simulation waits
};

}  // namespace migiwa
