#include "cloth/world/cloth_contact.h"

#include <algorithm>
#include <set>
#include <utility>

#include "cloth/contact/recovery/untangling.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/world/cloth.h"

namespace weft {
namespace {

/// Share of the gap that the net keeps features apart by.
constexpr double kNetPart = 0.1;

/// Inverse mass, to the net, of a node on a solid, relative to its own: the net must not push it into that.
constexpr double kOnSolid = 0.1;

/// Repetitions of the net with what solids have held up. After them solids decide: a node that has to yield
/// to both may enter other cloth, which is separated later (untangle), but no solid.
constexpr int kNetRounds = 3;

/// Inverse mass, to the net, of what a solid has held up, relative to its own. With 0 a node of small weight
/// in a pair would move by the inverse of that weight.
constexpr double kHeldUp = 0.01;

template <class Real>
bool stands_still(const Cloth<Real>& cloth) {
  return cloth.asleep() || cloth.frozen();
}

double shorter_side_of_cell(const ClothDescription& cloth, const Grid& grid) {
  return std::min(cloth.size.x() / (grid.cols - 1), cloth.size.y() / (grid.rows - 1));
}

/// What goes on in the next step of an acceleration: no more than a weight presses with. A floor's blow does
/// not: taken for lasting, it threw two sheets that fell half a metre together up by 17 m (backward Euler)
/// and 135 m (BDF2).
Vec3 lasting(const Vec3& acceleration) {
  const double most = standard_gravity().norm(), size = acceleration.norm();
  return size > most ? Vec3(most / size * acceleration) : acceleration;
}

}  // namespace

template <class Real>
bool ClothContact<Real>::laid_out(const std::vector<Cloth<Real>>& cloths) const {
  return std::equal(
      grids_.begin(), grids_.end(), cloths.begin(), cloths.end(),
      [](const Grid& grid, const Cloth<Real>& cloth) { return grid == cloth.particles().grid(); });
}

template <class Real>
void ClothContact<Real>::lay_out(std::vector<Cloth<Real>>& cloths) {
  if (laid_out(cloths)) return;
  std::vector<Grid> grids;
  grids.reserve(cloths.size());
  for (const Cloth<Real>& cloth : cloths) grids.push_back(cloth.particles().grid());
  grids_ = grids;
  search_.set_grids(grids);
  torn_.assign(cloths.size(), nullptr);
  nodes_ = {};
  gaps_.clear();
  cells_.clear();
  double least = parameters_.thickness;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    nodes_.first.push_back(count);
    count += static_cast<std::uint32_t>(grids[i].size());
    cells_.push_back(shorter_side_of_cell(cloths[i].description(), grids[i]));
    gaps_.push_back(std::min(parameters_.thickness, cells_.back() / 2));
    least = std::min(least, gaps_.back());
  }
  nodes_.first.push_back(count);
  nodes_.start.assign(count, Vec3::Zero());
  nodes_.end = nodes_.velocity = nodes_.acceleration = nodes_.support = nodes_.start;
  nodes_.inverse_mass.assign(count, 0.0);
  nodes_.lies.assign(count, 0);
  nodes_.tangled.assign(count, 0);
  pressed_.assign(count, 0);
  on_solid_.assign(count, 0);
  net_ = CollisionNet(kNetPart * least);
  // What is remembered is of other grids.
  contacts_.clear();
  groups_.clear();
  pairs_.clear();
  std::vector<std::vector<std::size_t>> each_alone;
  each_alone.reserve(cloths.size());
  for (std::size_t i = 0; i < cloths.size(); ++i) each_alone.push_back({i});
  set_groups(std::move(each_alone), cloths);
  may_be_tangled_ = true;
  found_ = false;
}

template <class Real>
void ClothContact<Real>::take_over_tears(const std::vector<Cloth<Real>>& cloths) {
  for (std::size_t k = 0; k < cloths.size(); ++k) take_over_tears(cloths, k);
}

