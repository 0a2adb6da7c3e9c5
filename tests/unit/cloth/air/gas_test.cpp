// Gas shut in a sewn cloth: its volume, Boyle's law, its force, its energy and what explicit methods make of
// it.
#include "cloth/air/gas.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cloth/sheet/diagnostics.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

constexpr double kOutside = Gas<double>::kOutside;
constexpr double kPi = std::numbers::pi;

/// Where the node (r, c) of a bag lies on one of its sides, from -1 to 1 across and down, and which side.
struct Place {
  double x, y;
  bool upper;  ///< u <= 1/2
};
Place place(const Grid& grid, int r, int c) {
  const double u = double(c) / (grid.cols - 1), v = double(r) / (grid.rows - 1);
  return {4 * std::min(u, 1 - u) - 1, 1 - 2 * v, u <= 0.5};
}

/// A bag whose node at a place is at shape(place), of 1 kg a node.
template <class Real, class Shape>
Particles<Real> bag_like(int rows, int cols, Shape shape) {
  Particles<Real> bag = test::flat_sheet<Real>(rows, cols, {2, 1});
  each_node(bag.grid(), [&](int r, int c) { set(bag.position, r, c, shape(place(bag.grid(), r, c))); });
  return bag;
}

/// Domes of height h over the square of 1 m: z = h sin sin.
template <class Real>
Particles<Real> domes(double height, const Vec3& off = {0, 0, 0}) {
  return bag_like<Real>(9, 17, [&](const Place& p) {
    const double z = height * std::cos(kPi / 2 * p.x) * std::cos(kPi / 2 * p.y);
    return Vec3(off + Vec3(p.x / 2, p.y / 2, p.upper ? z : -z));
  });
}

/// A crumpled bag, its seam closed.
Particles<double> crumpled_bag(unsigned seed = 3) {
  Particles<double> bag = test::flat_sheet<double>(9, 17, {2, 1});
  test::randomise(bag.position, -0.5, 0.5, seed);
  test::randomise(bag.velocity, -1, 1, seed + 1);
  Seam<double>(bag.grid()).join(bag);
  return bag;
}

InflationEffect gas_of(double pressure, double volume, double fill_time = 0) {
  return {pressure, volume, fill_time};
}

TEST(EnclosedVolume, OfDomesIsTheTrapezoidRules) {
  // Patches over a regular grid of n cells a side: both domes have h / n^2 times the square of the sum of
  // sin(pi k / n), which is cot(pi / 2n). n = 8.
  const double expected = 2 * 0.2 / 64 / std::pow(std::tan(kPi / 16), 2);
  EXPECT_NEAR(enclosed_volume(domes<double>(0.2).position), expected, 1e-15);
  // Anywhere: rounding of the gradient, 1e-16 m2 a node, times 1000 m.
  EXPECT_NEAR(enclosed_volume(domes<double>(0.2, {1000, -700, 300}).position), expected, 1e-11);
  // Single precision, at 10 m: positions to 1e-6 m on 2 m2.
  EXPECT_NEAR(enclosed_volume(domes<float>(0.2, {10, -7, 3}).position), expected, 2e-6);
}

TEST(EnclosedVolume, InsideOutIsBelowZero) {
  EXPECT_NEAR(enclosed_volume(domes<double>(-0.2).position), -enclosed_volume(domes<double>(0.2).position),
              1e-15);
}

TEST(EnclosedVolume, OfASphereConvergesAsTheSquareOfTheCells) {
  // The square's disk (elliptical grid mapping), bent to half a sphere of 1 m.
  const auto error = [](int n) {
    const Particles<double> ball = bag_like<double>(n + 1, 2 * n + 1, [](const Place& p) {
      const Vec2 disk(p.x * std::sqrt(1 - p.y * p.y / 2), p.y * std::sqrt(1 - p.x * p.x / 2));
      const double angle = kPi / 2 * std::min(1.0, disk.norm());
      const Vec2 way = disk.norm() > 0 ? Vec2(disk.normalized()) : Vec2(0, 0);
      return Vec3(std::sin(angle) * way.x(), std::sin(angle) * way.y(),
                  p.upper ? std::cos(angle) : -std::cos(angle));
    });
    return 4.0 / 3 * kPi - enclosed_volume(ball.position);
  };
  EXPECT_GT(error(32), 0);  // chords lie inside
  EXPECT_LT(error(64), 0.005);
  EXPECT_NEAR(error(32) / error(64), 4, 0.1);
}

TEST(Gas, KeepsPressureTimesVolume) {
  const Gas<double> gas(gas_of(5000, 0.2), 0, 0);
  EXPECT_NEAR(gas.pressure(0.2, 1), 5000, 1e-9);
  EXPECT_NEAR(gas.pressure(0.1, 1), 2 * 106325 - 101325, 1e-9);  // half the volume
  EXPECT_NEAR(gas.pressure(0.4, 1), 106325.0 / 2 - 101325, 1e-9);
  EXPECT_NEAR(gas.pressure(-1, 1), 106325e3 - 101325, 1e-3);  // no less than a thousandth of the volume
}

TEST(Gas, IsPouredInAtAnEvenRate) {
  const Gas<double> gas(gas_of(0, 0.2, 2), 0.1 * kOutside, 5);
  EXPECT_NEAR(gas.pressure(0.1, 5), 0, 1e-9);
  EXPECT_NEAR(gas.pressure(0.15, 6), 0, 1e-9);
  EXPECT_NEAR(gas.pressure(0.2, 7), 0, 1e-9);
  EXPECT_NEAR(gas.pressure(0.2, 70), 0, 1e-9);
  EXPECT_TRUE(gas.fills(6.9));
  EXPECT_FALSE(gas.fills(7));
}

