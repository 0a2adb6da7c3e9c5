#include "cloth/integrators/momentum_keeper.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::Rig;
using test::same_bits;
using test::set;

constexpr double kKeptStep = 1.0 / 60;

/// A sheet in free motion; a substep of it that errs. Without springs, so that what it has to turn by is the
/// energy that the errors took.
struct Kept {
  explicit Kept(const std::vector<EffectDescription>& effects = {}, bool hung = false)
      : rig((hung ? test::hung_rig<double> : test::sheet_rig<double>)(6, 8, BackwardEulerDescription{},
                                                                      effects, test::without_springs())) {
    test::randomise(rig.particles.velocity, -2, 3, 2);
    rig.particles.place = {100, -20, 5};
  }
  void begin() { keeper.begin_substep(rig.particles, rig.forces(0), rig.solids); }
  /// Nodes go on by h v, and a tenth of what they do is lost, some more of it at random.
  void err(std::uint64_t seed) {
    start = rig.particles.position;
    VectorField<double> off(start.grid());
    test::randomise(off, -0.02, 0.03, seed);
    each_node(start.grid(), [&](int r, int c) {
      set(rig.particles.position, r, c, get(start, r, c) + kKeptStep * rig.particles.velocity_at(r, c));
      set(rig.particles.velocity, r, c, 0.9 * rig.particles.velocity_at(r, c) + get(off, r, c));
    });
  }
  double end(const Field<double>* second_order = nullptr, bool rubs = false) {
    const MomentumKeeper<double>::Member member = as_member(second_order, rubs);
    return MomentumKeeper<double>::end_substep({&member, 1}, kKeptStep);
  }
  MomentumKeeper<double>::Member as_member(const Field<double>* second_order = nullptr, bool rubs = false) {
    freedom = is_held(rig.particles) ? Freedom::none() : freedom_beside(pushes, rig.particles);
    forces = rig.forces(0);
    return {&keeper,  &rig.particles, &forces,      &rig.solids, &start,     nullptr,
            &freedom, rubs,           second_order, 1,           hung_torque};
  }
  /// A floor pushes all nodes up.
  void lay_on_floor() {
    each_node(rig.particles.grid(), [&](int r, int c) {
      pushes.push_back({rig.particles.position_at(r, c), {0, 1, 0}});
    });
  }
  Vec3 momentum() const { return linear_momentum(rig.particles); }
  /// About the world's origin.
  Vec3 spin() const { return angular_momentum(rig.particles); }
  Vec3 spin_about(const Vec3& point) const { return spin() - point.cross(momentum()); }

  Rig<double> rig;
  MomentumKeeper<double> keeper;
  VectorField<double> start;
  std::vector<Push> pushes;
  Freedom freedom = Freedom::none();
  Forces<double> forces;
  Vec3 hung_torque{0, 0, 0};
};

void expect_near(const Vec3& found, const Vec3& expected) {
  EXPECT_LT((found - expected).norm(), 1e-12 * (1 + expected.norm()))
      << found.transpose() << " instead of " << expected.transpose();
}

TEST(MomentumKeeper, WithoutForcesMomentaStay) {
  Kept cloth;
  const Vec3 momentum = cloth.momentum(), spin = cloth.spin();
  cloth.begin();
  cloth.err(5);
  ASSERT_GT((cloth.momentum() - momentum).norm(), 0.01);
  ASSERT_GT((cloth.spin() - spin).norm(), 0.01);
  EXPECT_EQ(cloth.end(), 1);
  expect_near(cloth.momentum(), momentum);
  expect_near(cloth.spin(), spin);
}

// What soft pins on bodies that do not turn twist the cloth by is given to it: h T.
TEST(MomentumKeeper, WhatHangsTwistsTheCloth) {
  Kept cloth;
  cloth.hung_torque = {0.2, -0.1, 0.3};
  const Vec3 momentum = cloth.momentum(), spin = cloth.spin();
  cloth.begin();
  cloth.err(5);
  cloth.end();
  expect_near(cloth.momentum(), momentum);
  expect_near(cloth.spin(), spin + kKeptStep * cloth.hung_torque);
}

