// The README of this folder, written by measuring.
#include <iomanip>
#include <sstream>

#include "tests/hard_cases/hard_case.h"
#include "tests/hard_cases/without_guards.h"

namespace migiwa::testing {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "–" : text;
}

/// What was measured, and the bound after it.
std::string within(double value, double bound) {
  std::ostringstream text;
  text << std::setprecision(2) << value << " ≤ " << bound;
  return text.str();
}

std::vector<std::string> guardsOf(const Observed& seen) {
  std::vector<std::string> guards = seen.guards;
  if (seen.divided) guards.emplace_back("substeps");
  return guards;
}

std::string rowOf(const HardCase& hardCase) {
  const Observed seen = observe(sceneOf(hardCase), hardCase.until, 1);
  const std::vector<std::string> faults = violations(hardCase, seen);
  std::ostringstream row;
  row << std::setprecision(3) << "| [" << hardCase.name << "](../../scenes/hard/" << hardCase.scene
      << ".json) | " << seen.particles << " | " << seen.steps << " | "
      << within(seen.energyGain, seen.energyBound) << " | " << within(seen.maxSpeed, hardCase.speed) << " | "
      << within(seen.meanError, hardCase.meanError) << " | " << within(seen.worstError, hardCase.worstError)
      << " | ";
  if (hardCase.rmsSpeed >= 0) {
    row << within(seen.rmsSpeed, hardCase.rmsSpeed);
  } else {
    row << std::setprecision(2) << seen.rmsSpeed;
  }
  row << std::setprecision(1) << " ± " << seen.rmsSpread << std::setprecision(3);
  row << " | " << seen.penetration << " | " << seen.lost << " | " << joined(guardsOf(seen)) << " | "
      << withoutGuards(hardCase, seen.hash) << " | "
      << (faults.empty() ? "holds" : "**" + joined(faults) + "**") << " |\n";
  return row.str();
}

constexpr const char* kHeader = R"(# Hard cases

Scenes that break particle fluids, and what mechanics expects of each. They are in [scenes/hard](../../scenes/hard): open one
with `migiwa view scenes/hard/NAME.json`. `./run test` runs them all; `./run hard` writes this file anew.

- **Energy** is the most that kinetic and potential energy ever were above the start's at the end of a frame, over the mass
  (J/kg), as the test adds them up from positions and velocities; only what moving walls give is the program's word. Nothing
  else gives any, so that it may rise by what is stored in fluid that starts too dense: with the
  density errors C of the start, (C h/dt)² over the sum of squared gradients of the resting lattice is the kinetic energy of
  undoing them in one step (an estimate within a factor of two, which the bound has), and the largest of them times g H/2 is
  what water of the height H lifts itself by. Further (g dt)²/2, which a particle that touches a wall may gain, and rounding.
  The program's own balance may be off from that by rounding, and where steps change their length by half a step's fall.
- **Speed** is the largest of any particle at any time (m/s), **density** the mean and the largest of max(ρ/ρ₀ − 1, 0), the mean at
  the end, **rest** the rms speed over the last tenth of the run (m/s), ± how far single
  frames spread about it, with a bound where the water has to be at rest.
- No particle may be lost, and none may get past a wall. Without walls the momentum may change by gravity only, to 10⁻⁴.
- Every case gives the same hash with 1 and 3 threads. The dam and those of few particles also hold with `product`, `copula`, `directions`, `mean` and
  `nearest`.
- Where walls leave the water no room there is no solution, and the run has to end with an honest error (exit code 3): a
  case states from when to when, by the volume between the walls.
- **Guards** are what the report lists as `trouble`: a case states which have to act, and no other may but `coincident`:
  whether two particles ever meet on one point, in a corner or after an impact, may hang on the last bit. Frames that had to be
  divided are no trouble, but are named here, as `substeps`.
- **Without guards** is what the same case does with every guard of
  [core/solver/parameters.h](../../core/solver/parameters.h) switched off: "same hash" where none has acted, "holds" where others than
  those listed have, without need. Its scenes have no CFL rule either (`solver.cfl` 0).

)";

constexpr const char* kNormal = R"(
## Normal scenes

Guards may do nothing here: the hash with them is that without, as a test asserts. More steps than frames are those of the
CFL rule, which both programs have: jets in the corner pass 8 m/s, where 0.4 h would be less than a step's way. Speeds are
the time of one processor, the two programs in turns; medians, and of the ratio the quartiles, too. What no other load
disturbs is the number of instructions, of two times, less what the start takes:

    valgrind --tool=cachegrind --cache-sim=no build/dev/tests/hard_cases/guarded_probe scene scenes/dam_break.json 0.15

and the same of `unguarded_probe`.

)";

constexpr const char* kShort = R"(
## What falls short

- Two particles alone on one point stay there: their density is below that at rest, and nothing parts them. Inside water it is
  above and they part, but with a jolt of 4 m/s for single particles where they start so, and then slowly: a twelfth of a
  spacing after 1 s and half of one after 2 s; with `artificial_pressure` nine tenths after 2 s.
- A lattice between walls is not at rest: its density reads up to 5 % too high, and it swells in the first steps. That is where
  most of the gains come from; with gravity 0 the block leaves the walls at 0.24 m/s.
- In `wedge_to_nothing` single particles reach 15 m/s, three times the speed of the fall: downwards, into the tip, where the
  section that the water has to pass shrinks to a particle's. With half the spacing it shrinks twice as far, and they reach
  31 m/s; with shorter time steps it is 11 to 19 m/s. They take their energy from the others.
- In `slim_shell_holed` the surface ends at the hole's edge, and inside and outside change places from point to point: single
  particles leave it faster than anything falls (4 m/s). Energy is held all the same, but for what walls lift (below). An open mesh that is
  wound inwards as a whole takes all water for solid, and only the warning says so.
- What a step made from nothing is taken back of velocities, where it was gained. What it made by lifting water it has already
  in places: then less is taken back than was gained, and `energy_gained` in the report's `trouble` says how much.
- The table is that of velocities from positions, for which the guards are. With those by
  [projection](../../docs/method.md#velocities-by-projection), the default, 54 of the 58 cases keep what they state, guards aside, for
  fewer have to act. Of the others one particle in a wedge trembles at 24 mm/s (bound 1), water at a gravity of 1,000 m/s² at 0.9 m/s (0.1);
  behind the slit of half a support radius the water goes on moving at 0.3 m/s; the column ends 1.02 % too dense (1).
- Walls that move are no `wall_jump`: what they push may go faster than it came.
- `./run soak hard` runs every case with 2, 5, 16 and 64 threads, too (the hash stays the same), and with `mean`, `nearest`,
  `product`, `copula`, `directions` and `baked`: no particle is lost, all stays finite, and kinetic and potential energy never
  rise above what the fluid was given by more than the bound above. That asks less than the table does: a method that is not
  made for a case's walls (`mean` at thin plates and slits, `product` and `copula` in SLIM bowls) may shake the water, as long
  as viscosity takes out all that the solver adds; `largest_gain` in the report of such a run says how much. `baked` refuses
  `one_kilometre`, whose grid no memory holds.
)";

}  // namespace

std::string tableText() {
  std::string text = kHeader;
  text +=
      "| case | particles | steps | energy ≤ bound | speed ≤ bound | mean density | largest | rest | "
      "penetration (m) | lost | guards | without guards | result "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const HardCase& hardCase : hardCases()) text += rowOf(hardCase);
  text += kNormal + normalTable() + kShort;
  return text;
}

}  // namespace migiwa::testing
