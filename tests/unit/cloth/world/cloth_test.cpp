// One cloth: where it starts, what holds it, how it changes level; a hung sheet's stretch (T9), a falling
// one's speed (T16).
#include "cloth/world/cloth.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cloth/sheet/diagnostics.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::kFrame;
using test::set;

Cloth<double> make(const ClothDescription& description, const std::vector<EffectDescription>& effects = {},
                   const SymplecticEulerDescription& stepping = {}, std::uint64_t seed = 1) {
  return {description, effects, stepping, seed};
}

ClothDescription at_level(int level) {
  ClothDescription description;
  description.min_level = kMinLevel;
  description.max_level = kMaxLevel;
  description.initial_level = level;
  return description;
}

/// The held nodes, as (row, column).
template <class Real>
std::vector<std::pair<int, int>> held(const Cloth<Real>& cloth) {
  std::vector<std::pair<int, int>> nodes;
  each_node(cloth.particles().grid(), [&](int r, int c) {
    if (cloth.particles().inverse_mass.at(r, c) == 0) nodes.emplace_back(r, c);
  });
  return nodes;
}

void advance(Cloth<double>& cloth, int steps, const Wind& wind = {}) {
  std::vector<Solid> no_solids;
  for (int step = 0; step < steps; ++step) cloth.advance(no_solids, Air(wind, 1), step * kFrame, kFrame);
}

// --- Start ---

TEST(ClothStart, LiesFlatAndCentredWithUAlongXAndVDownwards) {
  ClothDescription description = at_level(3);
  description.size = {4, 2};
  description.position = {10, 20, 30};
  const Cloth<double> cloth = make(description);
  EXPECT_EQ(cloth.particles().position_at(0, 0), Vec3(8, 21, 30));
  EXPECT_EQ(cloth.particles().position_at(0, 8), Vec3(12, 21, 30));
  EXPECT_EQ(cloth.particles().position_at(8, 0), Vec3(8, 19, 30));
  EXPECT_EQ(cloth.particles().position_at(4, 4), Vec3(10, 20, 30));
  EXPECT_EQ(cloth.particles().position_at(2, 1), Vec3(8.5, 20.5, 30));
  EXPECT_EQ(cloth.level(), 3);
}

TEST(ClothStart, IsTurnedByItsOrientation) {
  // A quarter turn about x lays the hanging sheet down: its v axis (0, -1, 0) becomes (0, 0, -1).
  ClothDescription description = at_level(3);
  description.position = {0, 1, 0};
  description.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  const Cloth<double> cloth = make(description);
  EXPECT_LT((cloth.particles().position_at(0, 0) - Vec3(-1, 1, 1)).norm(), 1e-15);
  EXPECT_LT((cloth.particles().position_at(8, 0) - Vec3(-1, 1, -1)).norm(), 1e-15);
}

TEST(ClothStart, TakesGivenNodesButItsRestLengthsFromTheSize) {
  ClothDescription description = at_level(3);
  for (int i = 0; i < 81; ++i) description.nodes.emplace_back(i % 9, i / 9, 0.5 * i);
  const Cloth<double> cloth = make(description);
  each_node(cloth.particles().grid(), [&](int r, int c) {
    EXPECT_EQ(cloth.particles().position_at(r, c), Vec3(c, r, 0.5 * (9 * r + c)));
  });
  for (const SpringFamily& family : cloth.springs().families()) {
    EXPECT_DOUBLE_EQ(family.rest_length, 0.25 * std::hypot(family.rows, family.cols));
  }
}

TEST(ClothStart, FreeNodesHaveTheGivenVelocity) {
  ClothDescription description = at_level(3);
  description.velocity = {1, 2, 3};
  description.pins = {{0, 0, 0, 0}};
  const Cloth<double> cloth = make(description);
  EXPECT_EQ(cloth.particles().velocity_at(0, 0), Vec3(0, 0, 0));
  EXPECT_EQ(cloth.particles().velocity_at(0, 1), Vec3(1, 2, 3));
}

