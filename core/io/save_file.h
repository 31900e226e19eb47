// A simulation on disk, so that another process can go on with it as if nothing had happened.
//
// The file: a fixed head (what it is, format version, order of bytes, lengths, checksum), a JSON header (the
// scene's identity, time, particles, hash, single values, and a list of the arrays with their names), then
// the arrays, one after another. A name that only the file or only the program knows is an error, so whoever
// adds a state of its own (StateVisitor) need not change the format.
#pragma once

#include <filesystem>
#include <vector>

#include "core/scene/scene_file.h"
#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"

namespace migiwa {

/// Writes the simulation, and what was sampled of it for the report, in one atomic move. `overrides` are
/// those that the scene was read with; they are kept for people to look at. Throws InputError when that
/// fails; an older file of that name then stays.
void writeSave(const std::filesystem::path& file, Simulation& simulation, SettledSampler& sampler,
               const std::vector<Override>& overrides);

/// Goes on from a save: `simulation` is a fresh one of the same scene. Throws InputError with every fault
/// found, such as each setting that differs; the simulation is then of no further use.
void readSave(const std::filesystem::path& file, Simulation& simulation, SettledSampler& sampler);

}  // namespace migiwa
