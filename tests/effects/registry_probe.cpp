// usage: probe SCENE SECONDS
//
// Runs a scene and prints its state hash, the bytes and the pieces of memory that the simulation has asked
// for, and the stages that ran. Built twice: with the program's effects, and with MIGIWA_WITHOUT_EFFECTS as a
// program from which every effect is left out, for the linker takes none that nobody lists.
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace {

std::size_t bytes = 0, pieces = 0;

void* counted(std::size_t size, std::size_t alignment) {
  bytes += size, ++pieces;
  void* const memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

#ifdef MIGIWA_WITHOUT_EFFECTS
namespace migiwa {

std::span<const std::string_view> effectNames() {
  return {};
}
std::unique_ptr<Effect> makeEffect(int) {
  throw std::logic_error("there are no effects");
}

}  // namespace migiwa
#endif

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const migiwa::Scene scene = migiwa::readScene(argv[1]);
  bytes = pieces = 0;
  migiwa::Simulation simulation(scene, 1);
  const long last = simulation.frameAt(std::atof(argv[2]));
  while (simulation.frame() < last && !simulation.stopped()) simulation.advanceFrame();
  std::printf("%016llx %zu bytes in %zu pieces:", static_cast<unsigned long long>(simulation.stateHash()),
              bytes, pieces);
  for (const migiwa::StageTime& stage : simulation.view().info.stages.stages())
    std::printf(" %s", stage.name.c_str());
  std::printf("\n");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