template <class Real>
void ClothContact<Real>::take_over_tears(const std::vector<Cloth<Real>>& cloths, std::size_t cloth) {
  const std::shared_ptr<const TornLinks>& torn = cloths[cloth].springs().torn();
  if (torn == torn_[cloth]) return;
  torn_[cloth] = torn;
  search_.set_torn(cloth, *torn);
  contacts_of(cloth).set_torn(part_of(cloth), torn);
}

template <class Real>
void ClothContact<Real>::read(const std::vector<Cloth<Real>>& cloths, std::vector<Vec3>& positions) const {
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    const Vec3& place = cloths[k].particles().place;
    const auto x = kernels::components(cloths[k].particles().position);
    const Grid& grid = grids_[k];
    for (int r = 0; r < grid.rows; ++r) {
      for (std::size_t i = grid.index(r, 0), end = grid.index(r, grid.cols); i < end; ++i) {
        positions[nodes_.first[k] + i] = place + at(x, i);
      }
    }
  }
}

template <class Real>
void ClothContact<Real>::read_masses(const std::vector<Cloth<Real>>& cloths) {
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    const bool still = stands_still(cloths[k]);
    const auto& values = cloths[k].particles().inverse_mass.values();
    std::transform(values.begin(), values.end(), nodes_.inverse_mass.begin() + nodes_.first[k],
                   [&](Real value) { return still ? 0.0 : double(value); });
  }
}

template <class Real>
void ClothContact<Real>::weigh_down(const std::vector<Cloth<Real>>& cloths) {
  const std::vector<char> before = std::exchange(on_solid_, std::vector<char>(on_solid_.size(), 0));
  std::fill(nodes_.lies.begin(), nodes_.lies.end(), 0);
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    for (const Touch& touch : cloths[k].touches()) {
      if (touch.point().between_nodes()) continue;
      const std::size_t n = nodes_.first[k] + touch.node;
      if (before[n] != 0 && nodes_.lies[n] == 0) nodes_.inverse_mass[n] *= kOnSolid;
      on_solid_[n] = 1;
      nodes_.lies[n] = before[n];
    }
  }
}

template <class Real>
void ClothContact<Real>::begin_step(std::vector<Cloth<Real>>& cloths, double dt) {
  lay_out(cloths);
  take_over_tears(cloths);
  crowded_.assign(cloths.size(), 0);
  // While all stand still the pairs of the last step are right, should one wake in this one.
  if (found_ && std::all_of(cloths.begin(), cloths.end(), stands_still<Real>)) return;
  const bool anew = !found_;
  found_ = true;
  left_out_.resize(cloths.size(), 0);
  read(cloths, nodes_.start);
  read_masses(cloths);
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    const Particles<Real>& particles = cloths[k].particles();
    const auto v = kernels::components(particles.velocity);
    // Where a step was left out the last velocities are not those of a step before.
    const bool gap = left_out_[k] != 0 || cloths[k].left_out();
    left_out_[k] = cloths[k].left_out() ? 1 : 0;
    for (std::size_t i = 0; i < grids_[k].size(); ++i) {
      const std::size_t n = nodes_.first[k] + i;
      const Vec3 before = nodes_.velocity[n];
      nodes_.velocity[n] = nodes_.inverse_mass[n] == 0 ? Vec3(0, 0, 0) : at(v, i);
      nodes_.acceleration[n] = Vec3(0, 0, 0);
      const Vec3& given = contacts_of(k).given(part_of(k), i);
      const Vec3 by_layers = nodes_.inverse_mass[n] / dt * given;
      nodes_.support[n] = (nodes_.support[n] + lasting(-by_layers)) / 2;
      const bool pressed = !given.isZero(0), before_it = pressed_[n] != 0;
      pressed_[n] = pressed ? 1 : 0;
      if (anew || gap || nodes_.inverse_mass[n] == 0 || (pressed && before_it)) continue;
      nodes_.acceleration[n] = lasting((nodes_.velocity[n] - before) / dt - by_layers);
    }
  }
  std::transform(nodes_.start.begin(), nodes_.start.end(), nodes_.velocity.begin(), nodes_.end.begin(),
                 [&](const Vec3& x, const Vec3& v) { return x + dt * v; });
  if (may_be_tangled_ || std::any_of(cloths.begin(), cloths.end(), [](const auto& c) { return c.settled(); }))
    untangle(cloths);
  find_pairs(cloths, dt);
}

