/// What the parts of a step cost, at each level: Google Benchmark, items are nodes.
#include <benchmark/benchmark.h>

#include "cloth/contact/recovery/contact.h"
#include "cloth/integrators/integrator.h"
#include "cloth/levels/refine.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/springs.h"

namespace weft::bench {
namespace {

using Real = float;

/// A 2 m x 2 m sheet of waves.
Particles<Real> wavy_sheet(int level) {
  Particles<Real> sheet(BaseCells{}.at(level));
  const Grid grid = sheet.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const double u = double(c) / (grid.cols - 1), v = double(r) / (grid.rows - 1);
      sheet.position.x.at(r, c) = static_cast<Real>(2 * u - 1);
      sheet.position.y.at(r, c) = static_cast<Real>(1 - 2 * v);
      sheet.position.z.at(r, c) = static_cast<Real>(0.05 * std::sin(20 * u + 10 * v));
      sheet.inverse_mass.at(r, c) = 1;
    }
  }
  sheet.mass.fill(1);
  return sheet;
}

void count_nodes(benchmark::State& state, const Grid& grid) {
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * grid.nodes());
}

void spring_forces(benchmark::State& state) {
  const Particles<Real> sheet = wavy_sheet(static_cast<int>(state.range(0)));
  const Springs<Real> springs(Material{}, Discretization::paper, {2, 2}, sheet.grid());
  VectorField<Real> force(sheet.grid());
  for (auto _ : state) {
    springs.add_forces(sheet.position, force);
    benchmark::DoNotOptimize(force.x.row(0));
  }
  count_nodes(state, sheet.grid());
}
BENCHMARK(spring_forces)->DenseRange(kMinLevel, kMaxLevel);

/// A step of 40 substeps under gravity: items are nodes of a substep, each has six springs.
void xpbd_step(benchmark::State& state) {
  constexpr int kSubsteps = 40;
  Particles<Real> sheet = wavy_sheet(static_cast<int>(state.range(0)));
  const Sheet<Real> resisting(Springs<Real>(Material{}, Discretization::paper, {2, 2}, sheet.grid()));
  const auto effects = make_effects<Real>({GravityEffect{}});
  const ClothDescription cloth;
  const Wind wind;
  std::vector<Solid> none;
  const auto xpbd = make_integrator<Real>(XpbdDescription{kSubsteps});
  for (auto _ : state) {
    xpbd->advance(sheet, {&resisting, &effects, {&cloth, &wind, 0.0}}, nullptr, none, 0.0, 1e-4);
    benchmark::DoNotOptimize(sheet.position.x.row(0));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kSubsteps * sheet.grid().nodes());
}
BENCHMARK(xpbd_step)->DenseRange(kMinLevel, kMaxLevel);

void finite_check(benchmark::State& state) {
  const Particles<Real> sheet = wavy_sheet(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(is_finite(sheet));
  count_nodes(state, sheet.grid());
}
BENCHMARK(finite_check)->DenseRange(kMinLevel, kMaxLevel);

void split_to(benchmark::State& state) {
  const int level = static_cast<int>(state.range(0));
  const Particles<Real> coarse = wavy_sheet(level - 1);
  Particles<Real> fine(BaseCells{}.at(level));
  for (auto _ : state) {
    split(coarse, fine);
    benchmark::DoNotOptimize(fine.position.x.row(0));
  }
  count_nodes(state, fine.grid());
}
BENCHMARK(split_to)->DenseRange(kMinLevel + 1, kMaxLevel);

void merge_from(benchmark::State& state) {
  const int level = static_cast<int>(state.range(0));
  const Particles<Real> fine = wavy_sheet(level);
  Particles<Real> coarse(BaseCells{}.at(level - 1));
  for (auto _ : state) {
    merge(fine, coarse);
    benchmark::DoNotOptimize(coarse.position.x.row(0));
  }
  count_nodes(state, fine.grid());
}
BENCHMARK(merge_from)->DenseRange(kMinLevel + 1, kMaxLevel);

/// Section 2.4 of one substep: `range(1)` is 0 for a ball out of reach, 1 for one that lies on the sheet.
void ball_contact(benchmark::State& state) {
  Particles<Real> sheet = wavy_sheet(static_cast<int>(state.range(0)));
  Solid ball;
  ball.shape = Sphere{0.2};
  ball.position = ball.start = {0.1, 0.1, state.range(1) == 1 ? -0.15 : -5.0};
  std::vector<Solid> balls{ball};
  Contact<Real> contact(sheet.grid());
  for (auto _ : state) benchmark::DoNotOptimize(contact.resolve(sheet, balls, {0.0, 1.0}));
  count_nodes(state, sheet.grid());
}
BENCHMARK(ball_contact)->ArgsProduct({benchmark::CreateDenseRange(kMinLevel, kMaxLevel, 1), {0, 1}});

}  // namespace
}  // namespace weft::bench

BENCHMARK_MAIN();
