// Contacts with solids as springs of an implicit step's system: when they hold, how stiff, when they let go.
#include "cloth/contact/constraints/contact_constraints.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <vector>

#include "cloth/solver/node_arrays.h"
#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kConstraintStep = 0.01, kLinks = 1e7,
                 kInertia = 1 / (kConstraintStep * kConstraintStep);  // N/m

/// A sheet of 3 x 3 nodes of 1 kg in the plane z = 0, on ground below it; the middle node touches that.
class OnGround {
 public:
  explicit OnGround(double friction = 0) : sheet_(flat_sheet<double>(3, 3, {1, 1})), solids_(1) {
    solids_[0].id = kFirstObstacle;
    solids_[0].shape = HalfSpace{};
    solids_[0].rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
    solids_[0].friction = friction;
  }
  std::size_t middle() const { return sheet_.grid().index(1, 1); }
  Touch touch() const { return {middle(), kFirstObstacle}; }
  void set_velocity(const Vec3& velocity) { set(sheet_.velocity, 1, 1, velocity); }
  std::vector<Solid>& solids() { return solids_; }
  void begin(bool near_rest = false) {
    contacts.begin({touch()}, {}, sheet_, solids_, Substep{0, 1, kConstraintStep}, near_rest, bodies);
  }
  /// The middle node's block and right-hand side in the system at its move.
  struct System {
    Eigen::Matrix3d block;
    Vec3 b;
  };
  System system_at(const Vec3& move) {
    const Grid& grid = sheet_.grid();
    NodeArrays<double> blocks(grid, 6), vectors(grid, 6), numbers(grid, 1);
    const kernels::Blocks<double> block = blocks.blocks();
    std::fill_n(numbers[0], grid.size(), kInertia);
    NodeCouplings<double> couplings;
    contacts.add_to(block, couplings, vectors.vector(0), bodies, numbers[0], kLinks, {},
                    moved(vectors.vector(3), move));
    const std::size_t i = middle();
    return {Eigen::Matrix3d{{block.xx[i], block.xy[i], block.xz[i]},
                            {block.xy[i], block.yy[i], block.yz[i]},
                            {block.xz[i], block.yz[i], block.zz[i]}},
            at(kernels::Components<const double>(vectors.vector(0)), i)};
  }
  double release_pulling(const Vec3& move) {
    NodeArrays<double> vectors(sheet_.grid(), 3);
    return contacts.release_pulling(moved(vectors.vector(0), move), bodies);
  }
  double error(const Vec3& move) {
    NodeArrays<double> vectors(sheet_.grid(), 3);
    return contacts.error(moved(vectors.vector(0), move), bodies).all;
  }
  std::vector<Touch> finish(const Vec3& move) {
    NodeArrays<double> vectors(sheet_.grid(), 3);
    return contacts.finish(moved(vectors.vector(0), move), bodies, solids_);
  }

  /// Nothing is known to touch anything.
  void begin_free() {
    contacts.begin({}, {}, sheet_, solids_, Substep{0, 1, kConstraintStep}, false, bodies);
  }
  /// The middle node goes on by `way` and is held, known to touch the solid or found inside at the end.
  void hold_on_way(const Vec3& way, bool known) {
    set_velocity(way / kConstraintStep);
    known ? begin() : begin_free();
    EXPECT_EQ(!known, hold_inside(way)) << "what is held already is not held once more";
  }
  /// A spring hangs the solid by its centre on a corner, to which its place is `apart`, m.
  void hang(const Vec3& apart, double stiffness) {
    contacts.hang({{sheet_.grid().index(0, 0), 0, Vec3::Zero(), apart, stiffness}}, sheet_, solids_, bodies);
  }
  /// The middle node is found inside at the move; its plane's distance takes more energy than `missed`, J.
  bool hold_inside(const Vec3& move, double missed = 0) {
    NodeArrays<double> vectors(sheet_.grid(), 3);
    Particles<double> now = sheet_;
    set(now.position, 1, 1, sheet_.position_at(1, 1) + move);
    return contacts.hold_inside({touch()}, {}, now, contacts.bent(solids_, bodies),
                                moved(vectors.vector(0), move), bodies, kLinks, missed);
  }
  /// The only spring: to which it is pressed at the move, m, and the normal along which it is.
  struct Pressed {
    double depth;
    Vec3 normal;
  };
  Pressed pressed_at(const Vec3& move) {
    Pressed pressed{0, Vec3::Zero()};
    NodeArrays<double> vectors(sheet_.grid(), 6);
    const auto moves = moved(vectors.vector(0), move), changes = vectors.vector(3);
    for (int k = 0; k < 3; ++k) {
      std::vector<OneSidedSpring> springs;
      changes.x[middle()] = changes.y[middle()] = changes.z[middle()] = 0;
      add(changes, middle(), Vec3::Unit(k));
      contacts.append_springs(moves, changes, bodies, springs);
      EXPECT_EQ(springs.size(), 1U);
      if (springs.size() != 1) return pressed;
      pressed.depth = springs[0].depth;
      pressed.normal[k] = -springs[0].approach;
    }
    return pressed;
  }
  /// The system is solved for bodies, with the nodes kept at the move.
  void solve_for_bodies(const Vec3& move) {
    system_at(move);
    NodeArrays<double> none(sheet_.grid(), 3);
    bodies.find_changes(none.vector(0));
    bodies.take_changes();
    bodies.scale_changes(0);
  }

