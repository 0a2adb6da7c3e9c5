#include "cloth/integrators/sheet_projection.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

constexpr double kProjectedStep = 1.0 / 600;

/// A flat sheet of 2 m and 0.4 kg whose free nodes a substep has moved at random, within 10 mm; its upper
/// corners held.
struct Projected {
  explicit Projected(double stiffness, double damping_time = 0)
      : particles(test::flat_sheet<double>(6, 9, {2, 2})) {
    test::share_mass(particles, 0.4, Discretization::continuum);
    for (const int c : {0, 8}) particles.inverse_mass.at(0, c) = 0;
    cloth.size = {2, 2};
    cloth.material = test::stiffnesses(stiffness, stiffness / 10, stiffness / 1000);
    std::vector<EffectDescription> effects;
    if (damping_time > 0) effects.push_back(StrainDampingEffect{damping_time});
    sheet = Sheet<double>(cloth, SheetEffects(effects), particles.inverse_mass);
    projection.prepare(sheet, particles.mass, layout, kProjectedStep);
    begin();
  }
  Projected(const Projected&) = delete;  // the projection's springs point into it
  /// A substep's begin: where the nodes are, and the moves they are to make.
  void begin() {
    VectorField<double> moves(particles.grid());
    test::randomise(moves, -0.01, 0.01, 5);
    each_node(particles.grid(), [&](int r, int c) {
      const double free = particles.inverse_mass.at(r, c) == 0 ? 0 : 1;
      for (int i = 0; i < 3; ++i) {
        scalar(r, c, i) = particles.local_position_at(r, c)[i];
        scalar(r, c, kernels::QuarterRows::kMove + i) = free * test::get(moves, r, c)[i];
      }
      scalar(r, c, kernels::QuarterRows::kInverseMass) = particles.inverse_mass.at(r, c);
    });
  }
  double& scalar(int r, int c, int field) {
    return nodes[static_cast<std::size_t>(r) * layout.row_size() +
                 static_cast<std::size_t>(field) * layout.stride + static_cast<std::size_t>(layout.lane(c))];
  }
  Vec3 vector(int r, int c, int first) {
    return {scalar(r, c, first), scalar(r, c, first + 1), scalar(r, c, first + 2)};
  }
  Vec3 move(int r, int c) { return vector(r, c, kernels::QuarterRows::kMove); }
  Vec3 place(int r, int c) { return vector(r, c, 0) + move(r, c); }
  /// kg m, of the free nodes.
  Vec3 momentum() {
    Vec3 sum(0, 0, 0);
    each_node(particles.grid(), [&](int r, int c) { sum += particles.mass.at(r, c) * move(r, c); });
    return sum;
  }
  std::vector<Vec3> moves() {
    std::vector<Vec3> all;
    all.reserve(static_cast<std::size_t>(particles.grid().nodes()));
    each_node(particles.grid(), [&](int r, int c) { all.push_back(move(r, c)); });
    return all;
  }
  void forget_moves() {
    each_node(particles.grid(), [&](int r, int c) {
      for (int i = 0; i < 3; ++i) scalar(r, c, kernels::QuarterRows::kMove + i) = 0;
    });
  }
  /// The largest change of a structural spring's length, relative.
  double stretch() {
    double most = 0;
    const Grid& grid = particles.grid();
    each_node(grid, [&](int r, int c) {
      if (c + 1 < grid.cols) {
        most = std::max(most, std::abs((place(r, c) - place(r, c + 1)).norm() / 0.25 - 1));
      }
      if (r + 1 < grid.rows)
        most = std::max(most, std::abs((place(r, c) - place(r + 1, c)).norm() / 0.4 - 1));
    });
    return most;
  }

  Particles<double> particles;
  ClothDescription cloth;
  Sheet<double> sheet;
  kernels::QuarterRows layout{particles.grid()};
  std::vector<double, AlignedAllocator<double>> nodes =
      std::vector<double, AlignedAllocator<double>>(layout.size(), 0.0);
  SheetProjection<double> projection;
};

