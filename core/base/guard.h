// The guards: mechanisms that keep hard cases stable, act in those alone, and leave every other run as it is
// to the last bit. Each asks for kGuards where it would act, so that one definition gives the same program
// without them, for tests/hard_cases to compare with:
//   where fluid starts in walls or on top of fluid, and where a step leaves it so, it is moved apart without
//   gaining speed (core/simulation/simulation.cpp);
//   a move may not pass through thin or moving walls (same);
//   heaps of many particles are spread before their pairs are listed (core/solver/spread_heaps.cpp);
//   a wall that stands still gives no speed (core/solver/projection_stage.cpp);
//   what a step adds to the energy from nothing is taken back (core/solver/hold_energy.h);
//   a step that ends with what is not finite is refused (core/solver/pbf_solver.cpp);
//   one that walls leave no solution is refused (core/solver/squeeze.h, same);
//   gamma has a floor (core/solver/gamma_stage.cpp);
//   pairs on one point get a direction (core/solver/pair_vectors-inl.h).
// Not here: projection onto the walls' fluid side and the clamp of the density constraint, which act in every
// step and belong to the method, and the CFL rule, which a scene has and sets by solver.cfl.
#pragma once

namespace migiwa {

#ifdef MIGIWA_WITHOUT_GUARDS
inline constexpr bool kGuards = false;
#else
inline constexpr bool kGuards = true;
#endif

}  // namespace migiwa
