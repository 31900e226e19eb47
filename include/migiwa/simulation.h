// Simulations: made from a scene, advanced frame by frame, looked at, saved and resumed.
//
//   Simulation with its Settings, FrameView and FrameSnapshot; runUntil with a SettledSampler; writeSave and
//   readSave; particle files by ParticleExport; hexDigits for hashes.
#pragma once

#include "core/io/particle_export.h"
#include "core/io/save_file.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"