TEST(ClothStart, IsPerturbedAlongTheNormalBySeed) {
  ClothDescription description = at_level(4);
  description.orientation =
      Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));  // normal +z -> +x
  const Cloth<double> flat = make(description);
  description.perturbation = 0.01;
  description.pins = {{0, 0, 0, 0}};
  const Cloth<double> one = make(description, {}, {}, 1), again = make(description, {}, {}, 1);
  const Cloth<double> two = make(description, {}, {}, 2);
  double largest = 0;
  each_node(one.particles().grid(), [&](int r, int c) {
    const Vec3 offset = one.particles().position_at(r, c) - flat.particles().position_at(r, c);
    EXPECT_LT(std::abs(offset.y()) + std::abs(offset.z()), 1e-15);
    EXPECT_LE(std::abs(offset.x()), 0.01 + 1e-15);
    largest = std::max(largest, std::abs(offset.x()));
  });
  EXPECT_GT(largest, 0.009);  // 288 uniform draws all below 0.9 of the bound: probability 0.9^288 = 7e-14
  EXPECT_LT((one.particles().position_at(0, 0) - flat.particles().position_at(0, 0)).norm(), 1e-15);  // held
  EXPECT_TRUE(test::same_state(one.particles(), again.particles()));
  EXPECT_FALSE(test::same_state(one.particles(), two.particles()));
}

TEST(ClothStart, WeighsItsDensityTimesItsArea) {
  ClothDescription description = at_level(3);
  description.size = {3, 0.5};
  description.material.density = 0.2;
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    description.discretization = d;
    const Cloth<double> cloth = make(description);
    EXPECT_DOUBLE_EQ(cloth.total_mass(), 0.3);
    EXPECT_NEAR(test::exact_sum(cloth.particles().mass), 0.3, 1e-15);
  }
}

// --- Pins ---

TEST(Pins, ACornerIsOneNodeAtEveryLevel) {
  ClothDescription description;
  for (int level = kMinLevel; level <= 6; ++level) {
    const int last = 1 << level;
    description = at_level(level);
    description.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}, {1, 1, 1, 1}};
    const std::vector<std::pair<int, int>> expected{{0, 0}, {0, last}, {last, last}};
    EXPECT_EQ(held(make(description)), expected) << level;
  }
}

TEST(Pins, AnEdgeIsAllItsNodes) {
  for (int level = kMinLevel; level <= 6; ++level) {
    ClothDescription description = at_level(level);
    description.pins = {{0, 1, 0, 0}};
    const auto nodes = held(make(description));
    ASSERT_EQ(nodes.size(), std::size_t((1 << level) + 1));
    for (const auto& [r, c] : nodes) EXPECT_EQ(r, 0);
  }
}

TEST(Pins, ARectangleIsClosed) {
  // u in [1/4, 1/2], v in [1/2, 3/4] at level 3: columns 2..4, rows 4..6.
  ClothDescription description = at_level(3);
  description.pins = {{0.25, 0.5, 0.5, 0.75}};
  const std::vector<std::pair<int, int>> expected{{4, 2}, {4, 3}, {4, 4}, {5, 2}, {5, 3},
                                                  {5, 4}, {6, 2}, {6, 3}, {6, 4}};
  EXPECT_EQ(held(make(description)), expected);
}

TEST(Pins, APointBetweenNodesIsTheNearestOne) {
  // (u, v) = (0.3, 0.7): level 3: (2.4, 5.6) -> column 2, row 6; level 4: (4.8, 11.2) -> 5, 11; level 5:
  // (9.6, 22.4) -> 10, 22.
  struct Expected {
    int level, row, col;
  };
  for (const Expected& e : {Expected{3, 6, 2}, Expected{4, 11, 5}, Expected{5, 22, 10}}) {
    ClothDescription description = at_level(e.level);
    description.pins = {{0.3, 0.3, 0.7, 0.7}};
    EXPECT_EQ(held(make(description)), (std::vector<std::pair<int, int>>{{e.row, e.col}})) << e.level;
  }
}

TEST(Pins, KeepTheirMassForEquation9) {
  ClothDescription description = at_level(4);
  description.pins = {{0, 1, 0, 0}};
  description.discretization = Discretization::paper;
  const Cloth<double> cloth = make(description);
  EXPECT_DOUBLE_EQ(cloth.particles().mass.at(0, 3), 0.4 / 289);
}

TEST(Pins, HoldThroughMotionAndLevelChanges) {
  ClothDescription description = at_level(4);
  description.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  Cloth<double> cloth = make(description, {GravityEffect{}});
  for (int level : {5, 4, 3, 5}) {
    advance(cloth, 5);
    cloth.request_level(level);
    cloth.apply_pending_level();
    const int last = 1 << level;
    ASSERT_EQ(held(cloth), (std::vector<std::pair<int, int>>{{0, 0}, {0, last}})) << level;
    EXPECT_EQ(cloth.particles().position_at(0, 0), Vec3(-1, 1, 0));
    EXPECT_EQ(cloth.particles().position_at(0, last), Vec3(1, 1, 0));
    EXPECT_EQ(cloth.particles().velocity_at(0, 0), Vec3(0, 0, 0));
  }
  EXPECT_LT(cloth.particles().position_at(16, 16).y(), -0.001);  // the rest fell
}

