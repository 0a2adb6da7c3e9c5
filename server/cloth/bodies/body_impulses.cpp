#include "cloth/bodies/body_impulses.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace weft {
namespace {

/// Sweeps at most, and the change of speed, m/s, below which there are no more.
constexpr int kSweeps = 300;
constexpr double kConverged = 1e-9;
/// Of an overlap that a step leaves: all at once would make bodies in a pile throw each other about.
constexpr double kShare = 0.2;

/// The inverse of the mass, 1/kg, that a force along `direction` finds (Solid::inverse_mass_at).
double inverse_mass_at(const MovingBody& body, const Vec3& arm, const Vec3& direction) {
  const Vec3 lever = arm.cross(direction);
  return body.inverse_mass + lever.dot(body.inverse_inertia * lever);
}

/// A contact while it is resolved.
struct Row {
  const BodyContact* contact;
  MovingBody *a, *b;
  double inverse_mass;  ///< along the normal, 1/kg
  BodyImpulse impulse{};
  Vec3 before{0, 0, 0};     ///< velocity() without impulses, m/s
  double displacement = 0;  ///< along the normal, kg m

  double inverse_mass_along(const Vec3& direction) const {
    return inverse_mass_at(*a, contact->arm_a, direction) + inverse_mass_at(*b, contact->arm_b, direction);
  }
  /// Of a as seen from b, m/s.
  Vec3 velocity() const {
    return a->velocity + a->spin.cross(contact->arm_a) - b->velocity - b->spin.cross(contact->arm_b);
  }
  void push(const Vec3& impulse_on_a) const {
    a->velocity += a->inverse_mass * impulse_on_a;
    a->spin += a->inverse_inertia * contact->arm_a.cross(impulse_on_a);
    b->velocity -= b->inverse_mass * impulse_on_a;
    b->spin -= b->inverse_inertia * contact->arm_b.cross(impulse_on_a);
  }
  /// With what the contact starts with, as far as friction can have it.
  void start() {
    impulse = contact->start;
    const double most = contact->friction * (contact->borne + impulse.along);
    if (const double force = impulse.rubbing.norm(); force > most) impulse.rubbing *= most / force;
    push(impulse.along * contact->normal + impulse.rubbing);
  }
  /// The same as velocity() and push(), of shifts without motion.
  double shift_along_normal() const {
    const Vec3 shift = a->shift + a->turn.cross(contact->arm_a) - b->shift - b->turn.cross(contact->arm_b);
    return contact->normal.dot(shift);
  }
  void shift(const Vec3& by) const {
    a->shift += a->inverse_mass * by;
    a->turn += a->inverse_inertia * contact->arm_a.cross(by);
    b->shift -= b->inverse_mass * by;
    b->turn -= b->inverse_inertia * contact->arm_b.cross(by);
  }
};

/// Returns the change of speed, m/s.
double stop_approach(Row& row, double dt) {
  const Vec3& normal = row.contact->normal;
  const double allowed = std::max(row.contact->gap, 0.0) / dt;
  const double wanted = -(normal.dot(row.velocity()) + allowed) / row.inverse_mass;
  const double impulse = std::max(0.0, row.impulse.along + wanted), change = impulse - row.impulse.along;
  row.impulse.along = impulse;
  row.push(change * normal);
  return std::abs(change) * row.inverse_mass;
}

/// Within Coulomb's cone, towards no slip.
double rub(Row& row) {
  const BodyContact& contact = *row.contact;
  const Vec3 velocity = row.velocity(), slip = velocity - velocity.dot(contact.normal) * contact.normal;
  const double speed = slip.norm(), most = contact.friction * (contact.borne + row.impulse.along);
  if (speed == 0 && row.impulse.rubbing.squaredNorm() <= most * most) return 0;
  const Vec3 direction = speed > 0 ? Vec3(slip / speed) : row.impulse.rubbing.normalized();
  const double inverse_mass = row.inverse_mass_along(direction);
  Vec3 friction = row.impulse.rubbing - speed / inverse_mass * direction;
  if (const double force = friction.norm(); force > most) friction *= most / force;
  const Vec3 change = friction - row.impulse.rubbing;
  row.impulse.rubbing = friction;
  row.push(change);
  return change.norm() * inverse_mass;
}

/// Apart by a share of the overlap that the step's ways leave, and no nearer than a gap that they leave: what
/// pushes from the other side must not bring in what is outside. Returns the change, m.
double part(Row& row, double dt) {
  const double gap = row.contact->gap, opens = row.contact->normal.dot(row.velocity()) * dt;
  const double wanted =
      gap >= 0 ? std::min(0.0, -gap - opens) : -kShare * std::min(0.0, gap + std::max(0.0, opens));
  const double change_wanted = (wanted - row.shift_along_normal()) / row.inverse_mass;
  const double displacement = std::max(0.0, row.displacement + change_wanted);
  const double change = displacement - row.displacement;
  row.displacement = displacement;
  row.shift(change * row.contact->normal);
  return std::abs(change) * row.inverse_mass;
}

/// Work of all impulses, J: each times the mean of the relative velocities before and after.
double energy_given(const std::vector<Row>& rows) {
  double given = 0;
  for (const Row& row : rows) {
    const Vec3 impulse = row.impulse.along * row.contact->normal + row.impulse.rubbing;
    given += impulse.dot(row.before + row.velocity()) / 2;
  }
  return given;
}

/// `change_by`(row) over all rows until it changes by `converged` at most; where that is not to be had, over
/// those from `firm` on then, which nothing gives way to. To and fro: what one end of a pile bears is so
/// passed to the other end in one sweep, whichever of the two comes first.
template <class Change>
void sweep(std::vector<Row>& rows, std::vector<Row>::iterator firm, double converged,
           const Change& change_by) {
  for (const auto first : {rows.begin(), firm}) {
    for (int i = 0; i < kSweeps; ++i) {
      double change = 0;
      const auto look = [&](Row& row) { change = std::max(change, change_by(row)); };
      if (i % 2 == 0) {
        std::for_each(first, rows.end(), look);
      } else {
        std::for_each(rows.rbegin(), std::reverse_iterator(first), look);
      }
      if (!(change > converged)) return;
    }
  }
}

}  // namespace

