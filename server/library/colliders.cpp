#include "library/checks.h"
#include "library/world_impl.h"

namespace weft {

using library::to_vector;
using library::within;

Vector World::Ball::position() const { return to_vector(world_->ball(id_).position); }
Vector World::Ball::velocity() const { return to_vector(world_->ball(id_).velocity); }
double World::Ball::radius() const { return world_->ball(id_).radius; }

void World::Ball::move_to(const Vector& position) {
  world_->ball(id_);
  world_->simulation.move_ball(id_, within(position, "position", library::kPlace));
}

void World::Ball::throw_off(const Vector& velocity) {
  world_->ball(id_);
  world_->simulation.throw_ball(id_, within(velocity, "velocity", library::kSpeed));
}

void World::Ball::set_friction(double friction) {
  world_->ball(id_);
  world_->simulation.set_ball_friction(id_, within(friction, "friction", library::kFriction));
}

void World::Ball::remove() {
  world_->ball(id_);
  world_->simulation.remove_ball(id_);
}

Vector World::Obstacle::position() const { return to_vector(world_->obstacle(index_).pose.position); }

Turn World::Obstacle::turn() const {
  const Quaternion& turn = world_->obstacle(index_).pose.orientation;
  return {turn.w(), turn.x(), turn.y(), turn.z()};
}

bool World::Obstacle::is_body() const { return world_->obstacle(index_).body.has_value(); }

void World::Obstacle::move_to(const Vector& position, const std::optional<Turn>& turn) {
  Pose pose{within(position, "position", library::kPlace), world_->obstacle(index_).pose.orientation};
  if (turn) pose.orientation = library::unit_turn(*turn, "turn");
  world_->simulation.move_obstacle(index_, pose);
}

void World::Obstacle::throw_off(const Vector& velocity, const Vector& spin) {
  const Vec3 by = within(velocity, "velocity", library::kSpeed),
             around = within(spin, "spin", library::kSpin);
  if (!world_->simulation.throw_obstacle(index_, by, around)) {
    throw Error("obstacle " + std::to_string(index_) + " has no mass: it cannot be thrown");
  }
}

World::Hand World::Obstacle::grab(const Vector& point, double max_force) {
  const Vec3 at = within(point, "point", library::kPlace);
  const double force = within(max_force, "max_force", library::kForce);
  const auto hand = world_->simulation.grab_obstacle(index_, at, std::nullopt, force);
  if (!hand) throw Error("obstacle " + std::to_string(index_) + " has no mass: it cannot be grabbed");
  return {*world_, *hand};
}

void World::Obstacle::set_friction(double friction) {
  world_->simulation.set_obstacle_friction(index_, within(friction, "friction", library::kFriction));
}

void World::Hand::move_to(const Vector& position) {
  if (!world_->simulation.move_grab(id_, within(position, "position", library::kPlace))) {
    throw Error("hand " + std::to_string(id_) + " holds nothing any longer");
  }
}

void World::Hand::release() { world_->simulation.release(id_); }

}  // namespace weft