  ContactConstraints<double> contacts;
  AttachedBodies<double> bodies;

 private:
  kernels::Components<double> moved(const kernels::Components<double>& field, const Vec3& move) const {
    add(field, middle(), move);
    return field;
  }
  Particles<double> sheet_;
  std::vector<Solid> solids_;
};

// A soft pin draws a node by 20 N/m * (0.1, -0.2, 0.3) m. About a ball's centre that is a torque, which the
// ball, as it does not turn, takes from nobody; what turns takes it up itself.
TEST(HangingSolids, TellTheTorqueBesideTheirCentresUnlessTheyTurn) {
  const Particles<double> sheet = flat_sheet<double>(3, 3, {1, 1});
  const Vec3 apart(0.1, -0.2, 0.3), centre(0.2, -3, 1);
  for (const bool turns : {false, true}) {
    Solid ball;
    ball.shape = Sphere{0.1};
    ball.start = ball.position = centre;
    ball.inverse_mass = 2;
    if (turns) ball.inverse_inertia = Eigen::Matrix3d::Identity();
    const std::vector<Solid> solids{ball};
    ContactConstraints<double> contacts;
    AttachedBodies<double> bodies;
    contacts.begin({}, {}, sheet, solids, Substep{0, 1, kConstraintStep}, false, bodies);
    contacts.hang({{sheet.grid().index(0, 2), 0, Vec3::Zero(), apart, 20}}, sheet, solids, bodies);
    NodeArrays<double> moves(sheet.grid(), 3);
    const Vec3 torque = contacts.torque_beside_centres(moves.vector(0), sheet, solids, bodies);
    const Vec3 expected =
        turns ? Vec3(0, 0, 0) : Vec3((sheet.local_position_at(0, 2) - centre).cross(20 * apart));
    EXPECT_LT((torque - expected).norm(), 1e-12) << torque.transpose();
  }
}

// DECISIONS.md: 32 times as stiff as the inertia where it is not known what it bears, from g h^2 / 16 outside
// of the surface on; what it bears presses it by half of that.
constexpr double kWeak = 32 * kInertia, kPressed = 9.81 / 32 * kConstraintStep * kConstraintStep,
                 kBears = 2 * kPressed;

TEST(ContactConstraints, HoldANodeAlongTheNormalAlone) {
  OnGround sheet;
  sheet.begin();
  ASSERT_FALSE(sheet.contacts.empty());
  const auto [block, b] = sheet.system_at({0, 0, kBears});
  EXPECT_NEAR(block(2, 2), kWeak, 1e-9 * kWeak);
  EXPECT_LT((block - kWeak * Vec3(0, 0, 1) * Vec3(0, 0, 1).transpose()).norm(), 1e-9 * kWeak);
  EXPECT_LT(b.norm(), 1e-9 * kWeak) << "there it begins to bear";
}

