#include <algorithm>
#include <array>
#include <vector>

#include "core/gamma/batches.h"

#ifndef MIGIWA_EDGE_TERMS
#define MIGIWA_EDGE_TERMS
namespace migiwa {

// Inside of `radius`, and outside of that of the terms before it, with r = |y - x| in support radii:
//   G(r) = 4 pi integral_0^r W s^2 ds      = sum of mass[k] r^k
//   2 pi K(r) = 2 pi integral_r^1 W s ds   = sum of slope[k] r^k
constexpr std::size_t kPowers = 10;
struct KernelTerms {
  float radius;
  std::array<double, kPowers> mass, slope;
};

/// The integrands of an edge, as what a radius adds to those of the larger radii around it.
struct EdgeTerms {
  float radius;
  std::array<float, kPowers> flux;  ///< 4 pi Phi(r) = inverse / r + sum of flux[k] r^k
  std::array<float, kPowers> area;  ///< 2 pi K(r)
  float inverse;
};

}  // namespace migiwa
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/gamma/facets_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/sph/kernels_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;

constexpr float kTiny = 1e-12F;

/// The angle of (x, y) for x >= 0, within 1e-7.
HWY_INLINE V angleOf(V x, V y) {
  const D d;
  const V size = hn::Abs(y), least = hn::Min(x, size), most = hn::Max(hn::Max(x, size), hn::Set(d, kTiny));
  const V z = hn::Div(least, most), z2 = hn::Mul(z, z);
  // Abramowitz and Stegun 4.4.49.
  const V turn = hn::Mul(z, horner(d, z2, 1.0F, -0.3333314528F, 0.1999355085F, -0.1420889944F, 0.1065626393F,
                                   -0.0752896400F, 0.0429096138F, -0.0161657367F, 0.0028662257F));
  const V angle = hn::IfThenElse(hn::Gt(size, x), hn::Sub(hn::Set(d, 0.5F * kPiF), turn), turn);
  return hn::CopySign(angle, y);
}

/// Of x >= 1.
HWY_INLINE V logarithm(V x) {
  const D d;
  const hn::RebindToSigned<D> di;
  // x = 2^power m with m in [sqrt(1/2), sqrt(2)), log m = 2 artanh((m - 1) / (m + 1)).
  const auto bits = hn::Sub(hn::BitCast(di, x), hn::Set(di, 0x3F3504F3));
  const auto power = hn::ShiftRight<23>(bits);
  const V m = hn::BitCast(d, hn::Add(hn::And(bits, hn::Set(di, 0x007FFFFF)), hn::Set(di, 0x3F3504F3)));
  const V one = hn::Set(d, 1.0F), s = hn::Div(hn::Sub(m, one), hn::Add(m, one));
  const V part = hn::Mul(s, horner(d, hn::Mul(s, s), 2.0F, 2.0F / 3, 2.0F / 5, 2.0F / 7, 2.0F / 9));
  return hn::MulAdd(hn::ConvertTo(d, power), hn::Set(d, 0.69314718056F), part);
}

/// For the powers of r along an edge, r^2 = height^2 + inside^2 + t^2: M_k = integral of r^k dt, and
/// L_k = integral of r^k over the angle, dangle = inside dt / (inside^2 + t^2). With D_k = [t r^k],
///   (k + 1) M_k = D_k + k (height^2 + inside^2) M_{k-2},   L_{k+2} = height^2 L_k + inside M_k.
/// kOnPlane: height is 0, as at the side of a cone; its inverseAngle is not asked for.
template <bool kOnPlane>
struct Moments {
  std::array<V, kPowers> angles;
  V inverseAngle;  ///< height L_-1

