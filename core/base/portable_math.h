// Elementary functions whose last digit is the same everywhere. Those of the C library differ between its
// versions and between processors, and a difference in the last digit of a particle's position grows into
// another splash. These need nothing but the operations that IEEE 754 defines to the last digit, in the order
// in which they are written (-ffp-contract=off); std::sqrt, std::floor, std::fmod and their like are exact,
// too. What reaches particles takes its functions from here; a test of the sources watches over it.
#pragma once

namespace migiwa::portable {

/// Within 2e-16 for |angle| < 1e6 rad; beyond it, that of an angle within 1e-16 of its size.
double sin(double angle);
double cos(double angle);
/// Of y in [-1, 1] (NaN otherwise), within 1e-15; in [-pi/2, pi/2].
double asin(double y);
/// Within 4e-16 of its size; 0 below -708, infinite above 709.
double exp(double x);
/// Of x > 0, within 2e-16 + 2e-16 |log x|; -infinity at 0, NaN below.
double log(double x);
/// Within 4e-16 of its size; of negative numbers, too.
double cbrt(double x);
/// sqrt(x^2 + y^2 + z^2), for lengths whose squares neither over- nor underflow.
double hypot(double x, double y, double z = 0);

}  // namespace migiwa::portable
