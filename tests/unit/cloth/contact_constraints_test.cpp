// How far along a change contacts let a step go.
#include <gtest/gtest.h>

#include "cloth/contact/contact_constraints.h"
#include "cloth/solver/node_arrays.h"
#include "fixtures.h"

namespace weft {
namespace {

constexpr double kStiffness = 1000;  // N/m

/// The node in the middle of 3 x 3, 2 mm over a floor that was expected to hold it.
class BestShare : public ::testing::Test {
 protected:
  BestShare() {
    floor_.id = 1;
    floor_.shape = HalfSpace{};
    test::set(particles_.position, 1, 1, {0, 0.002, 0});
    constraints_.begin({{node_, floor_.id}}, {}, particles_, {floor_}, Substep{}, bodies_);
    blocks_.clear();
    constraints_.add_to(blocks_.blocks(), vectors_.vector(0), bodies_, diagonal_[0], kStiffness,
                        vectors_.vector(3));
  }
  /// Of a change of the node by `way`, m.
  double best_share(double way, double decrease) {
    vectors_.vector(6).y[node_] = way;
    return constraints_.best_share(vectors_.vector(3), vectors_.vector(6), bodies_, decrease);
  }
  void release() {
    const double energy = constraints_.release_pulling(vectors_.vector(3), bodies_);
    EXPECT_NEAR(energy, kStiffness * 0.002 * 0.002 / 2, 1e-12);  // of a spring that pulls 2 mm down
  }

  Grid grid_ = Grid::with_nodes(3, 3);
  std::size_t node_ = grid_.index(1, 1);
  Particles<double> particles_{grid_};
  Solid floor_;
  AttachedBodies<double> bodies_;
  ContactConstraints<double> constraints_;
  NodeArrays<double> blocks_{grid_, 6}, vectors_{grid_, 9}, diagonal_{grid_, 1};
};

TEST_F(BestShare, IsTheWholeWhereNothingComesInTheWay) {
  release();
  EXPECT_EQ(best_share(0.01, 0.5), 1);    // away from the floor
  EXPECT_EQ(best_share(-0.001, 0.5), 1);  // not as far as the floor
}

TEST_F(BestShare, EndsWhereTheFloorHoldsTheNode) {
  release();
  // Along t the system's energy is -t (2 - t) D, the floor's k (t L - a)^2 / 2 beyond a = 2 mm of L = 10 mm:
  // least at t = (2 D + k a L) / (2 D + k L^2).
  for (const double decrease : {0.001, 0.02, 0.5}) {
    const double least = (2 * decrease + kStiffness * 0.002 * 0.01) / (2 * decrease + kStiffness * 1e-4);
    EXPECT_NEAR(best_share(-0.01, decrease), least, 1.0 / 1024) << decrease << " J";
  }
}

TEST_F(BestShare, DoesNotCountASpringThatPulls) {
  // Held, the node is drawn to the floor, though nothing but the spring draws it: up to the floor.
  EXPECT_EQ(best_share(-0.002, kStiffness * 0.002 * 0.002 / 2), 1.0);
  // Upwards the system, which counts the spring, ends at 1; without it the energy still falls there.
  EXPECT_EQ(best_share(0.001, 1e-5), 1.0);
}

}  // namespace
}  // namespace weft
