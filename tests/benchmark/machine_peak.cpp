#include "tests/benchmark/machine_peak.h"

#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmark/machine_peak.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace migiwa::benchmarks::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Ten chains, as many as hide the latency of a multiply-add. Returns the operations done.
double multiplyAddChains(float& result) {
  constexpr int kRounds = 20000;
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V factor = hn::Set(d, 0.999F), term = hn::Set(d, 1e-3F);
  // Each chain starts elsewhere, or the compiler would see that they are one.
  V a = hn::Set(d, 0.1F), b = hn::Set(d, 0.2F), c = hn::Set(d, 0.3F), e = hn::Set(d, 0.4F),
    f = hn::Set(d, 0.5F);
  V g = hn::Set(d, 0.6F), h = hn::Set(d, 0.7F), k = hn::Set(d, 0.8F), l = hn::Set(d, 0.9F),
    m = hn::Set(d, 1.1F);
  for (int round = 0; round < kRounds; ++round) {
    a = hn::MulAdd(a, factor, term), b = hn::MulAdd(b, factor, term), c = hn::MulAdd(c, factor, term);
    e = hn::MulAdd(e, factor, term), f = hn::MulAdd(f, factor, term), g = hn::MulAdd(g, factor, term);
    h = hn::MulAdd(h, factor, term), k = hn::MulAdd(k, factor, term), l = hn::MulAdd(l, factor, term);
    m = hn::MulAdd(m, factor, term);
  }
  const V sum = hn::Add(hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(f, g), hn::Add(h, k))),
                        hn::Add(l, m));
  result = hn::GetLane(hn::SumOfLanes(d, sum));
  return 20.0 * kRounds * static_cast<double>(hn::Lanes(d));
}

}  // namespace migiwa::benchmarks::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa::benchmarks {

HWY_EXPORT(multiplyAddChains);

std::size_t triad(ThreadPool& pool) {
  constexpr std::size_t kFloats = std::size_t{1} << 24;
  static std::vector<float> a(kFloats, 1.0F), b(kFloats, 2.0F), c(kFloats, 3.0F);
  parallelFor(pool, kFloats, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + 0.5F * c[i];
  });
  return 3 * kFloats * sizeof(float);
}

double multiplyAdds(ThreadPool& pool) {
  const auto threads = static_cast<std::size_t>(pool.threads());
  std::vector<double> done(threads);
  std::vector<float> results(threads);
  pool.run(threads, [&](std::size_t k) { done[k] = HWY_DYNAMIC_DISPATCH(multiplyAddChains)(results[k]); });
  double total = 0;
  for (const double operations : done) total += operations;
  return total;
}

}  // namespace migiwa::benchmarks
#endif  // HWY_ONCE
