// The largest amount of memory that the program has had since it last asked, so that runs in one program are
// told apart.
#pragma once

namespace migiwa {

/// Gives back what is free and starts anew from what is in use. Where the system cannot do this, the peak
/// stays that of the whole program.
void resetPeakMemory();
/// Largest resident set since then (bytes).
double peakMemory();

}  // namespace migiwa