template <class Real>
void ClothContact<Real>::untangle(std::vector<Cloth<Real>>& cloths) {
  const std::vector<Crossing> crossings = search_.find_crossings(nodes_);
  nodes_.tangled.assign(nodes_.start.size(), 0);
  for (const Crossing& crossing : crossings) {
    for (const std::uint32_t n : crossing.edge) nodes_.tangled[n] = 1;
    for (const std::uint32_t n : crossing.triangle) nodes_.tangled[n] = 1;
  }
  tangled_ = static_cast<int>(std::count(nodes_.tangled.begin(), nodes_.tangled.end(), 1));
  may_be_tangled_ = tangled_ > 0;
  if (!may_be_tangled_) return;
  const double longest = *std::min_element(gaps_.begin(), gaps_.end());
  const std::vector<Vec3> moves = untangling_moves(crossings, nodes_, longest);
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    bool changed = false;
    for (std::size_t i = 0; i < grids_[k].size(); ++i) {
      const std::size_t n = nodes_.first[k] + i;
      if (moves[n].isZero(0)) continue;
      add(kernels::components(cloths[k].particles().position), i, moves[n]);
      nodes_.start[n] += moves[n];
      nodes_.end[n] += moves[n];
      contacts_of(k).strike(part_of(k), i);
      changed = true;
    }
    if (changed) cloths[k].moved_from_outside();
  }
}

template <class Real>
void ClothContact<Real>::end_step(std::vector<Cloth<Real>>& cloths, double dt) {
  if (std::all_of(cloths.begin(), cloths.end(), stands_still<Real>)) return;
  if (cloths.size() > 1) {
    std::vector<std::vector<PairForce>*> forces;
    for (const auto& contacts : contacts_) forces.push_back(&contacts->forces());
    share_forces(forces);
  }
  read(cloths, nodes_.end);
  read_masses(cloths);
  weigh_down(cloths);
  stop_what_meets(cloths, dt);
}

template <class Real>
void ClothContact<Real>::stop_what_meets(std::vector<Cloth<Real>>& cloths, double dt) {
  for (int round = 0; round < kNetRounds; ++round) {
    if (!net_.apply(search_, nodes_) || !move_on(cloths, dt)) return;
  }
  may_be_tangled_ = true;
}

template <class Real>
bool ClothContact<Real>::move_on(std::vector<Cloth<Real>>& cloths, double dt) {
  const std::vector<Vec3>& untouched = net_.untouched_end();
  bool met = false;
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    const VectorField<Real> before = cloths[k].particles().position;
    bool changed = false;
    for (std::size_t i = 0; i < grids_[k].size(); ++i) {
      const std::size_t n = nodes_.first[k] + i;
      if (nodes_.end[n] == untouched[n]) continue;
      Particles<Real>& particles = cloths[k].particles();
      const Vec3 moved = nodes_.end[n] - untouched[n];
      add(kernels::components(particles.position), i, moved);
      if (nodes_.inverse_mass[n] > 0) add(kernels::components(particles.velocity), i, moved / dt);
      contacts_of(k).strike(part_of(k), i);
      changed = true;
    }
    if (!changed) continue;
    std::set<std::size_t> held_up;
    for (const Touch& touch : cloths[k].keep_outside(before, dt)) {
      ClothPoint<Real>(touch.point(), cloths[k].particles()).for_each_node([&](std::size_t node, double) {
        held_up.insert(node);
      });
    }
    for (const std::size_t node : held_up) {
      const std::size_t n = nodes_.first[k] + node;
      const Particles<Real>& outside = cloths[k].particles();
      nodes_.end[n] = outside.place + at(kernels::components(outside.position), node);
      nodes_.inverse_mass[n] *= kHeldUp;
      met = true;
    }
    cloths[k].moved_from_outside();
  }
  return met;
}

template class ClothContact<float>;
template class ClothContact<double>;

}  // namespace weft
