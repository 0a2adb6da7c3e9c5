// Work on several threads: what parallel_for promises, and that a simulation's bits are the same on any
// number of them. Runs under the thread sanitizer as well.
#if defined(__SSE__)
#include <immintrin.h>
#endif
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bodies.h"
#include "cloth/core/parallel.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"

namespace weft {
namespace {

/// Calls what() on so many threads at most, be there fewer cores.
template <class What>
void on_threads(int threads, const What& what) {
  const ThreadLimit limit(threads);
  tbb::task_arena arena(threads);
  arena.execute(what);
}

// --- parallel_for ---

TEST(ParallelFor, DoesEachOnceAndAllBeforeItReturns) {
  for (const int threads : {1, 2, 4, 8}) {
    on_threads(threads, [] {
      for (const int count : {0, 1, 2, 1000}) {
        std::vector<int> done(static_cast<std::size_t>(count));
        parallel_for(count, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
        EXPECT_EQ(std::count(done.begin(), done.end(), 1), count);
      }
    });
  }
}

TEST(ParallelFor, MayBeCalledFromWithin) {
  on_threads(4, [] {
    std::array<std::array<int, 50>, 20> done{};
    parallel_for(20, [&](int i) {
      parallel_for(50, [&](int j) { ++done[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; });
    });
    for (const auto& row : done) EXPECT_EQ(std::count(row.begin(), row.end(), 1), 50);
  });
}

TEST(ParallelFor, HandsAnExceptionOn) {
  const auto fails = [](int i) {
    if (i == 7) throw std::runtime_error("seven");
  };
  on_threads(4, [&] { EXPECT_THROW(parallel_for(10, fails), std::runtime_error); });
}

TEST(ThreadLimit, OneMeansTheCallerAlone) {
  on_threads(1, [] {
    const std::thread::id caller = std::this_thread::get_id();
    parallel_for(1000, [&](int) { EXPECT_EQ(std::this_thread::get_id(), caller); });
  });
}

TEST(ThreadLimit, RefusesLessThanOne) {
  for (const int threads : {0, -1}) EXPECT_THROW(ThreadLimit limit(threads), std::invalid_argument);
}

/// Two tasks that end only when both have begun: on two threads, therefore. False if that took too long.
template <class What>
[[nodiscard]] bool on_two_threads_at_once(const What& what) {
  std::atomic<int> begun = 0;
  std::atomic<bool> met = true;
  on_threads(2, [&] {
    parallel_for(2, [&](int i) {
      ++begun;
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
      while (begun < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      if (begun < 2) met = false;
      what(i);
    });
  });
  return met;
}

TEST(ParallelFor, TasksRunAtTheSameTime) {
  EXPECT_TRUE(on_two_threads_at_once([](int) {}));
}

#if defined(__SSE__)
TEST(ParallelFor, SubnormalNumbersAreToAllWhatTheyAreToTheCaller) {
  constexpr unsigned kFlushAndZero = 0x8040;
  const unsigned before = _mm_getcsr();
  for (const unsigned mode : {before & ~kFlushAndZero, before | kFlushAndZero}) {
    _mm_setcsr(mode);
    std::array<float, 2> quotients{};
    const bool met = on_two_threads_at_once([&](int i) {
      volatile float smallest = std::numeric_limits<float>::min();
      quotients[static_cast<std::size_t>(i)] = smallest / 2;
    });
    _mm_setcsr(before);
    EXPECT_TRUE(met);
    for (const float quotient : quotients) EXPECT_EQ(quotient == 0, (mode & kFlushAndZero) != 0);
  }
}
#endif

// --- Simulations ---

/// Sanitizers make all this up to fifty times as slow.
#ifdef WEFT_SANITIZED
constexpr int kStackSteps = 6, kLargeLevel = 6, kLargeSteps = 1, kRepeats = 1;
const std::vector<int> kThreads{4};
#else
constexpr int kStackSteps = 60, kLargeLevel = 7, kLargeSteps = 4, kRepeats = 3;
const std::vector<int> kThreads{2, 8};
#endif

using Integrators = std::vector<IntegratorDescription>;
/// Those that work on one cloth in bands; the others do so on one thread.
const Integrators kImplicit{BackwardEulerDescription{}, Bdf2Description{}};
const Integrators kAll{SymplecticEulerDescription{}, XpbdDescription{}, BackwardEulerDescription{},
                       Bdf2Description{}};

std::string name_of(const IntegratorDescription& integrator) {
  return std::visit([](const auto& d) { return std::string(d.kName); }, integrator);
}

/// Sheets one below the other, each held by two edges, of several levels; a heavy ball falls on them.
SimulationDescription stacked_sheets() {
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.size = {1, 1};
  sheet.orientation = Quaternion(Eigen::AngleAxisd(std::acos(-1.0) / 2, Vec3(1, 0, 0)));
  sheet.perturbation = 0.001;
  sheet.min_level = 3;
  sheet.pins = {{0, 0, 0, 1}, {1, 1, 0, 1}};
  for (const int level : {4, 5, 4, 3}) {
    sheet.initial_level = level;
    sheet.position = Vec3(0, -0.04 * static_cast<double>(scene.cloths.size()), 0);
    scene.cloths.push_back(sheet);
  }
  BallDescription ball;
  ball.motion = BallDescription::Motion::dynamic;
  ball.radius = 0.2;
  ball.mass = 2;
  ball.friction = 0.3;
  ball.position = {0.05, 0.25, -0.02};
  ball.velocity = {0.3, -2, 0};
  scene.balls = {ball};
  ball.position = {0.2, 0.75, 0.2};
  scene.balls.push_back(ball);
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  scene.wind = {{0, 0, -1}, 1.0};
  return scene;
}

/// One sheet hung by two corners in the wind, a ball on its way through it.
SimulationDescription large_sheet() {
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.max_level = sheet.initial_level = kLargeLevel;
  sheet.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  sheet.perturbation = 0.001;
  scene.cloths = {sheet};
  BallDescription ball;
  ball.radius = 0.3;
  ball.position = {0, 0, 0.35};
  ball.velocity = {0, 0, -4};
  scene.balls = {ball};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  scene.wind = {{0, 0, -1}, 2.0};
  return scene;
}

/// What is commanded before a step.
using Commands = std::function<void(Simulation<float>& simulation, int step)>;

/// The state's hash after each of so many steps; how many cloths have touched a ball on the way goes to
/// `touched`.
std::vector<std::uint64_t> simulate(const SimulationDescription& scene, int threads, int steps,
                                    std::size_t* touched, const Commands& command) {
  Simulation<float> simulation(scene);
  std::vector<std::uint64_t> hashes;
  on_threads(threads, [&] {
    for (int i = 0; i < steps; ++i) {
      if (command) command(simulation, i);
      simulation.step();
      hashes.push_back(state_hash(simulation));
    }
  });
  EXPECT_TRUE(simulation.healthy());
  *touched = static_cast<std::size_t>(
      std::count_if(simulation.cloths().begin(), simulation.cloths().end(),
                    [](const auto& cloth) { return cloth.contact_counters().nodes_in_contact > 0; }));
  return hashes;
}

/// At every step, on one thread and on several, `repeats` times.
void expect_same_bits(SimulationDescription scene, const Integrators& integrators, int steps,
                      std::size_t must_touch, int repeats = 1, const Commands& command = {}) {
  for (const IntegratorDescription& integrator : integrators) {
    SCOPED_TRACE(name_of(integrator));
    scene.integrator = integrator;
    std::size_t touched = 0;
    const std::vector<std::uint64_t> first = simulate(scene, 1, steps, &touched, command);
    EXPECT_GE(touched, must_touch);
    for (int repeat = 0; repeat < repeats; ++repeat) {
      for (const int threads : kThreads) {
        const std::vector<std::uint64_t> again = simulate(scene, threads, steps, &touched, command);
        const auto differs = std::mismatch(first.begin(), first.end(), again.begin(), again.end()).first;
        EXPECT_EQ(differs - first.begin(), steps) << threads << " threads: the first step that differs";
      }
    }
  }
}

TEST(Threads, ClothsThatShareBallsHaveTheSameBitsOnAnyNumber) {
  expect_same_bits(stacked_sheets(), kAll, kStackSteps, 4, kRepeats);
}

TEST(Threads, CommandsLeaveTheSameBitsOnAnyNumber) {
  const auto command = [](Simulation<float>& simulation, int step) {
    if (step % 5 == 4) simulation.request_level(static_cast<std::size_t>(step % 4), 3 + step % 3);
    if (step == 3) simulation.set_wind({{1, 0, 0}, 5});
    if (step == 6) simulation.throw_ball(0, {0, 3, 1});
    if (step == 8) {
      BallDescription ball;
      ball.position = {0.3, -0.3, 0};
      ball.radius = 0.1;
      simulation.add_ball(ball);
    }
  };
  expect_same_bits(stacked_sheets(), kAll, kStackSteps / 3, 0, kRepeats, command);
}

TEST(Threads, ClothsInTurbulenceHaveTheSameBitsOnAnyNumber) {
  SimulationDescription scene = stacked_sheets();
  scene.wind.gusts = {0.3, 1.0};
  scene.wind.turbulence = {0.3, 0.3};
  scene.wind.zones = {{SphereZone{0.3}, {0, 0, 0}, {0, 2, 0}, 0.2}};
  expect_same_bits(scene, kAll, kStackSteps / 10, 0);
}

SimulationDescription cloths_on_one_another() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.min_level = cloth.max_level = cloth.initial_level = 4;
  cloth.orientation = Eigen::AngleAxisd(-1.5707963, Vec3::UnitX());
  cloth.pins = {PinRegion{0, 0, 0, 0}, PinRegion{1, 1, 0, 0}};
  scene.cloths = {cloth, cloth, cloth, cloth};
  for (std::size_t i = 1; i < 4; ++i) {
    scene.cloths[i].pins.clear();
    scene.cloths[i].size = {0.5, 0.5};
    scene.cloths[i].position = {0.1, 0.05 * static_cast<double>(i), -0.2};
  }
  scene.effects = {GravityEffect{}, ClothContactEffect{}};
  return scene;
}

TEST(Threads, ClothsOnOneAnotherHaveTheSameBitsOnAnyNumber) {
  expect_same_bits(cloths_on_one_another(), kAll, kStackSteps / 4, 0);
}

TEST(Threads, TearingClothsHaveTheSameBitsOnAnyNumber) {
  SimulationDescription scene = stacked_sheets();
  scene.effects.push_back(TearingEffect{5, 5});
  Simulation<float> tears(scene);
  for (int i = 0; i < kStackSteps / 3; ++i) tears.step();
  EXPECT_NE(tears.cloths()[0].walls(), nullptr);
  expect_same_bits(scene, kAll, kStackSteps / 3, 0);
}

/// The stack falls on a floor among bodies that fall, too: they meet the sheets, each other and the floor.
SimulationDescription bodies_among_sheets() {
  SimulationDescription scene = stacked_sheets();
  for (ClothDescription& cloth : scene.cloths) cloth.pins.clear();
  scene.obstacles = {test::ground(0.5, {0, 1, 0}),
                     test::flying(BoxDescription{{0.3, 0.2, 0.25}}, {-0.1, 0.2, 0.1}, {0, -2, 0}, 0.4),
                     test::flying(BoxDescription{{0.2, 0.2, 0.2}}, {-0.15, 0.42, 0.15}, {0, -3, 0}, 0.4),
                     test::flying(CapsuleDescription{0.08, 0.3}, {0.3, -0.25, -0.3}, {-1, 0, 1}, 0.4)};
  scene.obstacles[0].position = {0, -0.4, 0};
  return scene;
}

TEST(Threads, BodiesAmongClothsHaveTheSameBitsOnAnyNumber) {
  const SimulationDescription scene = bodies_among_sheets();
  Simulation<float> simulation(scene);
  BodyCollision collision;
  bool on_floor = false, on_another = false;
  for (int i = 0; i < kStackSteps; ++i) {
    simulation.step();
    for (const BodyContact& contact : collision.find(simulation.colliders().solids(), scene.time_step)) {
      if (contact.gap < 1e-3) (contact.firm ? on_floor : on_another) = true;
    }
  }
  EXPECT_TRUE(kStackSteps < 60 || (on_floor && on_another));
  // One that meets bodies after its step and one that solves for them.
  expect_same_bits(scene, {SymplecticEulerDescription{}, Bdf2Description{}}, kStackSteps,
                   kStackSteps >= 60 ? 4 : 0);
}

TEST(ThreadsNightly, BodiesAmongClothsByTheOtherMethodsHaveTheSameBitsOnAnyNumber) {
  expect_same_bits(bodies_among_sheets(), {XpbdDescription{}, BackwardEulerDescription{}}, kStackSteps,
                   kStackSteps >= 60 ? 4 : 0);
}

TEST(Threads, ALargeClothHasTheSameBitsOnAnyNumber) {
  expect_same_bits(large_sheet(), kImplicit, kLargeSteps, 1, kRepeats);
}

}  // namespace
}  // namespace weft
