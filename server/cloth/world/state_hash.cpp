#include "cloth/world/state_hash.h"

#include <cstddef>

#include "cloth/core/fnv1a.h"

namespace weft {
namespace {

class Hash : public Fnv1a {
 public:
  using Fnv1a::add;
  template <class Real>
  void add(const VectorField<Real>& field) {
    const Grid& grid = field.grid();
    for (const Field<Real>* component : {&field.x, &field.y, &field.z}) {
      for (int r = 0; r < grid.rows; ++r) {  // padding is nobody's business
        add(component->row(r), static_cast<std::size_t>(grid.cols) * sizeof(Real));
      }
    }
  }
  void add(const Vec3& vector) { add(vector.data(), 3 * sizeof(double)); }
  void add(const Eigen::Vector4d& vector) { add(vector.data(), 4 * sizeof(double)); }
};

}  // namespace

template <class Real>
std::uint64_t state_hash(const Simulation<Real>& simulation) {
  Hash hash;
  hash.add(simulation.step_count());
  for (const Cloth<Real>& cloth : simulation.cloths()) {
    hash.add(cloth.level());
    const Vec3& place = cloth.particles().place;
    if (!place.isZero(0)) hash.add(place);  // one at the origin has none to tell
    hash.add(cloth.particles().position);
    hash.add(cloth.particles().velocity);
    if (cloth.walls() != nullptr) {  // a whole cloth has none to tell
      const Grid& grid = cloth.walls()->finest().grid();
      for (int r = 0; r < grid.rows; ++r) {
        for (int c = 0; c < grid.cols; ++c) {
          for (const bool along_u : {true, false}) hash.add(cloth.walls()->finest().torn({r, c, along_u}));
        }
      }
    }
  }
  for (const Ball& ball : simulation.colliders().balls()) {
    hash.add(ball.id);
    hash.add(ball.position);
    hash.add(ball.velocity);
    if (!ball.spin.isZero(0)) hash.add(ball.spin);  // one that never rolled has none to tell
  }
  for (const Obstacle& obstacle : simulation.colliders().obstacles()) {
    if (!obstacle.flies()) continue;  // where the others are follows from the commands
    hash.add(obstacle.solid.id);
    hash.add(obstacle.pose.position);
    hash.add(Eigen::Vector4d(obstacle.pose.orientation.coeffs()));
    hash.add(obstacle.body->velocity());
    hash.add(obstacle.body->angular_momentum());
  }
  return hash.value();
}

template std::uint64_t state_hash(const Simulation<float>&);
template std::uint64_t state_hash(const Simulation<double>&);

}  // namespace weft