// Of two that are stepped together what they have together stays, and their motion beside each other is as
// the solve has left it but for a rigid motion of both.
TEST(MomentumKeeper, MomentaOfAllTogetherStay) {
  Kept one, other;
  other.rig.particles.place += Vec3(1, 2, -1);
  const Vec3 momentum = one.momentum() + other.momentum(), spin = one.spin() + other.spin();
  for (Kept* cloth : {&one, &other}) cloth->begin();
  one.err(5);
  other.err(6);
  const Vec3 left = one.momentum();
  ASSERT_GT((one.momentum() + other.momentum() - momentum).norm(), 0.01);
  const Vec3 beside = one.rig.particles.velocity_at(2, 3) - other.rig.particles.velocity_at(2, 3),
             apart = one.rig.particles.position_at(2, 3) - other.rig.particles.position_at(2, 3);
  const std::array members{one.as_member(), other.as_member()};
  EXPECT_EQ(MomentumKeeper<double>::end_substep(members, kKeptStep), 1);
  expect_near(one.momentum() + other.momentum(), momentum);
  expect_near(one.spin() + other.spin(), spin);
  EXPECT_GT((one.momentum() - left).norm(), 1e-3);
  const Vec3 added = one.rig.particles.velocity_at(2, 3) - other.rig.particles.velocity_at(2, 3) - beside;
  EXPECT_NEAR(added.dot(apart), 0, 1e-12) << "a rigid motion changes no distance";
}

// What it adds strains nothing: it changes no distance.
TEST(MomentumKeeper, AddsARigidMotion) {
  Kept cloth;
  cloth.begin();
  cloth.err(5);
  const Particles<double> before = cloth.rig.particles;
  cloth.end();
  const Particles<double>& after = cloth.rig.particles;
  EXPECT_TRUE(same_bits(after.position, before.position));
  each_node(after.grid(), [&](int r, int c) {
    for (const auto& other : {std::pair{0, 0}, {5, 7}, {2, 3}}) {
      const Vec3 d = after.position_at(r, c) - after.position_at(other.first, other.second);
      const Vec3 added = after.velocity_at(r, c) - before.velocity_at(r, c) -
                         after.velocity_at(other.first, other.second) +
                         before.velocity_at(other.first, other.second);
      EXPECT_NEAR(d.dot(added), 0, 1e-13);
    }
  });
}

// Backward Euler's formula: h times the effects' forces where the substep ends. About the centre of mass
// gravity has no torque.
TEST(MomentumKeeper, EffectsChangeMomentaByBackwardEulersFormula) {
  Kept cloth({GravityEffect{}});
  const Vec3 centre = centre_of_mass(cloth.rig.particles), momentum = cloth.momentum(), spin = cloth.spin();
  cloth.begin();
  cloth.err(6);
  const Vec3 weight = total_mass(cloth.rig.particles) * standard_gravity();
  const Vec3 end = centre_of_mass(cloth.rig.particles);
  cloth.end();
  expect_near(cloth.momentum(), momentum + kKeptStep * weight);
  expect_near(cloth.spin() - end.cross(cloth.momentum()), spin - centre.cross(momentum));
}

// BDF2: p2 = (4 p1 - p0 + 2 h F) / 3, where all nodes are stepped by that.
TEST(MomentumKeeper, BDF2sFormulaIsKeptWhereAllNodesAreSteppedByIt) {
  for (const bool all : {true, false}) {
    Kept cloth({GravityEffect{}});
    const Vec3 first = cloth.momentum();
    cloth.begin();
    cloth.err(6);
    // Between substeps it may have got something that no force explains.
    const Vec3 second = cloth.momentum();
    Field<double> second_order(cloth.rig.particles.grid());
    second_order.fill(1);
    if (!all) second_order.at(2, 2) = 0;
    cloth.begin();
    cloth.err(7);
    cloth.end(&second_order);
    const Vec3 gained = kKeptStep * total_mass(cloth.rig.particles) * standard_gravity();
    expect_near(cloth.momentum(), all ? Vec3((4 * second - first + 2 * gained) / 3) : Vec3(second + gained));
  }
}