TEST(SheetProjection, HeldNodesStayAndAFreeSheetKeepsItsMomentum) {
  Projected held(1e5), free(1e5);
  free.particles.inverse_mass.at(0, 0) = 1 / free.particles.mass.at(0, 0);
  free.particles.inverse_mass.at(0, 8) = 1 / free.particles.mass.at(0, 8);
  free.begin();
  const Vec3 before = free.momentum();
  held.projection.project(held.nodes.data());
  free.projection.project(free.nodes.data());
  EXPECT_TRUE(held.move(0, 0).isZero(0));
  EXPECT_TRUE(held.move(0, 8).isZero(0));
  EXPECT_FALSE(held.move(0, 1).isZero(0));
  EXPECT_LT((free.momentum() - before).norm(), 1e-16);
}

TEST(SheetProjection, ASheetAtRestIsNotMoved) {
  Projected sheet(1e5);
  sheet.forget_moves();
  sheet.projection.project(sheet.nodes.data());
  for (const Vec3& move : sheet.moves()) EXPECT_LT(move.norm(), 1e-14);
}

// However stiff, projections again and again lead its springs to their lengths.
TEST(SheetProjection, StiffSpringsComeToTheirLengths) {
  Projected sheet(1e9);
  const double before = sheet.stretch();
  sheet.projection.project(sheet.nodes.data());
  EXPECT_LT(sheet.stretch(), before);
  for (int sweep = 0; sweep < 300; ++sweep) sheet.projection.project(sheet.nodes.data());
  EXPECT_GT(before, 0.02);
  EXPECT_LT(sheet.stretch(), 0.02 * before);
}

// Structural springs are projected last: so stiff, those of the last sweep are left at their lengths.
TEST(SheetProjection, StructuralSpringsAreProjectedLast) {
  Projected sheet(1e12);
  sheet.projection.project(sheet.nodes.data());
  int exact = 0;
  const Grid& grid = sheet.particles.grid();
  each_node(grid, [&](int r, int c) {
    const auto is_exact = [&](int row, int col, double rest) {
      return std::abs((sheet.place(r, c) - sheet.place(row, col)).norm() - rest) < 1e-6 * rest;
    };
    if (c + 1 < grid.cols && is_exact(r, c + 1, 0.25)) ++exact;
    if (r + 1 < grid.rows && is_exact(r + 1, c, 0.4)) ++exact;
  });
  // Of every second row or column one.
  EXPECT_GE(exact, 2 * grid.cols);
}

// What damped springs remember moves the nodes of the next substep; multipliers are forces times h^2.
TEST(SheetProjection, RecallGoesWithTheSquareOfTheSubstep) {
  Projected sheet(1e4, 0.01), longer(1e4, 0.01);
  for (Projected* each : {&sheet, &longer}) {
    each->projection.project(each->nodes.data());
    each->forget_moves();
    if (each == &longer) each->projection.scale_substep(1.01);
    each->projection.recall(each->nodes.data());
  }
  const std::vector<Vec3> moves = sheet.moves(), more = longer.moves();
  double size = 0, off = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    size = std::max(size, moves[i].norm());
    off = std::max(off, (more[i] - 1.01 * 1.01 * moves[i]).norm());
  }
  EXPECT_GT(size, 1e-5);
  EXPECT_LT(off, 1e-3 * size);
}

TEST(SheetProjection, UndampedAndRestartedSheetsRecallNothing) {
  Projected undamped(1e4), restarted(1e4, 0.01);
  for (Projected* sheet : {&undamped, &restarted}) {
    sheet->projection.project(sheet->nodes.data());
    sheet->forget_moves();
  }
  restarted.projection.restart();
  restarted.projection.prepare(restarted.sheet, restarted.particles.mass, restarted.layout, kProjectedStep);
  for (Projected* sheet : {&undamped, &restarted}) {
    sheet->projection.recall(sheet->nodes.data());
    for (const Vec3& move : sheet->moves()) EXPECT_TRUE(move.isZero(0));
  }
}

}  // namespace
}  // namespace weft
