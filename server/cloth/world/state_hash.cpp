#include "cloth/world/state_hash.h"

#include <cstddef>

namespace weft {
namespace {

class Hash {
 public:
  /// `value`'s own bytes: a type without padding.
  template <class T>
  void add(const T& value) {
    add(&value, sizeof value);
  }
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * kPrime;
  }
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
  std::uint64_t value() const { return value_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t value_ = 0xcbf29ce484222325;
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
