// What memory can still be had, asked before much of it is taken: a program that the system has to stop for
// want of memory says nothing.
#pragma once

#include <string>

namespace migiwa {

/// Memory that can still be had (bytes): of the machine, of the container and of the process. Infinite where
/// the system does not say.
double availableMemory();

/// Throws InputError at `place` where `bytes` for `what` are more than can still be had.
void requireMemory(double bytes, const std::string& what, const std::string& place);

}  // namespace migiwa