// BDF2 of what the cloth has about its own centre, where gravity has no lever: s2 = (4 s1 - s0) / 3.
TEST(MomentumKeeper, BDF2sFormulaIsKeptOfAngularMomentumToo) {
  for (const bool all : {true, false}) {
    Kept cloth({GravityEffect{}});
    const auto own = [&] { return cloth.spin_about(centre_of_mass(cloth.rig.particles)); };
    const Vec3 first = own();
    cloth.begin();
    cloth.err(6);
    const Vec3 second = own();
    ASSERT_GT((second - first).norm(), 1e-3);
    Field<double> second_order(cloth.rig.particles.grid());
    second_order.fill(1);
    if (!all) second_order.at(2, 2) = 0;
    cloth.begin();
    cloth.err(7);
    cloth.end(&second_order);
    expect_near(own(), all ? Vec3((4 * second - first) / 3) : second);
  }
}

/// Draws one node by a force that is the same everywhere, and all nodes to a place by their masses.
struct Draw : Effect<double> {
  Vec3 pull{0, 0, 0};   // N
  double rate = 0;      // 1/s2
  Vec3 place{0, 0, 0};  // m
  const char* name() const override { return "draw"; }
  bool holds() const override { return true; }
  void add_forces(const Particles<double>& particles, const EffectContext&,
                  VectorField<double>& sum) const override {
    each_node(particles.grid(), [&](int r, int c) {
      const Vec3 to = rate * particles.mass.at(r, c) * (place - particles.position_at(r, c));
      set(sum, r, c, get(sum, r, c) + to + (r == 1 && c == 2 ? pull : Vec3(0, 0, 0)));
    });
  }
  double max_damping_rate(const Particles<double>&, const EffectContext&) const override {
    return std::sqrt(rate);
  }
  void add_stiffness(const Particles<double>& particles, const EffectContext&,
                     double* stiffness) const override {
    const Grid& grid = particles.grid();
    each_node(grid, [&](int r, int c) { stiffness[grid.index(r, c)] += rate * particles.mass.at(r, c); });
  }
};

/// A drawn sheet in its second substep, by BDF2 or by backward Euler, whose solve has put it aside, too.
struct Drawn {
  Drawn(const Draw& draw, bool by_bdf2) : second_order(cloth.rig.particles.grid()) {
    second_order.fill(by_bdf2 ? 1 : 0);
    cloth.rig.effects.push_back(std::make_unique<Draw>(draw));
    const Vec3 p0 = cloth.momentum(), spin0 = cloth.spin();
    cloth.begin();
    cloth.err(6);
    const Vec3 p1 = cloth.momentum(), spin1 = cloth.spin();
    centre = centre_of_mass(cloth.rig.particles);
    cloth.begin();
    cloth.err(7);
    cloth.rig.particles.place += Vec3(0.01, -0.02, 0.03);
    // By the formula the end has these and `lasts` times the force and the torque there.
    lasts = by_bdf2 ? 2 * kKeptStep / 3 : kKeptStep;
    momentum = by_bdf2 ? Vec3((4 * p1 - p0) / 3) : p1;
    spin = (by_bdf2 ? Vec3((4 * spin1 - spin0) / 3) : spin1) - centre.cross(momentum);
  }
  void end() { cloth.end(&second_order); }

  Kept cloth;
  Field<double> second_order;
  double lasts;         ///< s
  Vec3 centre;          ///< of the cloth, where the substep began
  Vec3 momentum, spin;  ///< by the formula without what draws, and about `centre`
};

// A hand does not go on with the cloth: what it draws turns about a fixed point, as where its centre was when
// the substep began. Angular momentum is given back by the velocities, with the nodes where the solve has put
// them.
TEST(MomentumKeeper, WhatIsDrawnTurnsAboutAFixedPoint) {
  Draw draw;
  draw.pull = {3, -2, 5};
  for (const bool by_bdf2 : {false, true}) {
    Drawn drawn(draw, by_bdf2);
    Particles<double>& particles = drawn.cloth.rig.particles;
    const VectorField<double> solved = particles.position;
    const Vec3 torque = (particles.position_at(1, 2) - drawn.centre).cross(draw.pull);
    drawn.end();
    particles.position = solved;
    expect_near(drawn.cloth.momentum(), drawn.momentum + drawn.lasts * draw.pull);
    expect_near(drawn.cloth.spin_about(drawn.centre), drawn.spin + drawn.lasts * torque);
  }
}