std::vector<BodyImpulse> resolve(const std::vector<BodyContact>& contacts, std::vector<MovingBody>& bodies,
                                 double dt) {
  std::vector<Row> rows;
  rows.reserve(contacts.size());
  for (const BodyContact& contact : contacts) {
    Row row{&contact, &bodies[static_cast<std::size_t>(contact.a)],
            &bodies[static_cast<std::size_t>(contact.b)], 0};
    row.inverse_mass = row.inverse_mass_along(contact.normal);
    if (row.inverse_mass > 0) rows.push_back(row);
  }
  const auto firm = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.contact->firm; });
  const auto stop_and_rub = [&] {
    sweep(rows, firm, kConverged, [&](Row& row) {
      const double rubbed = row.contact->friction > 0 ? rub(row) : 0;
      return std::max(rubbed, stop_approach(row, dt));
    });
  };
  const std::vector<MovingBody> before = bodies;
  for (Row& row : rows) row.before = row.velocity();
  for (Row& row : rows) row.start();
  stop_and_rub();
  if (energy_given(rows) > 0) {
    bodies = before;
    for (Row& row : rows) row.impulse = {};
    stop_and_rub();
  }
  sweep(rows, firm, kConverged * dt, [&](Row& row) { return part(row, dt); });
  std::vector<BodyImpulse> impulses(contacts.size());
  for (const Row& row : rows) impulses[static_cast<std::size_t>(row.contact - contacts.data())] = row.impulse;
  return impulses;
}

}  // namespace weft
