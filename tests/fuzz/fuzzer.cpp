// One target under libFuzzer, which brings main(). MIGIWA_FUZZ_TARGET names it when this is compiled.
#include <algorithm>
#include <cstdint>

#include "tests/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace migiwa::fuzz;
  static const Target kTarget = *std::find_if(
      targets().begin(), targets().end(), [](const Target& one) { return one.name == MIGIWA_FUZZ_TARGET; });
  kTarget.run({reinterpret_cast<const char*>(data), size});
  return 0;
}
