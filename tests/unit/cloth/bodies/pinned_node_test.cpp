#include "cloth/bodies/pinned_node.h"

#include <gtest/gtest.h>

#include "cloth/bodies/body_collision.h"
#include "cloth/bodies/body_impulses.h"

namespace weft {
namespace {

constexpr double kPinnedStep = 0.01;  // s

Solid going(const Shape& shape, const Vec3& start, const Vec3& velocity) {
  Solid solid;
  solid.shape = shape;
  solid.start = start;
  solid.position = start + kPinnedStep * velocity;
  solid.velocity = velocity;
  solid.mobile = true;
  return solid;
}

/// A box of 0.4 m that falls onto a pinned node below its middle, which goes on its own way.
struct BoxOnPin {
  explicit BoxOnPin(const Vec3& velocity_of_pin) {
    Solid box = going(Box{{0.2, 0.2, 0.2}}, {0, 0.205, 0}, {0, -1, 0});
    box.inverse_mass = 0.5;
    box.inverse_inertia = 10 * Eigen::Matrix3d::Identity();
    solids = {box};
    pins = {{0, going(Sphere{0}, {0, 0, 0}, velocity_of_pin)}};
  }
  std::vector<Solid> solids;
  std::vector<PinnedNode> pins;
};

// The box may come down to it by the 5 mm that they are apart, and then goes as the pin goes.
TEST(PinnedNode, HoldsUpWhatComesDownOnIt) {
  for (const double speed : {0.0, 0.3, -0.2}) {
    const BoxOnPin scene({0, speed, 0});
    BodyCollision collision;
    const std::vector<BodyContact> contacts = collision.find(scene.solids, kPinnedStep, scene.pins);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].a, 0);
    EXPECT_EQ(contacts[0].b, 1);  // pins follow the solids
    EXPECT_NEAR(contacts[0].gap, 0.005, 1e-9);
    EXPECT_LT((contacts[0].normal - Vec3(0, 1, 0)).norm(), 1e-9);
    const Solid& box = scene.solids[0];
    std::vector<MovingBody> bodies{{box.inverse_mass, box.inverse_inertia, box.velocity},
                                   {.velocity = scene.pins[0].node.velocity}};
    resolve(contacts, bodies, kPinnedStep);
    EXPECT_NEAR(bodies[0].velocity.y(), speed - 0.005 / kPinnedStep, 1e-6);
    EXPECT_EQ(bodies[1].velocity, Vec3(0, speed, 0));  // nothing but its pin moves it
  }
}

// One that it may meet is told by its index: others do not see it.
TEST(PinnedNode, IsMetByItsSolidAlone) {
  BoxOnPin scene({0, 0, 0});
  Solid ball = going(Sphere{0.1}, {0, 5, 0}, {0, 0, 0});
  ball.inverse_mass = 1;
  scene.solids.insert(scene.solids.begin(), ball);
  BodyCollision collision;
  EXPECT_TRUE(collision.find(scene.solids, kPinnedStep, scene.pins).empty());
  scene.pins[0].solid = 1;
  const std::vector<BodyContact> contacts = collision.find(scene.solids, kPinnedStep, scene.pins);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].a, 1);
  EXPECT_EQ(contacts[0].b, 2);
}

}  // namespace
}  // namespace weft