  HWY_INLINE Moments(V height, V inside, V from, V to) {
    const D d;
    const V height2 = hn::Mul(height, height);
    const V least2 = hn::Max(hn::MulAdd(inside, inside, height2), hn::Set(d, kTiny));
    const V r0 = hn::Sqrt(hn::MulAdd(from, from, least2)), r1 = hn::Sqrt(hn::MulAdd(to, to, least2));
    angles[0] = hn::Sub(angleOf(inside, to), angleOf(inside, from));
    const auto sum = [&](V t, V r) HWY_ATTR {  // t + r without cancellation
      return hn::IfThenElse(hn::Lt(t, hn::Zero(d)), hn::Div(least2, hn::Sub(r, t)), hn::Add(r, t));
    };
    const V logarithmic = logarithm(hn::Max(hn::Div(sum(to, r1), sum(from, r0)), hn::Set(d, 1.0F)));
    if constexpr (kOnPlane) {
      angles[1] = hn::Mul(inside, logarithmic);
    } else {
      inverseAngle = hn::Sub(angleOf(hn::Mul(inside, r1), hn::Mul(height, to)),
                             angleOf(hn::Mul(inside, r0), hn::Mul(height, from)));
      angles[1] = hn::MulAdd(height, inverseAngle, hn::Mul(inside, logarithmic));
    }
    V d0 = from, d1 = to;
    V before = logarithmic, now = hn::Sub(to, from);
    for (std::size_t k = 1; k + 1 < kPowers; ++k) {
      angles[k + 1] =
          kOnPlane ? hn::Mul(inside, now) : hn::MulAdd(height2, angles[k - 1], hn::Mul(inside, now));
      d0 = hn::Mul(d0, r0), d1 = hn::Mul(d1, r1);
      const auto power = static_cast<float>(k);
      const V next = hn::Mul(hn::Set(d, 1 / (power + 1)),
                             hn::MulAdd(hn::Mul(hn::Set(d, power), least2), before, hn::Sub(d1, d0)));
      before = now, now = next;
    }
  }
};

HWY_INLINE V sumOf(const std::array<float, kPowers>& terms, const std::array<V, kPowers>& moments) {
  const D d;
  V sum = hn::Zero(d);
  for (std::size_t k = 0; k < kPowers; ++k)
    if (terms[k] != 0) sum = hn::MulAdd(hn::Set(d, terms[k]), moments[k], sum);
  return sum;
}

/// EdgeIntegrals of several edges.
struct EdgeSums {
  V flux, area, pairArea;
};

/// Of edges whose fields are those of PolygonEdge. kOnPlane: height is 0, and flux is left out.
template <bool kOnPlane>
HWY_INLINE EdgeSums alongEdges(std::span<const EdgeTerms> own, std::span<const EdgeTerms> pair, V height,
                               V side, V from, V to) {
  const D d;
  const V zero = hn::Zero(d), overFour = hn::Set(d, 0.25F / kPiF), overTwo = hn::Set(d, 0.5F / kPiF);
  const V inside = hn::Abs(side);
  const V least2 = hn::MulAdd(inside, inside, hn::Mul(height, height));
  V flux = zero, area = zero, pairArea = zero;
  const std::size_t shells = std::max(own.size(), pair.size());
  for (std::size_t shell = 0; shell < shells; ++shell) {
    V start = from, end = to;
    if (shell > 0) {
      const V radius = hn::Set(d, own[shell].radius);
      const V half = hn::Sqrt(hn::Max(hn::Sub(hn::Mul(radius, radius), least2), zero));
      start = hn::Min(hn::Max(from, hn::Neg(half)), half), end = hn::Min(hn::Max(to, hn::Neg(half)), half);
    }
    const Moments<kOnPlane> moments(height, inside, start, end);
    const EdgeTerms& terms = own[shell];
    if constexpr (!kOnPlane)
      flux = hn::Add(flux, hn::MulAdd(hn::Set(d, terms.inverse), moments.inverseAngle,
                                      hn::Mul(height, sumOf(terms.flux, moments.angles))));
    area = hn::Add(area, sumOf(terms.area, moments.angles));
    if (!pair.empty()) pairArea = hn::Add(pairArea, sumOf(pair[shell].area, moments.angles));
  }
  if (pair.empty()) pairArea = area;
  const auto outside = hn::Lt(side, zero);
  const auto turned = [&](V a) HWY_ATTR { return hn::IfThenElse(outside, hn::Neg(a), a); };
  return {turned(hn::Mul(flux, overFour)), turned(hn::Mul(area, overTwo)),
          turned(hn::Mul(pairArea, overTwo))};
}