TEST(Gas, ForceIsTheEnergysGradient) {
  // U = p_a V - c ln V by central differences, 1e-5 m: truncation 1e-10 of c / V^3, rounding 1e-16 c / 1e-5.
  Particles<double> bag = domes<double>(0.3);
  const Seam<double> seam(bag.grid());
  const double c = (kOutside + 3000) * 0.2, step = 1e-5;
  Gas<double> gas(gas_of(3000, 0.2), 0, 0);
  VectorField<double> force(bag.grid());
  gas.add_force(bag, seam, 1, force);
  const auto energy = [&] {
    const double volume = enclosed_volume(bag.position);
    return kOutside * volume - c * std::log(volume);
  };
  for (const auto& [r, col] : {std::pair{3, 4}, {7, 12}, {1, 15}, {4, 8}}) {
    const Vec3 here = get(bag.position, r, col);
    for (int axis = 0; axis < 3; ++axis) {
      set(bag.position, r, col, here + step * Vec3::Unit(axis));
      const double more = energy();
      set(bag.position, r, col, here - step * Vec3::Unit(axis));
      EXPECT_NEAR(get(force, r, col)[axis], -(more - energy()) / (2 * step), 1e-4);
    }
    set(bag.position, r, col, here);
  }
  EXPECT_NEAR(gas.stiffness(), c / std::pow(enclosed_volume(bag.position), 2), 1e-6 * gas.stiffness());
}

TEST(Gas, PushesTheBagNowhereAndTurnsItNot) {
  const Particles<double> bag = crumpled_bag();
  Gas<double> gas(gas_of(1000, 0.01), 0, 0);
  VectorField<double> force(bag.grid());
  gas.add_force(bag, Seam<double>(bag.grid()), 1, force);
  Vec3 total = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  each_node(bag.grid(), [&](int r, int c) {
    total += get(force, r, c);
    torque += get(bag.position, r, c).cross(get(force, r, c));
    size = std::max(size, get(force, r, c).norm());
  });
  EXPECT_GT(size, 10);
  EXPECT_LT(total.norm(), 1e-13 * size);
  EXPECT_LT(torque.norm(), 1e-13 * size);
}

TEST(Gas, ModelErrorIsWhatTheLinearisationLeavesOut) {
  const Particles<double> bag = domes<double>(0.2);
  const Seam<double> seam(bag.grid());
  const double c = (kOutside + 3000) * 0.2;
  for (const double size : {1e-3, 1e-2, 0.05}) {
    Particles<double> moved = bag;
    test::randomise(moved.velocity, -size, size, 9);  // the change
    seam.join(moved);
    Gas<double> gas(gas_of(3000, 0.2), 0, 0);
    VectorField<double> force(bag.grid());
    gas.add_force(bag, seam, 1, force);
    double linear = 0, along = 0;
    each_node(bag.grid(), [&](int r, int col) {
      const Vec3 change = get(moved.velocity, r, col);
      linear -= get(force, r, col).dot(change);
      along += get(gas.gradient(), r, col).dot(change);
      set(moved.position, r, col, get(bag.position, r, col) + change);
    });
    const double before = enclosed_volume(bag.position), after = enclosed_volume(moved.position);
    const double expected = kOutside * (after - before) - c * std::log(after / before) - linear -
                            gas.stiffness() * along * along / 2;
    // The two volumes here are right to some 1e-15 m3, at c / V = 2.6e5 Pa.
    EXPECT_NEAR(gas.model_error(kernels::components(bag.position), kernels::components(moved.velocity)),
                expected, 3e-10 + 1e-9 * std::abs(expected));
    EXPECT_GT(std::abs(expected), 1e-6);
  }
}

TEST(Gas, PushIsThatOfThePressureAfterIt) {
  // From its equation: what a node is given is h p g / m, with V = V* + h^2 p g . M^-1 g and p V = c - p_a V.
  for (const double h : {1e-5, 1e-3, 0.1}) {
    Particles<double> bag = crumpled_bag();
    const Particles<double> before = bag;
    const Seam<double> seam(bag.grid());
    Gas<double> gas(gas_of(1000, 0.01), 0, 0);
    gas.push(bag, seam, 1, h);
    double squared = 0, pushed = 0;
    each_node(bag.grid(), [&](int r, int c) {
      const Vec3 gradient = get(gas.gradient(), r, c),
                 given = get(bag.velocity, r, c) - get(before.velocity, r, c);
      squared += gradient.squaredNorm();
      pushed += gradient.dot(given) / h;
      EXPECT_LT((get(bag.position, r, c) - get(before.position, r, c) - h * given).norm(), 1e-12);
    });
    const double pressure = pushed / squared;
    const double then = enclosed_volume(before.position) + h * h * pressure * squared;
    EXPECT_GT(then, 0);
    EXPECT_NEAR((pressure + kOutside) * then, (kOutside + 1000) * 0.01, 1e-6 * kOutside * 0.01) << h;
    EXPECT_LT((linear_momentum(bag) - linear_momentum(before)).norm(), 1e-9 * (1 + h * std::abs(pressure)));
  }
}

TEST(Gas, PushLeavesHeldNodesAlone) {
  Particles<double> bag = domes<double>(0.1);
  bag.inverse_mass.at(4, 4) = 0;
  const Vec3 held = get(bag.position, 4, 4);
  Gas<double>(gas_of(5000, 0.2), 0, 0).push(bag, Seam<double>(bag.grid()), 1, 0.01);
  EXPECT_EQ(get(bag.position, 4, 4), held);
  EXPECT_EQ(get(bag.velocity, 4, 4), Vec3(0, 0, 0));
  EXPECT_GT(get(bag.velocity, 4, 5).z(), 0);
}

}  // namespace
}  // namespace weft
