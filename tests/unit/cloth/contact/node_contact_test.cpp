// One node and the solids that it may meet in a substep: the paper's section 2.4, with friction, momentum and
// ways that are looked at.
#include "cloth/contact/recovery/node_contact.h"

#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kNodeStep = 0.01;

/// All below z = 0.
Solid ground() {
  Solid solid;
  solid.id = kFirstObstacle;
  solid.shape = HalfSpace{};
  solid.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
  return solid;
}

/// Of 0.5 m, around the origin.
Solid ball() {
  Solid solid;
  solid.id = 1;
  solid.shape = Sphere{0.5};
  return solid;
}

/// The middle node of a sheet, 2 kg, and one solid.
class OneNode {
 public:
  OneNode(Solid solid, const Vec3& place, const Vec3& velocity)
      : solid_(std::move(solid)), sheet_(flat_sheet<double>(3, 3, {1, 1})) {
    set(sheet_.position, 1, 1, place);
    set(sheet_.velocity, 1, 1, velocity);
    sheet_.mass.at(1, 1) = 2;
    sheet_.inverse_mass.at(1, 1) = 0.5;
  }
  /// After a substep in which it went by its velocity. `fast`: its way is looked at.
  bool resolve(bool fast = false) {
    const std::vector<Touch> none;
    solids_ = {{&solid_, solid_.placed(1), Vec3(0, 0, 0), 0, 0, fast, 0, solid_.velocity, solid_.spin,
                Substep{0, 1, kNodeStep}, solid_.move(0, 1)}};
    const NodeContact<double>::State state{sheet_, nullptr, false, none, none};
    const std::vector<std::size_t> may_meet = {0};
    return NodeContact<double>(state, {sheet_.grid().index(1, 1)}, may_meet, kNodeStep * velocity())
        .resolve(solids_, touches_);
  }
  Vec3 place() const { return get(sheet_.position, 1, 1); }
  Vec3 velocity() const { return get(sheet_.velocity, 1, 1); }
  const MovingSolid& solid() const { return solids_[0]; }
  const std::vector<Touch>& touches() const { return touches_; }

 private:
  Solid solid_;
  Particles<double> sheet_;
  std::vector<MovingSolid> solids_;
  std::vector<Touch> touches_;
};

void expect_near(const Vec3& value, const Vec3& expected, double tolerance) {
  EXPECT_LT((value - expected).norm(), tolerance) << value.transpose() << ", not " << expected.transpose();
}

TEST(NodeContact, OutsideNothingHappens) {
  OneNode node(ground(), {0.1, 0.2, 0.3}, {1, 0, -1});
  EXPECT_FALSE(node.resolve());
  EXPECT_EQ(node.place(), Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(node.velocity(), Vec3(1, 0, -1));
  EXPECT_TRUE(node.touches().empty());
}

TEST(NodeContact, InsideItIsPutOnTheSurfaceAndLosesWhatPointsIn) {
  OneNode node(ground(), {0.1, 0.2, -0.01}, {1, 2, -3});
  EXPECT_TRUE(node.resolve());
  expect_near(node.place(), {0.1, 0.2, 0}, 1e-12);
  EXPECT_GE(node.place().z(), 0) << "not inside again by rounding";
  expect_near(node.velocity(), {1, 2, 0}, 1e-12);
  ASSERT_EQ(node.touches().size(), 1U);
  EXPECT_EQ(node.touches()[0].collider, kFirstObstacle);
}

TEST(NodeContact, LeavingItKeepsItsVelocity) {
  OneNode node(ground(), {0, 0, -0.01}, {1, 0, 3});
  EXPECT_TRUE(node.resolve());
  expect_near(node.velocity(), {1, 0, 3}, 1e-12);
}

// The paper: from a ball's centre outwards, upwards at the very centre.
TEST(NodeContact, LeavesABallAlongItsRadius) {
  OneNode aside(ball(), {0.2, 0, 0}, {0, 0, 0}), centre(ball(), {0, 0, 0}, {0, 0, 0});
  EXPECT_TRUE(aside.resolve());
  EXPECT_TRUE(centre.resolve());
  expect_near(aside.place(), {0.5, 0, 0}, 1e-12);
  expect_near(centre.place(), {0, 0.5, 0}, 1e-12);
}

// Coulomb: of the speed along the surface as much goes as mu times what was lost across it, or all.
TEST(NodeContact, FrictionTakesItsShare) {
  Solid rough = ground();
  rough.friction = 0.4;
  OneNode slides(rough, {0, 0, -0.01}, {3, 0, -2}), sticks(rough, {0, 0, -0.01}, {0.5, 0, -2});
  EXPECT_TRUE(slides.resolve());
  EXPECT_TRUE(sticks.resolve());
  expect_near(slides.velocity(), {3 - 0.4 * 2, 0, 0}, 1e-12);
  expect_near(sticks.velocity(), {0, 0, 0}, 1e-12);
  // What sticks is back above where it began, what slides goes on by the share that is left.
  expect_near(sticks.place(), {-kNodeStep * 0.5, 0, 0}, 1e-9);
  expect_near(slides.place(), {-kNodeStep * 0.4 * 2, 0, 0}, 1e-9);
}

// A plastic hit of 2 kg and 3 kg: one velocity along the normal, the momentum that they had.
TEST(NodeContact, ABodyTakesUpTheMomentum) {
  Solid body = ball();
  body.inverse_mass = 1.0 / 3;
  body.velocity = {1, 0, 0};
  OneNode node(body, {0.49, 0, 0}, {-4, 1, 0});
  EXPECT_TRUE(node.resolve());
  const double together = (2 * -4 + 3 * 1) / 5.0;
  expect_near(node.velocity(), {together, 1, 0}, 1e-12);
  expect_near(node.solid().velocity, {together, 0, 0}, 1e-12);
}

// From -2 m to 2 m in a substep: it meets the near side, and stays there.
TEST(NodeContact, AFastNodeStopsWhereItsWayMeetsTheSolid) {
  OneNode unseen(ball(), {2, 0, 0}, {4 / kNodeStep, 0, 0}), seen(ball(), {2, 0, 0}, {4 / kNodeStep, 0, 0});
  EXPECT_FALSE(unseen.resolve(false));
  EXPECT_TRUE(seen.resolve(true));
  expect_near(seen.place(), {-0.5, 0, 0}, 1e-9);
  expect_near(seen.velocity(), {0, 0, 0}, 1e-9);
}

// A chord each tenth of a radian, of one turn at most: 2 pi / 0.1 = 62.8, whatever a hand makes of its spin.
TEST(NodeContact, TheWayOfASolidThatWhirlsHasTheChordsOfOneTurn) {
  for (const auto& [turn, chords] :
       std::vector<std::pair<double, int>>{{0, 1}, {0.25, 3}, {6.15, 62}, {2046, 63}, {1e12, 63}}) {
    Solid whirling = ball();
    whirling.turn = {0, turn, 0};
    OneNode node(whirling, {2, 0, 0}, {1 / kNodeStep, 0, 0});
    node.resolve();
    EXPECT_EQ(node.solid().chords(), chords) << turn;
  }
}

}  // namespace
}  // namespace weft::test
