/// Steps a scene by each kind of method in turn: step_... SCENE FRAMES. Prints for each what operator new was
/// asked for, bytes.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "cloth/world/simulation.h"
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

/// A call of its own, as whoever counts instructions tells methods apart by it. False if a step was not as
/// the method made it.
[[gnu::noinline]] bool step_scene(const weft::SimulationDescription& scene, int frames) {
  const std::size_t before = asked_for;
  bool by_method = true;
  {
    weft::Simulation<float> simulation(scene);
    for (int frame = 0; frame < frames; ++frame) {
      simulation.step();
      by_method = by_method && simulation.guard_events().empty();
    }
  }
  std::printf("%zu\n", asked_for - before);
  return by_method;
}

int main(int, char** arguments) {
  auto scene = std::get<weft::scene::Scene>(weft::scene::load(arguments[1])).simulation;
  const std::initializer_list<weft::IntegratorDescription> methods{
      weft::Bdf2Description{}, weft::XpbdDescription{}, weft::SymplecticEulerDescription{}};
  bool by_methods = true;
  for (const weft::IntegratorDescription& method : methods) {
    scene.integrator = method;
    by_methods = step_scene(scene, std::atoi(arguments[2])) && by_methods;
  }
  return by_methods ? 0 : 1;
}