TEST(Pins, ANodeHeldOnlyFromNowOnStopsWhereItIs) {
  // The whole top edge is held; a split's new edge nodes are means of held ones, and must be held and at
  // rest.
  ClothDescription description = at_level(4);
  description.pins = {{0, 1, 0, 0}};
  Cloth<double> cloth = make(description, {GravityEffect{}});
  advance(cloth, 5);
  cloth.request_level(5);
  ASSERT_TRUE(cloth.apply_pending_level());
  const Particles<double> before = cloth.particles();
  advance(cloth, 5);
  for (int c = 0; c <= 32; ++c) {
    EXPECT_EQ(cloth.particles().inverse_mass.at(0, c), 0.0);
    EXPECT_EQ(cloth.particles().position_at(0, c), before.position_at(0, c));
    EXPECT_EQ(cloth.particles().velocity_at(0, c), Vec3(0, 0, 0));
  }
}

// --- Levels ---

TEST(ClothLevels, ARequestIsReachedWhenApplied) {
  Cloth<double> cloth = make(at_level(4));
  EXPECT_FALSE(cloth.apply_pending_level());
  cloth.request_level(6);
  EXPECT_EQ(cloth.level(), 4);
  EXPECT_TRUE(cloth.apply_pending_level());
  EXPECT_EQ(cloth.level(), 6);
  EXPECT_EQ(cloth.particles().grid(), BaseCells{}.at(6));
  EXPECT_FALSE(cloth.apply_pending_level());
  cloth.request_level(6);
  EXPECT_FALSE(cloth.apply_pending_level());  // it is there already
}

TEST(ClothLevels, RequestsAreClampedToTheClothsLimits) {
  ClothDescription description;  // 4 to 6
  Cloth<double> cloth = make(description);
  cloth.request_level(100);
  cloth.apply_pending_level();
  EXPECT_EQ(cloth.level(), 6);
  cloth.request_level(-5);
  cloth.apply_pending_level();
  EXPECT_EQ(cloth.level(), 4);
}

TEST(ClothLevels, SplitThenMergeGivesTheSamePlacesAndMasses) {
  for (Discretization d : {Discretization::paper, Discretization::continuum}) {
    for (const BaseCells base : {BaseCells{1, 1}, BaseCells{2, 1}}) {
      ClothDescription description = at_level(4);
      description.discretization = d;
      description.base_cells = base;
      description.size = {2.0 * base.cols, 2.0 * base.rows};
      description.pins = {{0, 0, 0, 0}, {0.4, 0.6, 1, 1}};
      Cloth<double> cloth = make(description, {GravityEffect{}});
      advance(cloth, 10);
      const Particles<double> before = cloth.particles();
      cloth.request_level(6);
      ASSERT_TRUE(cloth.apply_pending_level());
      EXPECT_EQ(cloth.particles().grid(), base.at(6));
      cloth.request_level(4);
      ASSERT_TRUE(cloth.apply_pending_level());
      EXPECT_TRUE(test::same_bits(before.position, cloth.particles().position));
      if (d == Discretization::paper) {
        EXPECT_TRUE(test::same_state(before, cloth.particles()));
      } else {  // velocities by momentum: they are smoothed
        EXPECT_LE(kinetic_energy(cloth.particles()), kinetic_energy(before));
      }
      each_node(before.grid(), [&](int r, int c) {
        EXPECT_EQ(before.mass.at(r, c), cloth.particles().mass.at(r, c));
        EXPECT_EQ(before.inverse_mass.at(r, c), cloth.particles().inverse_mass.at(r, c));
      });
    }
  }
}

TEST(ClothLevels, TotalMassIsTheSameBitsAtEveryLevel) {
  // Eq. 9: the cloth's own total never changes; with masses by area the nodes' exact sum does not either.
  ClothDescription description = at_level(3);
  description.material.density = 0.07;
  Cloth<double> cloth = make(description);
  const double total = cloth.total_mass();
  for (int level = kMinLevel; level <= kMaxLevel; ++level) {
    cloth.request_level(level);
    cloth.apply_pending_level();
    EXPECT_EQ(cloth.total_mass(), total);
    EXPECT_EQ(test::exact_sum(cloth.particles().mass), total) << level;
  }
}

TEST(ClothLevels, SpringsBelongToTheNewLevel) {
  Cloth<double> cloth = make(at_level(3));
  for (int level = kMinLevel; level <= 6; ++level) {
    cloth.request_level(level);
    cloth.apply_pending_level();
    for (const SpringFamily& family : cloth.springs().families()) {
      EXPECT_DOUBLE_EQ(family.rest_length, 2.0 / (1 << level) * std::hypot(family.rows, family.cols))
          << level;
    }
  }
}