void edgesBatch(std::span<const EdgeTerms> own, std::span<const EdgeTerms> pair,
                std::span<const PolygonEdge> edges, std::span<EdgeIntegrals> results) {
  const D d;
  for (std::size_t k = 0; k < edges.size(); k += hn::Lanes(d)) {
    V height, side, from, to;
    hn::LoadInterleaved4(d, &edges[k].height, height, side, from, to);
    const EdgeSums sums = alongEdges<false>(own, pair, height, side, from, to);
    hn::StoreInterleaved4(sums.flux, sums.area, sums.pairArea, hn::Zero(d), d, &results[k].flux);
  }
}

/// What faces add to samples, a sample a lane.
struct LaneSums {
  V gamma;
  std::array<V, 3> gradient, pairGradient;

  /// Subtracts from the components of the gradients along an axis that differs from lane to lane.
  HWY_INLINE void subtract(V axis, V own, V pair) {
    const D d;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto along = hn::Eq(axis, hn::Set(d, static_cast<float>(k)));
      gradient[k] = hn::Sub(gradient[k], hn::IfThenElseZero(along, own));
      pairGradient[k] = hn::Sub(pairGradient[k], hn::IfThenElseZero(along, pair));
    }
  }
};

/// Out of reach.
constexpr UprightFace kNoFace{2, 1, 0, 0, 0, 0, 0};

/// Fields of UprightFace, a face a lane.
struct LaneFaces {
  static constexpr float UprightFace::*kFields[] = {
      &UprightFace::distance,  &UprightFace::side,     &UprightFace::axis,     &UprightFace::firstLow,
      &UprightFace::firstHigh, &UprightFace::otherLow, &UprightFace::otherHigh};
  alignas(32) float fields[std::size(kFields)][kEdgeGroup] = {};

  HWY_INLINE void set(std::size_t lane, const UprightFace& face) {
    for (std::size_t k = 0; k < std::size(kFields); ++k) fields[k][lane] = face.*kFields[k];
  }
  HWY_INLINE V at(std::size_t field) const { return hn::Load(D(), fields[field]); }
};

/// PolygonSums::add(), open and in front of the point, for rectangles along the axes.
HWY_INLINE void addFaces(std::span<const EdgeTerms> own, std::span<const EdgeTerms> pair,
                         const LaneFaces& faces, LaneSums& sums) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const V distance = faces.at(0), side = faces.at(1), axis = faces.at(2);
  const V low[] = {faces.at(3), faces.at(5)}, high[] = {faces.at(4), faces.at(6)};
  // Counter-clockwise as the point sees it: first along the axis after its own, or before it.
  const V three = hn::Set(d, 3.0F), ahead = hn::Add(axis, hn::Add(side, three));
  const V first = hn::IfThenElse(hn::Ge(ahead, hn::Set(d, 6.0F)), hn::Sub(ahead, hn::Set(d, 6.0F)),
                                 hn::IfThenElse(hn::Ge(ahead, three), hn::Sub(ahead, three), ahead));
  const V across[] = {hn::Sub(three, hn::Add(axis, first)), first};
  const V height2 = hn::Sub(one, hn::Mul(distance, distance));
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t along = k % 2;
    const V inside = k == 0 ? hn::Neg(low[1]) : k == 1 ? high[0] : k == 2 ? high[1] : hn::Neg(low[0]);
    const V from = k < 2 ? low[along] : hn::Neg(high[along]);
    const V half2 = hn::Sub(height2, hn::Mul(inside, inside));
    const V half = hn::Sqrt(hn::Max(half2, zero));
    const V start = hn::Max(from, hn::Neg(half)),
            end = hn::Min(hn::Add(from, hn::Sub(high[along], low[along])), half);
    const auto present = hn::And(hn::Gt(half2, zero), hn::Lt(start, end));
    if (hn::AllFalse(d, present)) continue;
    const auto only = [&](auto mask, V value) HWY_ATTR { return hn::IfThenElseZero(mask, value); };
    const EdgeSums edge = alongEdges<false>(own, pair, distance, inside, start, end);
    sums.gamma = hn::Add(sums.gamma, only(present, edge.flux));
    sums.subtract(axis, only(present, hn::Mul(edge.area, side)), only(present, hn::Mul(edge.pairArea, side)));
    // The side of the cone.
    const V least = hn::Sqrt(hn::Sub(one, half2));
    const auto open = hn::And(present, hn::Ge(least, hn::Set(d, kFacetRounding)));
    const EdgeSums cone = alongEdges<true>(own, pair, zero, least, start, end);
    const V over = hn::Div(one, least);
    const V normal = hn::Mul(over, hn::Neg(hn::Mul(inside, side)));
    const V outwards = hn::Mul(over, k == 0 || k == 3 ? distance : hn::Neg(distance));
    sums.subtract(axis, only(open, hn::Mul(cone.area, normal)), only(open, hn::Mul(cone.pairArea, normal)));
    sums.subtract(across[along], only(open, hn::Mul(cone.area, outwards)),
                  only(open, hn::Mul(cone.pairArea, outwards)));
  }
}

