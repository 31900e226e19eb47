// The memory of fuzz_obj. assimp asks for two blocks of 16 MiB for every OBJ file, however short,
// and fills them; the address sanitizer maps such blocks anew each time, and the kernel clears every page of
// them, which takes most of an execution. Here a large block that was given back is handed out again, and to
// use it in between is an error as ever. Smaller ones are the sanitizer's.
#include <array>
#include <cstdlib>
#include <mutex>
#include <new>

#include <sanitizer/asan_interface.h>

namespace {

constexpr std::size_t kLarge = std::size_t{1} << 24;

struct LargeBlock {
  void* memory = nullptr;
  bool used = false;
};

constinit std::array<LargeBlock, 4> blocks;
constinit std::mutex blocksMutex;

void* allocate(std::size_t bytes) noexcept {
  if (bytes == kLarge) {
    const std::scoped_lock lock(blocksMutex);
    for (LargeBlock& block : blocks) {
      if (block.used) continue;
      if (block.memory == nullptr) block.memory = std::malloc(kLarge);
      if (block.memory == nullptr) break;
      block.used = true;
      ASAN_UNPOISON_MEMORY_REGION(block.memory, kLarge);
      return block.memory;
    }
  }
  return std::malloc(bytes == 0 ? 1 : bytes);
}

void* allocateOrThrow(std::size_t bytes) {
  void* const memory = allocate(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void release(void* memory) {
  if (memory == nullptr) return;
  {
    const std::scoped_lock lock(blocksMutex);
    for (LargeBlock& block : blocks)
      if (block.memory == memory) {
        block.used = false;
        ASAN_POISON_MEMORY_REGION(memory, kLarge);
        return;
      }
  }
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocateOrThrow(bytes);
}
void* operator new[](std::size_t bytes) {
  return allocateOrThrow(bytes);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes);
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  release(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
  release(memory);
}
