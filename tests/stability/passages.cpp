#include "passages.h"

#include <algorithm>
#include <memory>

namespace weft::stability {
namespace {

constexpr double kDeep = 1e-3;  ///< m: ways less deep in a solid graze it
constexpr double kFar = 100;    ///< m, of a floor's endless size

/// Of a node's way in a step, as seen from where the solid ends up.
struct Way {
  Vec3 from, to;
  double length() const { return (to - from).norm(); }
  Vec3 at(double along) const { return from + along / length() * (to - from); }
};

/// Where a way enters a shape, m along it; none if it begins inside or comes less than `deep` in, m.
std::optional<double> entry(const PlacedShape& shape, const Way& way, double deep = kDeep) {
  constexpr double kStep = 1e-4;  // m, at least
  const double length = way.length();
  std::optional<double> entered;
  if (!shape.may_touch(way.from, length)) return {};
  for (double along = 0; along < length;) {
    const double distance = shape.surface(way.at(along)).distance;
    if (distance < 0 && along == 0) return {};
    if (distance < 0 && !entered) entered = along;
    if (distance < -deep) return entered;
    along += std::max(std::abs(distance), kStep);  // the surface is as far at least
  }
  return {};
}

/// A node and how its springs may draw it.
struct Drawn {
  Vec3 position, velocity;
  double force = 0;         ///< of all springs, N
  double stiffness = 0;     ///< of all springs, N/m
  double inverse_mass = 0;  ///< 1/kg; 0: pinned, it goes where it is told
};

std::vector<Drawn> read_nodes_of(const Cloth<float>& cloth) {
  const Particles<float>& state = cloth.particles();
  VectorField<float> force(state.grid());
  cloth.springs().add_forces(state.position, force);
  const double stiffness = cloth.springs().node_stiffness();
  std::vector<Drawn> nodes;
  for (int r = 0; r < state.grid().rows; ++r) {
    for (int c = 0; c < state.grid().cols; ++c) {
      const Vec3 pull(double(force.x.at(r, c)), double(force.y.at(r, c)), double(force.z.at(r, c)));
      nodes.push_back({state.position_at(r, c), state.velocity_at(r, c), pull.norm(), stiffness,
                       double(state.inverse_mass.at(r, c))});
    }
  }
  return nodes;
}

/// Whether a solid stands between a point and whence, far away, `direction` comes.
bool is_in_shadow(const PlacedShape& shape, const Vec3& point, const Vec3& direction) {
  const double far = 2 * (std::min(outer_radius(shape.shape), kFar) + (point - shape.centre).norm());
  return entry(shape, {point - far * direction.normalized(), point}).has_value();
}

/// `farthest` is what any node moved, m.
bool passes(const Solid& solid, const Drawn& node, const Vec3& to, double farthest,
            const Simulation<float>& simulation) {
  const double step = simulation.description().time_step;
  const PlacedShape shape = solid.placed(1);
  const Vec3 moved = solid.move_of(node.position, 0, 1), from = node.position + moved;
  const Way way{from, to}, flight{from, node.position + step * node.velocity};
  const std::optional<double> entered = entry(shape, way), flies_in = entry(shape, flight);
  if (!entered) return false;
  // What springs draw in that would have flown past meets it somewhere on its way.
  const Way& meets = flies_in ? flight : way;
  if (!is_in_shadow(shape, to, meets.to - meets.from)) return false;
  const bool unnoticed = (to - flight.to).norm() < outer_radius(shape.shape) / 4;
  if (unnoticed && entry(shape, way, inner_radius(shape.shape) / 2)) return true;
  const double until = flies_in.value_or(*entered);
  const Vec3 met = meets.at(until);
  const double time = (1 - until / meets.length()) * step;
  const double force = node.force + node.stiffness * (farthest + moved.norm());
  const double acceleration = force * node.inverse_mass + simulation.gravity().norm();
  const double behind = -(to - met).dot(shape.surface(met).normal);
  return behind > kDeep + acceleration * time * time;
}

class Passages {
 public:
  Complaint operator()(const Simulation<float>& simulation, double) {
    std::vector<Drawn> now;
    for (const Cloth<float>& cloth : simulation.cloths()) {
      const std::vector<Drawn> nodes = read_nodes_of(cloth);
      now.insert(now.end(), nodes.begin(), nodes.end());
    }
    double farthest = 0;
    for (std::size_t i = 0; i < before_.size(); ++i) {
      farthest = std::max(farthest, (now[i].position - before_[i].position).norm());
    }
    int passed = 0;
    for (std::size_t i = 0; i < before_.size(); ++i) {
      if (now[i].inverse_mass == 0) continue;
      for (const Solid& solid : simulation.colliders().solids()) {
        passed += passes(solid, before_[i], now[i].position, farthest, simulation);
      }
    }
    before_ = std::move(now);
    if (passed == 0) return {};
    return std::to_string(passed) + " nodes passed through a solid";
  }

 private:
  std::vector<Drawn> before_;
};

}  // namespace

Watch nothing_passes(const Setup&) {
  const auto passages = std::make_shared<Passages>();
  return
      [passages](const Simulation<float>& simulation, double time) { return (*passages)(simulation, time); };
}

}  // namespace weft::stability