void facesBatch(std::span<const EdgeTerms> own, std::span<const EdgeTerms> pair,
                std::span<const UprightFace> faces, std::span<const FacesSeen> points,
                std::span<GammaSample> samples) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t begin = 0; begin < points.size(); begin += lanes) {
    const std::span<const FacesSeen> group = points.subspan(begin, std::min(lanes, points.size() - begin));
    alignas(32) float values[7][kEdgeGroup] = {};
    for (std::size_t lane = 0; lane < group.size(); ++lane) {
      const GammaSample& sample = samples[group[lane].sample];
      values[0][lane] = sample.gamma;
      for (std::size_t k = 0; k < 3; ++k) {
        values[1 + k][lane] = sample.gradient[static_cast<int>(k)];
        values[4 + k][lane] = sample.pairGradient[static_cast<int>(k)];
      }
    }
    LaneSums sums;
    sums.gamma = hn::Load(d, values[0]);
    for (std::size_t k = 0; k < 3; ++k)
      sums.gradient[k] = hn::Load(d, values[1 + k]), sums.pairGradient[k] = hn::Load(d, values[4 + k]);
    LaneFaces now;
    for (std::uint32_t round = 0; round < group.front().count; ++round) {
      for (std::size_t lane = 0; lane < lanes; ++lane)
        now.set(lane, lane < group.size() && round < group[lane].count ? faces[group[lane].first + round]
                                                                       : kNoFace);
      addFaces(own, pair, now, sums);
    }
    hn::Store(sums.gamma, d, values[0]);
    for (std::size_t k = 0; k < 3; ++k)
      hn::Store(sums.gradient[k], d, values[1 + k]), hn::Store(sums.pairGradient[k], d, values[4 + k]);
    for (std::size_t lane = 0; lane < group.size(); ++lane) {
      GammaSample& sample = samples[group[lane].sample];
      sample.gamma = values[0][lane];
      for (std::size_t k = 0; k < 3; ++k) {
        sample.gradient[static_cast<int>(k)] = values[1 + k][lane];
        sample.pairGradient[static_cast<int>(k)] = values[4 + k][lane];
      }
    }
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(edgesBatch);
HWY_EXPORT(facesBatch);

namespace {

constexpr KernelTerms kPoly6{
    1,
    {0, 0, 0, 105.0 / 16, 0, -189.0 / 16, 0, 135.0 / 16, 0, -35.0 / 16},
    {315.0 / 256, 0, -315.0 / 64, 0, 945.0 / 128, 0, -315.0 / 64, 0, 315.0 / 256, 0}};
constexpr KernelTerms kSpiky{1, {0, 0, 0, 20, -45, 36, -10}, {1.5, 0, -15, 30, -22.5, 6}};
constexpr KernelTerms kSplineOuter{
    1, {-1.0 / 15, 0, 0, 64.0 / 3, -48, 38.4, -32.0 / 3}, {1.6, 0, -16, 32, -24, 6.4}};
constexpr KernelTerms kSplineInner{0.5F, {0, 0, 0, 32.0 / 3, 0, -38.4, 32}, {1.4, 0, -8, 0, 24, -19.2}};
constexpr KernelTerms kWendland{
    1, {0, 0, 0, 14, 0, -84, 140, -90, 21}, {1.5, 0, -10.5, 0, 52.5, -84, 52.5, -12}};

/// From the outermost shell inwards.
std::vector<EdgeTerms> edgeTerms(std::span<const KernelTerms> shells) {
  using Terms = std::array<double, kPowers>;
  std::vector<EdgeTerms> result;
  Terms flux{}, area{};
  double inverse = 0;
  for (const KernelTerms& shell : shells) {
    // Phi(r) = integral_r^1 P / s^2 ds, continuous from shell to shell, with 4 pi P = 1 - G.
    const auto valueOf = [radius = static_cast<double>(shell.radius)](double over, const Terms& terms) {
      double sum = over / radius, power = 1;
      for (const double term : terms) sum += term * power, power *= radius;
      return sum;
    };
    const double known = result.empty() ? 0 : valueOf(inverse, flux);
    Terms ownFlux{};
    for (std::size_t k = 3; k < kPowers; ++k) ownFlux[k - 1] = shell.mass[k] / static_cast<double>(k - 1);
    const double ownInverse = 1 - shell.mass[0];
    ownFlux[0] = known - valueOf(ownInverse, ownFlux);
    EdgeTerms& added = result.emplace_back();
    added.radius = shell.radius;
    for (std::size_t k = 0; k < kPowers; ++k) {
      added.flux[k] = static_cast<float>(ownFlux[k] - flux[k]);
      added.area[k] = static_cast<float>(shell.slope[k] - area[k]);
    }
    added.inverse = static_cast<float>(ownInverse - inverse);
    flux = ownFlux, area = shell.slope, inverse = ownInverse;
  }
  return result;
}

struct KernelEdges {
  std::vector<EdgeTerms> own, pair;  ///< without any of the pair's, they are the kernel's own
};

const KernelEdges& edgesOf(KernelType kernel) {
  const auto one = [](const KernelTerms& terms) { return edgeTerms(std::array{terms}); };
  static const KernelEdges poly6{one(kPoly6), one(kSpiky)}, spiky{one(kSpiky), {}},
      spline{edgeTerms(std::array{kSplineOuter, kSplineInner}), {}}, wendland{one(kWendland), {}};
  switch (kernel) {
    case KernelType::spiky:
      return spiky;
    case KernelType::cubicSpline:
      return spline;
    case KernelType::wendlandC2:
      return wendland;
    case KernelType::poly6:
      break;
  }
  return poly6;
}

}  // namespace

static_assert(sizeof(PolygonEdge) == 4 * sizeof(float) && sizeof(EdgeIntegrals) == 4 * sizeof(float));

void integrate(KernelType kernel, std::span<const PolygonEdge> edges, std::span<EdgeIntegrals> results) {
  const KernelEdges& terms = edgesOf(kernel);
  HWY_DYNAMIC_DISPATCH(edgesBatch)(terms.own, terms.pair, edges, results);
}

void addUprightFaces(KernelType kernel, std::span<const UprightFace> faces, std::span<const FacesSeen> points,
                     std::span<GammaSample> samples) {
  const KernelEdges& terms = edgesOf(kernel);
  HWY_DYNAMIC_DISPATCH(facesBatch)(terms.own, terms.pair, faces, points, samples);
}

}  // namespace migiwa
#endif
