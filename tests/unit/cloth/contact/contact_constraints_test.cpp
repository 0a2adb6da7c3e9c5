// Contacts with solids as springs of an implicit step's system: when they hold, how stiff, when they let go.
#include "cloth/contact/constraints/contact_constraints.h"

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

}  // namespace
}  // namespace weft::test