// Of a motion that contact has broken BDF2 knows no past; two steps later it has one.
TEST(ContactConstraints, BreakAMotionUntilTheyHaveLastedForTwoSteps) {
  OnGround sheet;
  for (int step = 1; step <= 4; ++step) {
    sheet.begin();
    int broken = 0;
    sheet.contacts.for_each_broken([&](std::size_t) { ++broken; });
    EXPECT_EQ(broken, step <= 2 ? 1 : 0) << "step " << step;
    sheet.system_at({0, 0, 0});
    const std::vector<Touch> pressed = sheet.finish({0, 0, kBears / 2});
    ASSERT_EQ(pressed.size(), 1U);
    EXPECT_EQ(sheet.contacts.goes_on(pressed[0]), step >= 2) << "after step " << step;
  }
}

TEST(ContactConstraints, PushOutWhatGoesIn) {
  OnGround sheet;
  sheet.begin();
  const Vec3 b = sheet.system_at({0.1, 0, -1e-3}).b;
  EXPECT_LT((b - Vec3(0, 0, (kBears + 1e-3) * kWeak)).norm(), 1e-9 * kWeak);
}

TEST(ContactConstraints, AreAsStiffAsWhatTheyBearAsks) {
  OnGround sheet;
  sheet.begin();
  sheet.system_at({0, 0, 0});
  // Pressed in by 1 mm in the first system, it bears that force by the usual depth in the next one.
  const double force = kWeak * (kBears + 1e-3), stiffness = force / kPressed;
  EXPECT_GT(sheet.error({0, 0, -1e-3}), 0) << "it let the node in";
  EXPECT_EQ(sheet.error({0, 0, kBears / 2}), 0);
  const double most = kLinks + kWeak;
  EXPECT_NEAR(sheet.system_at({0, 0, -1e-3}).block(2, 2), std::min(stiffness, most), 1e-9 * most);
}

// A stiffness that followed each step's force would do work on the node.
TEST(ContactConstraints, KeepTheirStiffnessNearRestWithinTheMargin) {
  // In two steps away from rest the spring, three times as stiff as at first, is pressed by `before` depths,
  // in the third one near rest by `now`.
  const auto stiffness_at = [](double before, double now) {
    OnGround sheet;
    for (int step = 0; step < 2; ++step) {
      sheet.begin();
      sheet.system_at({0, 0, 0});
      EXPECT_NEAR(sheet.system_at({0, 0, kBears - 3 * kPressed}).block(2, 2), 3 * kWeak, 1e-9 * kWeak);
      sheet.finish({0, 0, kBears - before * kPressed});
    }
    sheet.begin(true);
    sheet.system_at({0, 0, 0});
    return sheet.system_at({0, 0, kBears - now * kPressed}).block(2, 2);
  };
  EXPECT_NEAR(stiffness_at(1, 0.5), 3 * kWeak, 1e-9 * kWeak) << "half of the force";
  EXPECT_NEAR(stiffness_at(1, 1.9), 3 * kWeak, 1e-9 * kWeak) << "within the margin";
  EXPECT_NEAR(stiffness_at(1, 2.1), 2.1 * 3 * kWeak, 1e-9 * kWeak) << "beyond it";
  EXPECT_NEAR(stiffness_at(0.05, 0.05), 3 * kWeak, 1e-9 * kWeak) << "a twentieth of it";
}

TEST(ContactConstraints, LetGoOfWhatPullsAndHoldItAgainWhenItPresses) {
  OnGround sheet;
  sheet.begin();
  sheet.system_at({0, 0, 0});
  // A spring drawn out by 2 mm holds k d^2 / 2.
  EXPECT_NEAR(sheet.release_pulling({0, 0, kBears + 2e-3}), kWeak * 2e-6, 1e-9 * kWeak);
  EXPECT_EQ(sheet.system_at({0, 0, kBears + 2e-3}).block, Eigen::Matrix3d::Zero());
  EXPECT_EQ(sheet.release_pulling({0, 0, kBears + 3e-3}), 0);
  EXPECT_GT(sheet.release_pulling({0, 0, -1e-3}), 0);
  EXPECT_GT(sheet.system_at({0, 0, -1e-3}).block(2, 2), 0);
}

TEST(ContactConstraints, WhatLeavesIsNotHeldAndSaidSo) {
  OnGround sheet;
  sheet.set_velocity({0, 0, 5});
  sheet.begin();
  EXPECT_TRUE(sheet.contacts.empty());
  EXPECT_EQ(sheet.contacts.not_held(), std::vector<Touch>{sheet.touch()});
}

