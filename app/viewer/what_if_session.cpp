#include "app/viewer/what_if_session.h"

#include <chrono>
#include <exception>
#include <utility>

#include "app/ui/number_text.h"
#include "core/boundary/handling.h"

namespace migiwa {
namespace {

std::string labelOf(const Settings& settings, const WhatIfAnswer& answer) {
  return answer.handling + ", at most " + std::to_string(settings.solver.maxIterations) + " iterations, " +
         formatNumber("tolerance %g", settings.solver.tolerance);
}

WhatIfPoint pointOf(const Settings& settings, const WhatIfAnswer& answer) {
  WhatIfPoint point;
  point.label = labelOf(settings, answer);
  point.milliseconds = 1e3 * answer.stepSeconds;
  point.iterations = answer.iterations;
  point.densityError = answer.errors.densityMean;
  point.gammaError = answer.errors.gammaMean;
  point.trouble = answer.trouble;
  return point;
}

}  // namespace

void WhatIfSession::begin(WhatIfModel& model, SimulationThread& simulation, const Settings& now) {
  simulation.hold("\"What if\" measures");
  holds_ = true;
  std::vector<Settings> settings;
  if (model.points.empty()) settings.push_back(now);
  if (!model.points.empty() || !model.follows) settings.push_back(model.asked);
  model.busy = true;
  model.note = "measuring five frames on a copy; the run waits";
  std::future<StateImage> state;
  if (moment_ == nullptr) state = simulation.capture();
  asking_ =
      std::async(std::launch::async, [state = std::move(state), copy = copy_, moment = moment_,
                                      threads = threads_, scene = simulation.scene(), settings]() mutable {
        Outcome outcome;
        try {
          if (moment == nullptr) moment = std::make_shared<const StateImage>(state.get());
          if (copy == nullptr) copy = std::make_shared<WhatIf>(scene, threads);
          for (const Settings& tried : settings) {
            const WhatIfAnswer answer = copy->ask(*moment, tried);
            outcome.points.push_back(pointOf(tried, answer));
            outcome.time = answer.time;
          }
          outcome.copy = std::move(copy);
        } catch (const std::exception& error) {
          outcome.fault = error.what();
        }
        outcome.moment = std::move(moment);  // also that of points before one that was refused
        return outcome;
      });
}

bool WhatIfSession::poll(WhatIfModel& model, SimulationThread& simulation, const Settings& now) {
  if (std::exchange(model.clear, false) && !asking_.valid()) {
    model.points.clear();
    model.follows = true;
    model.note.clear();
    moment_.reset();
  }
  if (std::exchange(model.ask, false) && !asking_.valid()) {
    begin(model, simulation, now);
    return true;
  }
  if (!asking_.valid() || asking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return false;
  Outcome outcome = asking_.get();
  model.busy = false;
  if (std::exchange(holds_, false)) simulation.release();
  if (std::exchange(dropped_, false)) return true;
  copy_ = std::move(outcome.copy);
  moment_ = std::move(outcome.moment);
  model.note =
      !outcome.fault.empty() ? outcome.fault : "Five frames on from " + formatNumber("%.3f s", outcome.time);
  for (WhatIfPoint& point : outcome.points) model.points.push_back(std::move(point));
  return true;
}

void WhatIfSession::forget(WhatIfModel& model, SimulationThread& simulation) {
  if (std::exchange(holds_, false)) simulation.release();
  model.points.clear();
  model.note.clear();
  model.follows = true;
  copy_.reset();
  moment_.reset();
  dropped_ = asking_.valid();
}

void WhatIfSession::wait() const {
  if (asking_.valid()) asking_.wait();
}

}  // namespace migiwa
