// What `migiwa simulate` was asked for, looked at and understood before anything is simulated or written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "core/io/particle_format.h"
#include "core/scene/scene.h"

namespace migiwa {

struct SimulateOptions {
  std::string scene;
  std::optional<double> until;  ///< (s)
  std::string report;
  std::string exportFolder, format, fields;
  std::optional<double> every;  ///< (s)
  std::string save, resume;
  std::optional<double> saveEvery;  ///< (s)
};

struct SimulateJob {
  Scene scene;
  ParticleFormat format;            ///< of the export, if there is one
  std::vector<std::string> fields;  ///< of the export
};

/// Throws InputError with every fault found.
SimulateJob checkedSimulateJob(const SimulateOptions& options, const CommonOptions& common);

}  // namespace migiwa