// Coulomb's friction goes by the force that the step itself finds, at most mu times it.
TEST(ContactConstraints, RubByTheForceOfTheStep) {
  constexpr double kFriction = 0.5, kSlide = 0.01;
  OnGround sheet(kFriction);
  sheet.set_velocity({1, 0, 0});
  sheet.begin();
  sheet.system_at({0, 0, kBears});
  const double force = kWeak * kPressed;
  const auto [block, b] = sheet.system_at({kSlide, 0, kPressed});
  EXPECT_NEAR(-b.x(), kFriction * force, 1e-6 * force);
  EXPECT_NEAR(block(0, 0), kFriction * force / kSlide, 1e-6 * force / kSlide);
}

TEST(ContactConstraints, ABodyHangsOnWhatPressesOnIt) {
  OnGround sheet;
  sheet.solids()[0].shape = Sphere{0.5};
  sheet.solids()[0].position = sheet.solids()[0].start = {0, 0, -0.5};
  sheet.solids()[0].inverse_mass = 1;
  sheet.begin();
  EXPECT_FALSE(sheet.bodies.empty());
  sheet.system_at({0, 0, 0});
  EXPECT_EQ(sheet.finish({0, 0, -1e-4}), std::vector<Touch>{sheet.touch()});
}

/// 1 m wide, its upper face at `top`, its face to +x at `side`.
void make_box(Solid& box, double top, double side, bool is_body) {
  box.shape = Box{{0.5, 0.5, 0.5}};
  box.rotation = Eigen::Matrix3d::Identity();
  box.start = box.position = {side - 0.5, 0, top - 0.5};
  if (!is_body) return;
  box.inverse_mass = 1;
  box.inverse_inertia = Vec3(2, 3, 4).asDiagonal();
}

/// What the node is held by on its way to a box, known to touch it or found inside at the way's end.
OnGround::Pressed held_on_way(double top, double side, bool is_body, bool known, const Vec3& way) {
  OnGround sheet;
  make_box(sheet.solids()[0], top, side, is_body);
  sheet.hold_on_way(way, known);
  return sheet.pressed_at(way);
}

// Down through the upper face to 0.04 m below it and 0.02 m beside the side: held by the upper face, off
// which what stands firm bears by the margin.
TEST(ContactConstraints, HoldWhatEntersABoxOffTheFaceThatItEnters) {
  for (const bool is_body : {false, true}) {
    for (const bool known : {false, true}) {
      const auto [depth, normal] = held_on_way(-0.01, 0.02, is_body, known, {0, 0, -0.05});
      EXPECT_NEAR(depth, 0.04 + (is_body ? 0 : kBears), 1e-12) << is_body << known;
      EXPECT_LT((normal - Vec3(0, 0, 1)).norm(), 1e-12) << is_body << known;
    }
  }
}

// It begins 0.01 m below the upper face and comes to 0.06 m, 0.02 m beside the side. What stands firm holds
// it by the face next to where it began, a body by that next to the end. Of the 0.01 m that a body has come
// over it, it is led out by what presses a usual spring alone.
TEST(ContactConstraints, HoldWhatBeginsInsideABodyOffTheFaceNextToItsEnd) {
  for (const bool known : {false, true}) {
    const OnGround::Pressed firm = held_on_way(0.01, 0.02, false, known, {0, 0, -0.05}),
                            body = held_on_way(0.01, 0.02, true, known, {0, 0, -0.05});
    EXPECT_NEAR(firm.depth, 0.06 + kBears, 1e-12) << known;
    EXPECT_LT((firm.normal - Vec3(0, 0, 1)).norm(), 1e-12) << known;
    EXPECT_NEAR(body.depth, 0.02 - (0.01 - kPressed), 1e-12) << known;
    EXPECT_LT((body.normal - Vec3(1, 0, 0)).norm(), 1e-12) << known;
  }
}

// From above past the edge, to 0.1 mm beside the side, without a hit: what stands firm does not hold it, a
// body by that side, to which springs may bring it back.
TEST(ContactConstraints, HoldWhatPassesAnEdgeOffABodyAlone) {
  const Vec3 way(-0.0009, 0, -0.05);
  OnGround firm;
  make_box(firm.solids()[0], -0.01, -0.001, false);
  firm.set_velocity(way / kConstraintStep);
  firm.begin();
  EXPECT_TRUE(firm.contacts.empty());
  const auto [depth, normal] = held_on_way(-0.01, -0.001, true, true, way);
  EXPECT_NEAR(depth, -1e-4, 1e-12);
  EXPECT_LT((normal - Vec3(1, 0, 0)).norm(), 1e-12);
}