TEST(ClothLevels, AFlatSheetInFallStaysFlatThroughThem) {
  // No force but gravity: whatever the level, every node has fallen by g dt^2 n(n+1)/2 (Eq. 8 of equal
  // values).
  ClothDescription description = at_level(4);
  description.material.structural = description.material.shear = description.material.bending = 0;
  Cloth<double> cloth = make(description, {GravityEffect{}}, {1, 0.9});
  int n = 0;
  for (int level : {5, 6, 4, 3, 5}) {
    cloth.request_level(level);
    cloth.apply_pending_level();
    advance(cloth, 4);
    n += 4;
    const double fallen = 9.81 * kFrame * kFrame * n * (n + 1) / 2;
    EXPECT_NEAR(centre(cloth.particles()).y(), -fallen, 1e-12) << level;
    EXPECT_NEAR(cloth.particles().position_at(0, 0).y(), 1 - fallen, 1e-12) << level;
  }
}

// --- Truths ---

/// How far the bottom of a 2 m x 2 m sheet of 0.1 kg/m2 sinks when hung by its top edge, structural springs
/// only, m.
double hung_stretch(int level, Discretization discretization) {
  ClothDescription description = at_level(level);
  description.discretization = discretization;
  description.material.shear = description.material.bending = 0;
  // The lowest mode along the sheet: w = (pi / 2L) sqrt(Y / rho) = 175.6 /s. Damped critically, c / rho = 2
  // w, it is at rest (e^-88) after half a second. Per particle: the same over the n particles of 4 m2.
  description.material.damping = 2 * 175.6 * 0.1;
  if (discretization == Discretization::paper)
    description.material.damping *= 4.0 / BaseCells{}.at(level).nodes();
  description.pins = {{0, 1, 0, 0}};
  Cloth<double> cloth = make(description, {GravityEffect{}, DampingEffect{}});
  advance(cloth, 30);
  EXPECT_LT(kinetic_energy(cloth.particles()), 1e-20);
  const int last = cloth.particles().grid().rows - 1;
  return -1 - cloth.particles().position_at(last, last / 2).y();
}

TEST(HungSheet, StretchesAsTheContinuumAtEveryLevel) {
  // T9: rho g L^2 / (2 Y) = 3.924e-4 m, exact on every grid, since half masses and half springs at the border
  // make the sum of the loads below each spring the integral.
  for (int level : {3, 4, 5})
    EXPECT_NEAR(hung_stretch(level, Discretization::continuum), 3.924e-4, 1e-10) << level;
}

TEST(HungSheet, ThePapersMassesMissItByTheCount) {
  // m = rho L^2 / (N+1)^2 per node and springs of k = Y: sum over j of (N - j + 1) m g / k = rho g L^2 / (2
  // Y) N / (N+1).
  for (int level : {3, 4}) {
    const double n = 1 << level;
    EXPECT_NEAR(hung_stretch(level, Discretization::paper), 3.924e-4 * n / (n + 1), 1e-10) << level;
  }
}

TEST(FallingSheet, ReachesItsTerminalSpeed) {
  // T16: face on, rho_air 1.225, C 1.2: sqrt(2 rho g / (rho_air C)) = 1.155290 m/s; v = v_t tanh(g t / v_t),
  // so at 3 s the rest is e^-51.
  ClothDescription description = at_level(4);
  description.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  Cloth<double> cloth = make(description, {GravityEffect{}, AerodynamicsEffect{}});
  advance(cloth, 180);
  each_node(cloth.particles().grid(), [&](int r, int c) {
    EXPECT_NEAR(cloth.particles().velocity_at(r, c).y(), -1.155290, 1e-6) << r << ", " << c;
  });
}

TEST(FallingSheet, DriftsWithTheWind) {
  // Face on to a wind and no gravity: it ends with the wind's velocity, 1 / (rho_air C w t / (2 rho)) short
  // of it.
  Cloth<double> cloth = make(at_level(4), {AerodynamicsEffect{}});
  advance(cloth, 600, {{0, 0, -1}, 3.0});
  const double reached = -linear_momentum(cloth.particles()).z() / cloth.total_mass();
  // dv/dt = c (w - v)^2 with c = 1.225 * 1.2 / (2 * 0.1) = 7.35 /m: w - v = w / (1 + c w t) = 3 / 221.5 after
  // 10 s.
  EXPECT_NEAR(3.0 - reached, 3.0 / 221.5, 3e-4);
}

}  // namespace
}  // namespace weft
