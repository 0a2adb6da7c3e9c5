/// Steps a scene: step_... SCENE FRAMES. Prints what operator new was asked for in all, bytes.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "cloth/simulation.h"
#include "scene/scene.h"

namespace {
std::atomic<std::size_t> asked_for{0};
}

void* operator new(std::size_t size) {
  asked_for += size;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  asked_for += size;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

int main(int, char** arguments) {
  const auto scene = std::get<weft::scene::Scene>(weft::scene::load(arguments[1]));
  const std::size_t before = asked_for;
  weft::Simulation<float> simulation(scene.simulation);
  for (int frame = 0; frame < std::atoi(arguments[2]); ++frame) simulation.step();
  std::printf("%zu\n", asked_for - before);
  return simulation.healthy() ? 0 : 1;
}
