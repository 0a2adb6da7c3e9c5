// Nodes and points between them (ClothPoint).
#include "cloth/sheet/cloth_point.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace weft {
namespace {

/// 3 x 3 nodes of 2 kg, 1 m apart, each with the velocity (1, column row, 0).
Particles<double> small_sheet() {
  Particles<double> particles = test::flat_sheet<double>(3, 3, {2, 2});
  test::each_node(particles.grid(), [&](int r, int c) {
    test::set(particles.velocity, r, c, {1, double(c * r), 0});
    particles.mass.at(r, c) = 2;
    particles.inverse_mass.at(r, c) = 0.5;
  });
  return particles;
}

/// In the cell that begins at node (1, 1): 2 of 8 parts along v, 4 along u.
PointId between(const Particles<double>& particles) {
  return {particles.grid().index(1, 1), 2 * kCellParts + 4};
}

TEST(ClothPoint, OfANodeIsTheNode) {
  Particles<double> particles = small_sheet();
  const ClothPoint<double> point({particles.grid().index(1, 2)}, particles);
  EXPECT_EQ(point.of(kernels::components(std::as_const(particles.position))), Vec3(1, 0, 0));
  EXPECT_EQ(point.mass(), 2);
  EXPECT_EQ(point.free_part(), 1);
  point.shift(kernels::components(particles.velocity), {0, 0, 3});
  EXPECT_EQ(particles.velocity_at(1, 2), Vec3(1, 2, 3));
}

TEST(ClothPoint, IsBilinearBetweenFour) {
  const Particles<double> particles = small_sheet();
  const ClothPoint<double> point(between(particles), particles);
  EXPECT_EQ(point.of(kernels::components(particles.position)), Vec3(0.5, -0.25, 0));
  EXPECT_DOUBLE_EQ(point.of(kernels::components(particles.velocity)).y(), 1.5 * 1.25);
  // 1 / sum(w^2 / m), with the weights 3/8, 3/8, 1/8, 1/8.
  EXPECT_DOUBLE_EQ(point.mass(), 2 / (2 * 9.0 / 64 + 2 * 1.0 / 64));
}

// An impulse J at the point changes its velocity by J / mass, and the nodes' momentum by J.
TEST(ClothPoint, GivesAnImpulseToItsNodes) {
  Particles<double> particles = small_sheet();
  particles.mass.at(1, 2) = 8;
  particles.inverse_mass.at(1, 2) = 0.125;
  const ClothPoint<double> point(between(particles), particles);
  const Vec3 impulse(0.3, -2, 1);
  const auto velocity = [&] { return point.of(kernels::components(std::as_const(particles.velocity))); };
  const auto momentum = [&] {
    Vec3 sum(0, 0, 0);
    test::each_node(particles.grid(),
                    [&](int r, int c) { sum += particles.mass.at(r, c) * particles.velocity_at(r, c); });
    return sum;
  };
  const Vec3 before = velocity(), momentum_before = momentum();
  point.shift(kernels::components(particles.velocity), impulse / point.mass());
  EXPECT_LT((velocity() - before - impulse / point.mass()).norm(), 1e-12);
  EXPECT_LT((momentum() - momentum_before - impulse).norm(), 1e-12);
}

TEST(ClothPoint, LeavesPinnedNodesWhereTheyAre) {
  Particles<double> particles = small_sheet();
  particles.inverse_mass.at(1, 1) = particles.inverse_mass.at(1, 2) = 0;
  const ClothPoint<double> point(between(particles), particles);
  EXPECT_DOUBLE_EQ(point.free_part(), 0.25);
  EXPECT_DOUBLE_EQ(point.mass(), 2 / (2.0 / 64));
  const Vec3 before = point.of(kernels::components(std::as_const(particles.position)));
  point.shift(kernels::components(particles.position), {0, 0, 1});
  EXPECT_EQ(particles.local_position_at(1, 1), Vec3(0, 0, 0));
  const Vec3 moved = point.of(kernels::components(std::as_const(particles.position))) - before;
  EXPECT_LT((moved - Vec3(0, 0, 1)).norm(), 1e-12);
}

TEST(ClothPoint, ResistsAsItsNodesDo) {
  const Particles<double> particles = small_sheet();
  std::vector<double> diagonal(particles.grid().size(), 3.0);
  EXPECT_EQ(ClothPoint<double>({0}, particles).resistance(diagonal.data()), 3);
  // 1 / sum(w^2 / d) in the middle of a cell.
  const ClothPoint<double> middle({0, 4 * kCellParts + 4}, particles);
  EXPECT_DOUBLE_EQ(middle.resistance(diagonal.data()), 12);
  std::vector<double> forces(3 * diagonal.size(), 0.0);
  const kernels::Components<double> f{forces.data(), forces.data() + diagonal.size(),
                                      forces.data() + 2 * diagonal.size()};
  middle.add_force(f, {4, 0, 0});
  EXPECT_EQ(f.x[0], 1);
  EXPECT_EQ(f.x[particles.grid().index(1, 1)], 1);
  EXPECT_EQ(middle.moved_by(f), Vec3(1, 0, 0));
}

}  // namespace
}  // namespace weft
