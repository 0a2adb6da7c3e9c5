// Which plane holds what comes to a solid near its edge, and where a body is pushed by what it holds.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/solver/node_arrays.h"
#include "fixtures.h"

namespace weft {
namespace {

constexpr double kPlaneStep = 0.01;  // s

/// A sheet of 3 x 3 nodes of 1 kg in the plane z = 0, whose middle node is at the origin and goes `way` in a
/// substep, and a solid.
class NodeAtASolid {
 public:
  NodeAtASolid(const Solid& solid, const Vec3& way)
      : sheet_(test::flat_sheet<double>(3, 3, {1, 1})), solids_{solid}, moves_(sheet_.grid(), 3), way_(way) {
    test::set(sheet_.velocity, 1, 1, way / kPlaneStep);
    add(moves_.vector(0), middle(), way);
  }
  /// The node is known to touch the solid as the substep begins.
  void touch() {
    contacts_.begin({{middle(), solids_[0].id}}, {}, sheet_, solids_, {0, 1, kPlaneStep}, false, bodies_);
  }
  /// An iteration finds it inside the solid.
  void find_inside() {
    contacts_.begin({}, {}, sheet_, solids_, {0, 1, kPlaneStep}, false, bodies_);
    Particles<double> moved = sheet_;
    test::set(moved.position, 1, 1, way_);
    EXPECT_TRUE(contacts_.hold_inside({{middle(), solids_[0].id}}, {}, moved, solids_, moves_.vector(0),
                                      bodies_, kLinks, 0));
  }
  /// The normal along which the system holds the node, outwards; none if nothing does.
  std::optional<Vec3> normal() {
    NodeArrays<double> blocks(sheet_.grid(), 6), numbers(sheet_.grid(), 1), vectors(sheet_.grid(), 3);
    std::fill_n(numbers[0], sheet_.grid().size(), 1 / (kPlaneStep * kPlaneStep));
    NodeCouplings<double> couplings;
    bodies_.detach();
    contacts_.add_to(blocks.blocks(), couplings, vectors.vector(0), bodies_, numbers[0], kLinks, {},
                     moves_.vector(0));
    const Vec3 pushed = at(kernels::Components<const double>(vectors.vector(0)), middle());
    bodies_.eliminate(vectors.vector(0));
    if (pushed.isZero(0)) return {};
    return pushed.normalized();
  }
  /// What the body turns by if the nodes stay where they are.
  Vec3 turn() {
    NodeArrays<double> none(sheet_.grid(), 3);
    bodies_.find_changes(none.vector(0));
    bodies_.take_changes();
    return bodies_.turn(0);
  }

 private:
  static constexpr double kLinks = 1e5;  // N/m
  std::size_t middle() const { return sheet_.grid().index(1, 1); }

  Particles<double> sheet_;
  std::vector<Solid> solids_;
  NodeArrays<double> moves_;
  Vec3 way_;
  ContactConstraints<double> contacts_;
  AttachedBodies<double> bodies_;
};

/// Its upper face at `top`, its face to +x at `side`; 1 m wide.
Solid box_with(double top, double side, bool is_body) {
  Solid box;
  box.id = kFirstObstacle;
  box.shape = Box{{0.5, 0.5, 0.5}};
  box.start = box.position = {side - 0.5, 0, top - 0.5};
  if (is_body) {
    box.inverse_mass = 1;
    box.inverse_inertia = Eigen::Matrix3d::Identity();
  }
  return box;
}

// Down through the upper face, 0.04 m deep where the side is 0.02 m away: the face it enters holds it.
TEST(HoldingPlanes, TheFaceThatANodeEntersHoldsIt) {
  for (const bool is_body : {false, true}) {
    for (const bool known : {true, false}) {
      NodeAtASolid scene(box_with(-0.01, 0.02, is_body), {0, 0, -0.05});
      known ? scene.touch() : scene.find_inside();
      const std::optional<Vec3> normal = scene.normal();
      ASSERT_TRUE(normal) << is_body << known;
      EXPECT_LT((*normal - Vec3(0, 0, 1)).norm(), 1e-12) << is_body << known;
    }
  }
}

// It begins 0.01 m below the upper face and 0.02 m beside the side, and goes down to 0.06 m: what stands firm
// holds it by the face next to which it lay, a body, which has come over it, by the one next to its end.
TEST(HoldingPlanes, WhatBeginsInsideABodyIsLedOutWhereItEnds) {
  for (const bool is_body : {false, true}) {
    NodeAtASolid scene(box_with(0.01, 0.02, is_body), {0, 0, -0.05});
    scene.touch();
    const std::optional<Vec3> normal = scene.normal();
    ASSERT_TRUE(normal) << is_body;
    EXPECT_LT((*normal - (is_body ? Vec3(1, 0, 0) : Vec3(0, 0, 1))).norm(), 1e-12) << is_body;
  }
}

// Past the edge, down along the side without a hit: nothing holds it to what stands firm.
TEST(HoldingPlanes, WhatPassesAnEdgeByIsNotHeld) {
  const Vec3 way(-0.0009, 0, -0.05);
  NodeAtASolid firm(box_with(-0.01, -0.001, false), way);
  firm.touch();
  EXPECT_FALSE(firm.normal());
  NodeAtASolid enters(box_with(-0.01, 0.001, false), way);
  enters.touch();
  EXPECT_TRUE(enters.normal()) << "with the edge 2 mm farther out it would hit the upper face";
}

// The node presses down on a box 0.01 m below it, whose centre is aside by (-0.2, 0.1): the torque of that
// force about it, arm x (0, 0, -F), is along (0.1, 0.2), whether the node was known to touch the box or found
// inside.
TEST(HoldingPlanes, ABoxTurnsByWhatPressesOnItBesideItsCentre) {
  for (const bool known : {true, false}) {
    Solid box = box_with(-0.01, 0.3, true);
    box.start.y() = box.position.y() = 0.1;
    NodeAtASolid scene(box, {0, 0, -0.02});
    known ? scene.touch() : scene.find_inside();
    ASSERT_TRUE(scene.normal());
    const Vec3 turn = scene.turn();
    EXPECT_GT(turn.norm(), 1e-3);
    EXPECT_LT((turn.normalized() - Vec3(0.1, 0.2, 0).normalized()).norm(), 1e-9) << turn.transpose();
  }
}

// The way enters a ball of 0.05 m where its normal is (0.6, 0, 0.8) and leads 0.07 m on: the foot on that
// plane is beside the ball's centre, but a ball's turning nobody sees.
TEST(HoldingPlanes, ABallIsPushedWithoutATurn) {
  for (const bool known : {true, false}) {
    Solid ball;
    ball.id = 1;
    ball.shape = Sphere{0.05};
    ball.inverse_mass = 1;
    ball.start = ball.position = {-0.03, 0, -0.05};
    NodeAtASolid scene(ball, {0, 0, -0.08});
    known ? scene.touch() : scene.find_inside();
    const std::optional<Vec3> normal = scene.normal();
    ASSERT_TRUE(normal) << known;
    EXPECT_LT((*normal - Vec3(0.6, 0, 0.8)).norm(), 1e-9) << known;
    EXPECT_EQ(scene.turn(), Vec3(0, 0, 0)) << known;
  }
}

}  // namespace
}  // namespace weft