// Against links of k, N/m, a node that is d deep asks for k d^2 / 2.
TEST(ContactConstraints, HoldWhatIsInsideIfItMissesTheEnergy) {
  constexpr double kDeep = 0.04, kEnergy = kLinks * kDeep * kDeep / 2;
  OnGround sheet;
  sheet.begin_free();
  EXPECT_FALSE(sheet.hold_inside({0, 0, -kDeep}, 1.001 * kEnergy));
  EXPECT_TRUE(sheet.contacts.empty());
  EXPECT_TRUE(sheet.hold_inside({0, 0, -kDeep}, 0.999 * kEnergy));
  EXPECT_FALSE(sheet.contacts.empty());
  EXPECT_FALSE(sheet.hold_inside({0, 0, -kDeep}, 0)) << "it is held already";
}

/// A ball of 1 kg that nobody sees turn, of 0.05 m.
void make_ball(Solid& ball, const Vec3& centre) {
  ball.shape = Sphere{0.05};
  ball.start = ball.position = centre;
  ball.inverse_mass = 1;
}

// By a spring as stiff as the ball is inert, drawn out by 0.01 m, the last system has taken the ball up by
// half of that: its top is 5 mm below where the node was, which has gone down by 20 mm.
TEST(ContactConstraints, HoldWhatIsInsideABodyWhereTheSolveHasTakenThat) {
  OnGround sheet;
  make_ball(sheet.solids()[0], {0, 0, -0.06});
  const Vec3 way(0, 0, -0.02);
  sheet.begin_free();
  sheet.hang({0, 0, -0.01}, kInertia);
  sheet.solve_for_bodies(way);
  ASSERT_TRUE(sheet.hold_inside(way));
  const auto [depth, normal] = sheet.pressed_at(way);
  EXPECT_NEAR(depth, 0.015, 1e-12);
  EXPECT_LT((normal - Vec3(0, 0, 1)).norm(), 1e-12);
}

// The way enters the ball where its normal is (0.6, 0, 0.8), and leads on beside its centre: the ball is
// pushed along that normal and does not turn.
TEST(ContactConstraints, ABallIsMovedByWhatItHoldsWithoutATurn) {
  const Vec3 way(0, 0, -0.08), normal(0.6, 0, 0.8);
  for (const bool known : {false, true}) {
    OnGround sheet;
    Solid& ball = sheet.solids()[0];
    make_ball(ball, {-0.03, 0, -0.05});
    sheet.hold_on_way(way, known);
    sheet.solve_for_bodies(way);
    EXPECT_EQ(sheet.bodies.turn(0), Vec3(0, 0, 0)) << known;
    sheet.finish(way);
    EXPECT_GT(ball.velocity.norm(), 0.1) << known;
    EXPECT_LT((ball.velocity.normalized() + normal).norm(), 1e-9) << known;
    EXPECT_EQ(ball.spin, Vec3(0, 0, 0)) << known;
  }
}

// A box is pushed down at its upper face, at `arm` from its centre: with v what it gets of speed, the force's
// impulse is m v and its torque's arm x m v.
TEST(ContactConstraints, ABoxTurnsByTheArmOfWhatItHolds) {
  const Vec3 way(0, 0, -0.02), arm(0.2, -0.1, 0.5);
  for (const bool known : {false, true}) {
    OnGround sheet;
    Solid& box = sheet.solids()[0];
    make_box(box, -0.01, 0.3, true);
    box.start.y() = box.position.y() = 0.1;
    box.inverse_mass = 0.5;
    sheet.hold_on_way(way, known);
    sheet.solve_for_bodies(way);
    sheet.finish(way);
    EXPECT_LT(box.velocity.z(), -0.1) << known;
    EXPECT_LT((box.spin - box.inverse_inertia * arm.cross(box.velocity / 0.5)).norm(), 1e-9) << known;
    EXPECT_GT(box.spin.x(), 0.01) << "the node is at -y: that side goes down " << known;
    EXPECT_GT(box.spin.y(), 0.01) << "and at +x " << known;
  }
}

}  // namespace
}  // namespace weft::test
