#include "cloth/levels/settle.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Cells: nodes that lie on a solid are in it by rounding, and a step that pushes out what is a little deeper
/// strains no spring.
constexpr double kShallow = 0.01;

/// Relaxation steps at most (DECISIONS.md): a solid lifts what hangs on it step by step; by level they end
/// once there is nothing left to let go.
int steps_from(Unsettled by) {
  switch (by) {
    case Unsettled::by_solid:
      return 5;
    case Unsettled::by_level:
      return 12;
    default:
      return 3;
  }
}

/// The sheet holds no more than `energy`, J.
template <class Real>
bool hold_at_most(double energy, const Particles<Real>& particles, const Forces<Real>& forces) {
  return forces.sheet->energy(particles.position) <= energy;
}

/// Some free node is deeper in a solid than this, m.
template <class Real>
bool any_deeper(double depth, const Particles<Real>& particles, Contact<Real>& contact,
                const std::vector<Solid>& still) {
  const auto position = kernels::components(particles.position);
  const std::vector<Touch>& touches = contact.inside(particles, still, {});
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
    const auto solid = std::find_if(still.begin(), still.end(),
                                    [&](const Solid& each) { return each.id == touch.collider; });
    return -solid->gap(ClothPoint<Real>(touch.point(), particles).of(position), 0) > depth;
  });
}

/// As they are when the step begins, at rest, and smooth.
std::vector<Solid> at_start(std::vector<Solid> solids) {
  for (Solid& solid : solids) {
    solid.rotation = solid.placed(0).rotation;
    solid.position = solid.start;
    solid.velocity = solid.turn = solid.spin = Vec3::Zero();
    solid.inverse_mass = 0;
    solid.friction = 0;  // it would hold what is stretched across an edge, pressed to the solid by that
  }
  return solids;
}

template <class Real>
void stop(Particles<Real>& particles) {
  for (VectorField<Real>* field : {&particles.velocity, &particles.acceleration}) {
    for (Field<Real>* component : {&field->x, &field->y, &field->z}) {
      std::fill(component->values().begin(), component->values().end(), Real(0));
    }
  }
}

}  // namespace

double shallow(const ClothDescription& cloth, const Grid& grid) {
  return kShallow * cloth.size.maxCoeff() / std::max(grid.rows - 1, grid.cols - 1);
}

template <class Real>
bool is_put_onto(const Particles<Real>& particles, Contact<Real>& contact, const std::vector<Solid>& solids) {
  std::vector<Solid> put;
  std::copy_if(solids.begin(), solids.end(), std::back_inserter(put),
               [](const Solid& s) { return s.just_put; });
  return !put.empty() && !contact.inside(particles, at_start(put), {}).empty();
}

template <class Real>
bool settle(Particles<Real>& particles, Unsettled by, Forces<Real> forces, Contact<Real>* contact,
            const std::vector<Solid>& solids, double longest, double enough) {
  const ClothDescription& cloth = *forces.context.cloth;
  const Stiffness& along = cloth.material.structural;
  const double crossing = cloth.size.maxCoeff() * std::sqrt(cloth.material.density / along.least());
  const Particles<Real> before = particles;
  std::vector<Solid> still = at_start(solids);
  const Wind calm;
  const std::vector<std::unique_ptr<Effect<Real>>> no_effects;
  forces.effects = &no_effects;
  forces.context.wind = &calm;
  const auto relaxing = make_integrator<Real>(BackwardEulerDescription{});
  const auto fits_its_level = [&] {
    return hold_at_most(enough, particles, forces) &&
           (contact == nullptr || !any_deeper(shallow(cloth, particles.grid()), particles, *contact, still));
  };
  bool sound = true, moved = false;
  for (int step = 0; step < steps_from(by) && sound; ++step) {
    if (by == Unsettled::by_level && fits_its_level()) break;
    moved = true;
    stop(particles);
    sound =
        relaxing->advance(particles, forces, contact, still, forces.context.time, std::min(crossing, longest))
            .sound;
  }
  if (!sound) particles.position = before.position;
  particles.velocity = before.velocity;
  particles.acceleration = before.acceleration;
  return moved && sound;
}

template bool is_put_onto<float>(const Particles<float>&, Contact<float>&, const std::vector<Solid>&);
template bool is_put_onto<double>(const Particles<double>&, Contact<double>&, const std::vector<Solid>&);
template bool settle<float>(Particles<float>&, Unsettled, Forces<float>, Contact<float>*,
                            const std::vector<Solid>&, double, double);
template bool settle<double>(Particles<double>&, Unsettled, Forces<double>, Contact<double>*,
                             const std::vector<Solid>&, double, double);

}  // namespace weft