// What is drawn is moved as a rigid body, as far as its velocities' changes lead by the formula: the centre
// to the last digits, a node but for the square of the turn, about 0.003 rad.
TEST(MomentumKeeper, WhatIsDrawnIsMovedAsFarAsItsVelocityChanges) {
  Draw draw;
  draw.pull = {3, -2, 5};
  for (const bool by_bdf2 : {false, true}) {
    Drawn drawn(draw, by_bdf2);
    const Particles<double> before = drawn.cloth.rig.particles;
    drawn.end();
    const Particles<double>& after = drawn.cloth.rig.particles;
    expect_near(centre_of_mass(after) - centre_of_mass(before),
                drawn.lasts / total_mass(before) * (linear_momentum(after) - linear_momentum(before)));
    const auto between = [](const Particles<double>& particles, int r, int c) {
      return Vec3(particles.position_at(r, c) - particles.position_at(0, 0));
    };
    each_node(after.grid(), [&](int r, int c) {
      EXPECT_NEAR(between(after, r, c).norm(), between(before, r, c).norm(), 1e-12);
      const Vec3 way = after.position_at(r, c) - before.position_at(r, c),
                 led = drawn.lasts * (after.velocity_at(r, c) - before.velocity_at(r, c));
      EXPECT_LT((way - led).norm(), 1e-4) << "of " << led.norm();
    });
  }
}

// The harder a hand draws the farther the cloth is: momentum is what the formula makes of the force where the
// cloth has been moved to. Shares by mass draw at the centre, so that turning changes nothing of it.
TEST(MomentumKeeper, WhatIsDrawnHasTheMomentumOfTheForceWhereItIsMovedTo) {
  Draw draw;
  draw.rate = 400;
  draw.place = {101, -20, 5};
  for (const bool by_bdf2 : {false, true}) {
    Drawn drawn(draw, by_bdf2);
    drawn.end();
    const Particles<double>& particles = drawn.cloth.rig.particles;
    const Vec3 force = draw.rate * total_mass(particles) * (draw.place - centre_of_mass(particles));
    expect_near(drawn.cloth.momentum(), drawn.momentum + drawn.lasts * force);
  }
}

// What touches something while it is drawn would be moved into that: of two cloths neither is.
TEST(MomentumKeeper, LeavesAloneWhatIsDrawnAndTouches) {
  for (const bool drawn : {true, false}) {
    Kept one, other;
    if (drawn) one.rig.effects.push_back(std::make_unique<Draw>());
    for (Kept* cloth : {&one, &other}) cloth->begin();
    one.err(5);
    other.err(6);
    const VectorField<double> velocity = other.rig.particles.velocity;
    const std::array members{one.as_member(), other.as_member()};
    EXPECT_EQ(MomentumKeeper<double>::end_substep(members, kKeptStep), 1);
    EXPECT_EQ(same_bits(other.rig.particles.velocity, velocity), drawn);
  }
}

// Of a substep that says nothing about the next one there is no second order.
TEST(MomentumKeeper, ARestartForgetsTheSubstepBefore) {
  Kept cloth({GravityEffect{}});
  cloth.begin();
  cloth.err(6);
  cloth.keeper.restart();
  const Vec3 momentum = cloth.momentum();
  Field<double> second_order(cloth.rig.particles.grid());
  second_order.fill(1);
  cloth.begin();
  cloth.err(7);
  cloth.end(&second_order);
  expect_near(cloth.momentum(), momentum + kKeptStep * total_mass(cloth.rig.particles) * standard_gravity());
}

