// Particles that were selected: how a field is spread over them, and their table. No window, no OpenGL.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/session/ui_state.h"
#include "core/simulation/frame_view.h"

namespace migiwa {

/// Such as "m/s"; "1" for ratios and counts.
std::string_view unitOf(ParticleValue field);
/// Places in the frame of the particles that are selected, of all where none are.
std::vector<std::size_t> selectedIn(const FrameView& frame, std::span<const std::uint32_t> ids);
/// The field's value for one particle of the frame; `origin` is what positions are relative to (m). Not a
/// number where the frame has no pressures.
double fieldValue(const FrameView& frame, std::size_t particle, ParticleValue field, const Vec3d& origin);
/// Of values that are finite; count 0: there are none.
FieldSpread spreadOf(std::span<const double> values);
/// A row for each particle, in the order of their ids, under `id` and `NAME (UNIT)` for every field that the
/// frame has. Numbers read back as they are.
std::string particlesCsv(const FrameView& frame, std::span<const std::uint32_t> ids, const Vec3d& origin);

}  // namespace migiwa
