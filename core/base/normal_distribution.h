// The normal distribution in one, two and three variables.
#pragma once

namespace migiwa {

/// P(X < x).
double normalCdf(double x);
/// The x with P(X < x) = p; p in (0, 1), beyond [1e-12, 1 - 1e-12] taken as those.
double normalQuantile(double p);
/// P(X < x, Y < y) with correlation r in [-1, 1]; within 1e-7 for |r| < 0.99.
double bivariateNormalCdf(double x, double y, double r);
/// P(X < x, Y < y, Z < z) with pairwise correlations.
double trivariateNormalCdf(double x, double y, double z, double rxy, double rxz, double ryz);

}  // namespace migiwa
