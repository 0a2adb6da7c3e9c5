#include "fabric/specimen.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cloth/levels/refine.h"

namespace weft::fabric {
namespace {

/// Nothing is given back to a motion that is to end.
BackwardEulerDescription to_rest(double tolerance) {
  BackwardEulerDescription solver;
  solver.tolerance = tolerance;
  solver.newton_iterations = 3;
  solver.linear_iterations = 1000;
  solver.liveliness = 0;
  return solver;
}

template <class Visit>
void for_each_node(const Grid& grid, Visit visit) {
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) visit(r, c);
  }
}

/// Every link that has an end that is not there.
std::shared_ptr<TornLinks> links_cut(const Grid& grid, const std::function<bool(int, int)>& there) {
  auto cut = std::make_shared<TornLinks>(grid);
  for_each_node(grid, [&](int r, int c) {
    if (c + 1 < grid.cols && !(there(r, c) && there(r, c + 1))) cut->cut({r, c, true});
    if (r + 1 < grid.rows && !(there(r, c) && there(r + 1, c))) cut->cut({r, c, false});
  });
  return cut;
}

std::vector<EffectDescription> effects_of(const SpecimenPlan& plan) {
  if (plan.gravity == 0) return {};
  return {GravityEffect{Vec3(0, -plan.gravity, 0)}};
}

}  // namespace

Specimen::Specimen(const SpecimenPlan& plan)
    : particles_(Grid::with_nodes(plan.rows, plan.cols)),
      springs_(plan.material, Discretization::continuum, plan.size, particles_.grid(), 0, plan.limited),
      effects_(make_effects<double>(effects_of(plan))),
      integrator_(make_integrator<double>(to_rest(plan.tolerance))) {
  cloth_.size = plan.size;
  cloth_.material = plan.material;
  const double hx = plan.size.x() / (plan.cols - 1), hz = plan.size.y() / (plan.rows - 1);
  mass_distribution(plan.material.density * plan.size.x() * plan.size.y(), Discretization::continuum,
                    particles_.mass);
  there_.assign(static_cast<std::size_t>(grid().nodes()), 1);
  for_each_node(grid(), [&](int r, int c) {
    const bool is_there = !plan.there || plan.there(r, c);
    there_[place_of(r, c)] = is_there ? 1 : 0;
    const bool held = !is_there || (plan.held && plan.held(r, c));
    particles_.inverse_mass.at(r, c) = held ? 0 : 1 / particles_.mass.at(r, c);
    put(r, c, Vec3(c * hx, 0, r * hz));
  });
  if (plan.there) {
    cut_ = links_cut(grid(), plan.there);
    springs_.tear(cut_);
  }
  if (plan.bends) plate_.emplace(plan.material.rigidity, plan.size, particles_.inverse_mass, cut_.get());
}

void Specimen::put(int r, int c, const Vec3& position) {
  particles_.position.x.at(r, c) = position.x();
  particles_.position.y.at(r, c) = position.y();
  particles_.position.z.at(r, c) = position.z();
}

bool Specimen::there(int r, int c) const { return there_[place_of(r, c)] != 0; }

bool Specimen::face_there(int r, int c) const {
  return there(r, c) && there(r, c + 1) && there(r + 1, c) && there(r + 1, c + 1);
}

Forces<double> Specimen::forces(double time) const {
  return {.springs = &springs_,
          .effects = &effects_,
          .context = {&cloth_, &calm_, time},
          .plate = plate_ ? &*plate_ : nullptr};
}

double Specimen::advance(double step) {
  const VectorField<double> before = particles_.position;
  if (!integrator_->advance(particles_, forces(time_), nullptr, no_solids_, time_, step).sound)
    throw NoRest("the specimen has no next state");
  time_ += step;
  double way = 0;
  for_each_node(grid(), [&](int r, int c) {
    const Vec3 moved = at(r, c) - Vec3(before.x.at(r, c), before.y.at(r, c), before.z.at(r, c));
    way = std::max(way, moved.norm());
  });
  return way;
}

void Specimen::rest(double step, double still, int most) {
  double way = still;
  for (int n = 0; n < most && way >= still; ++n) way = advance(step);
  if (way >= still)
    throw NoRest("the specimen moves still, " + std::to_string(way * 1e3) + " mm a step, after " +
                 std::to_string(most) + " steps");
}

VectorField<double> Specimen::pull() const {
  VectorField<double> force(grid());
  springs_.add_forces(particles_.position, force);
  return force;
}

double Specimen::bending_energy() const { return plate_ ? plate_->energy(particles_.position) : 0; }

Material turned(const Material& material) {
  Material other = material;
  std::swap(other.structural.warp, other.structural.weft);
  std::swap(other.rigidity.u, other.rigidity.v);
  std::swap(other.limit.warp, other.limit.weft);
  return other;
}

}  // namespace weft::fabric