// Cloth and body together keep what they had: the body was given something in the substep.
TEST(MomentumKeeper, WhatABodyGainsTheClothHasLost) {
  Kept cloth;
  Solid body;
  body.id = 1;
  body.shape = Sphere{0.2};
  body.start = body.position = {99, -20.5, 5.25};
  body.position -= cloth.rig.particles.place;  // solids are seen from the cloth's place
  body.start = body.position;
  body.inverse_mass = 0.5;
  body.inverse_inertia = 30 * Eigen::Matrix3d::Identity();
  body.velocity = {1, 0, -1};
  body.spin = {0, 3, 0};
  cloth.rig.solids = {body};
  const Vec3 place = cloth.rig.particles.place + body.position;
  const Vec3 momentum = cloth.momentum(), spin = cloth.spin();
  cloth.begin();
  cloth.err(5);
  const Vec3 gain(0.05, -0.02, 0.01), turned(0.1, 0.2, -0.05);
  cloth.rig.solids[0].velocity += gain;
  cloth.rig.solids[0].spin += turned;
  cloth.end();
  expect_near(cloth.momentum() + gain / 0.5, momentum);
  expect_near(cloth.spin() + place.cross(gain / 0.5) + turned / 30, spin);
}

// Drag takes its part of what is given back, however fast it is: by backward Euler p' = p - h rate p', with
// the damping over the density as rate.
TEST(MomentumKeeper, WhatIsGivenBackIsDraggedToo) {
  for (const double rate : {1.0, 1e3, 1e6}) {
    Kept cloth({DampingEffect{}});
    cloth.rig.cloth.material.damping = rate * cloth.rig.cloth.material.density;
    const Vec3 momentum = cloth.momentum();
    cloth.begin();
    cloth.err(5);
    cloth.end();
    EXPECT_LT((cloth.momentum() - momentum / (1 + kKeptStep * rate)).norm(), 1e-9 * momentum.norm());
  }
}

// A smooth floor pushes up and tilts: momentum along it, and angular momentum about its normal, stay.
TEST(MomentumKeeper, OnASmoothFloorMomentaAlongItStay) {
  Kept cloth;
  cloth.lay_on_floor();
  const Vec3 momentum = cloth.momentum(), spin = cloth.spin();
  cloth.begin();
  cloth.err(5);
  cloth.end();
  const auto along = [](const Vec3& v) { return Vec3(v.x(), 0, v.z()); };
  expect_near(along(cloth.momentum()), along(momentum));
  EXPECT_NEAR(cloth.spin().y(), spin.y(), 1e-11);
}

// Held cloth, cloth that rubs on something firm, and cloth that is torn is left as it is, to the bit.
TEST(MomentumKeeper, LeavesAloneWhatIsNotFree) {
  const auto expect_left_alone = [](Kept& cloth, bool rubs) {
    cloth.begin();
    cloth.err(5);
    const VectorField<double> velocity = cloth.rig.particles.velocity;
    EXPECT_EQ(cloth.end(nullptr, rubs), 1);
    EXPECT_TRUE(same_bits(cloth.rig.particles.velocity, velocity));
  };
  Kept hung({}, true), rubbed, torn;
  expect_left_alone(hung, false);
  expect_left_alone(rubbed, true);
  const auto links = std::make_shared<TornLinks>(torn.rig.particles.grid());
  links->cut({2, 2, true});
  torn.rig.sheet = Sheet<double>(torn.rig.cloth, SheetEffects(std::vector<EffectDescription>{}),
                                 torn.rig.particles.inverse_mass, links);
  expect_left_alone(torn, false);
}

// Drawn together without the energy to turn faster by, it turns as fast as that which it had allows.
TEST(MomentumKeeper, TurningHasNoMoreEnergyThanThereIs) {
  Kept cloth;
  Particles<double>& particles = cloth.rig.particles;
  each_node(particles.grid(), [&](int r, int c) {
    set(particles.velocity, r, c, Vec3(0, 0, 2).cross(particles.local_position_at(r, c)));
  });
  const double before = kinetic_energy(particles);
  cloth.begin();
  cloth.start = particles.position;
  each_node(particles.grid(), [&](int r, int c) {
    set(particles.position, r, c, 0.9 * particles.local_position_at(r, c));
    set(particles.velocity, r, c, 0.9 * particles.velocity_at(r, c));
  });
  cloth.end();
  EXPECT_NEAR(kinetic_energy(particles), before, 1e-12 * before);
}

}  // namespace
}  // namespace weft
