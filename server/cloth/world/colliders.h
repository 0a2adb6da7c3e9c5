#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cloth/bodies/body_collision.h"
#include "cloth/bodies/body_hand.h"
#include "cloth/bodies/body_touch.h"
#include "cloth/bodies/collider_description.h"
#include "cloth/bodies/kept_impulses.h"
#include "cloth/bodies/rigid_body.h"
#include "cloth/shapes/solid.h"
#include "cloth/sleep/islands.h"

namespace weft {

using BallId = ColliderId;

/// A ball as it is now. During a step it moves on a straight line from `start` to `position`.
struct Ball {
  BallId id = 0;
  BallDescription::Motion motion = BallDescription::Motion::kinematic;
  double radius = 0;       ///< m
  double mass = 0;         ///< kg, dynamic only
  double friction = 0;     ///< Coulomb's coefficient
  Vec3 position{0, 0, 0};  ///< at the end of the step, m
  Vec3 start{0, 0, 0};     ///< at its start, m
  Vec3 velocity{0, 0, 0};  ///< mean over the step, m/s: what the cloth feels
  bool just_put = true;    ///< Solid::just_put
  Vec3 pushed{0, 0, 0};    ///< from its way by the cloths during the step, m; taken up when the step ends
  Vec3 sped_up{0, 0, 0};   ///< the same of its velocity, m/s
  int sharing = 1;         ///< cloths that see a share of its mass in this step
  Vec3 spin{0, 0, 0};      ///< if dynamic, rad/s: what it rolls on other solids with; cloths see none
  std::vector<Waypoint> path;
  bool loops = false;  ///< the path
  BodyRest rest;       ///< if dynamic

  template <class Archive>
  void serialize(Archive& archive) {
    archive(id, motion, radius, mass, friction, position, start, velocity, just_put, pushed, sped_up, sharing,
            spin, path, loops, rest);
  }
  /// Dynamic, asleep or not.
  bool flies() const { return motion == BallDescription::Motion::dynamic; }
  bool awake() const { return flies() && !rest.asleep(); }
  Solid solid() const;
};

/// An obstacle as it is now. During a step it goes and turns evenly from pose to pose, but for what cloths
/// give a dynamic body.
struct Obstacle {
  Solid solid;
  std::shared_ptr<const TriangleMesh> surface;  ///< that the solid's shape is within, if it is a mesh
  Pose pose;            ///< at the end of the step; a plane's orientation says nothing
  bool mobile = false;  ///< follows a path, flies, or was moved or thrown since the start
  std::vector<PoseWaypoint> path;
  bool loops = false;          ///< the path
  std::optional<Pose> target;  ///< where it was told to go, until it is there
  std::optional<RigidBody> body;
  BodyRest rest;  ///< if it flies

  /// But for the shape, which does not change (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(solid, pose, mobile, path, loops, target, rest);
    if (body) archive(*body);
  }
  /// Puts it there.
  void take(const Pose& place);
  /// Dynamic, asleep or not.
  bool flies() const { return body && body->dynamic(); }
  bool awake() const { return flies() && !rest.asleep(); }
};

/// The scene's balls and obstacles. Ids of balls count up from 1 and are never used again until a reset.
class Colliders {
 public:
  Colliders() = default;
  /// `sleep_speed`, m/s, as in SimulationDescription; 0: dynamic balls and bodies never sleep.
  explicit Colliders(const std::vector<BallDescription>& balls,
                     const std::vector<ObstacleDescription>& obstacles = {}, double sleep_speed = 0);

  const std::vector<Ball>& balls() const { return balls_; }
  const std::vector<Obstacle>& obstacles() const { return obstacles_; }
  const Ball* find(BallId id) const;
  /// All that the cloths may meet in the step that has begun: the balls in their order, then the obstacles.
  const std::vector<Solid>& solids() const { return solids_; }

  BallId add(const BallDescription& ball);
  /// The ball becomes kinematic, goes to `target` within the next step and stays there. False if there is no
  /// such ball.
  bool move(BallId id, const Vec3& target);
  /// The ball becomes dynamic and flies off. False if there is no such ball.
  bool throw_ball(BallId id, const Vec3& velocity);
  bool remove(BallId id);
  /// Coulomb's coefficient, >= 0, from the next step on; what sleeps wakes. False if there is no such ball.
  bool set_friction(BallId id, double friction);
  /// The same of an obstacle, by its place in obstacles().
  bool set_obstacle_friction(std::size_t index, double friction);
  /// The obstacle, by its place in obstacles(), leaves its path, or flies no more, takes the pose within the
  /// next step and stays there. False if there is no such obstacle.
  bool move_obstacle(std::size_t index, const Pose& target);
  /// The obstacle leaves its path and flies off. False if there is no such obstacle, or it is no body.
  bool throw_obstacle(std::size_t index, const Vec3& velocity, const Vec3& spin);
  /// A hand takes hold of a body, which leaves its path and is moved by what it is pulled by, and falls.
  /// False if there is no such obstacle, or it is no body.
  bool grab(const BodyHand& hand);
  /// Where the hand goes; false if there is no such hand.
  bool move_grab(GrabId id, const Vec3& hand);
  bool release(GrabId id);
  const std::vector<BodyHand>& hands() const { return hands_; }

  /// Moves every ball from `time` to `time + dt`: along its path, to its target, or by `gravity` and its
  /// velocity; and every obstacle along its path, to its target, or as it flies.
  ///
  /// Dynamic balls and bodies that lie still on nothing but what does so too fall asleep before: until
  /// something comes, moves or is taken away near them they are left where they are, at rest, to the bit, and
  /// stand still for whoever meets them. `cloths` are those that they may lie on or under; of no use unless
  /// may_rest(). What was told to go somewhere gets there in so many such steps, the last part of a step that
  /// is made in parts.
  void begin_step(double time, double dt, const Vec3& gravity, const std::vector<Sleeper>& cloths = {},
                  int parts_left = 1);
  /// A dynamic ball or body sleeps, or may fall asleep when the next step begins.
  bool may_rest() const;
  /// All that sleeps wakes.
  void wake();
  /// So many cloths, at least 1, will touch the ball, or the body, in the step that has begun. They are
  /// stepped side by side and know nothing of each other, and would all stop the same ball, and so throw it
  /// back: it is for each of them a ball of its share of the mass, and at the end the mean of these, which
  /// has their momentum and at most their kinetic energy (Tonge, Benevolenski, Voroshilov, Mass Splitting for
  /// Jitter-Free Parallel Rigid Body Simulation, 2012).
  void share(ColliderId id, int cloths);
  /// How one cloth met solids() in the step, and how it leaves them, both as seen from one place; the order
  /// of the calls decides the last bits.
  void push(const std::vector<Solid>& met, const std::vector<Solid>& left);
  /// Dynamic balls and bodies take up what the cloths gave them. False if that is nothing.
  bool end_step();
  /// The step of dt, s, is over: tells what lies still.
  void watch(double dt);
  /// There is a dynamic ball or body that is awake, and something that it may meet.
  bool may_meet() const;
  /// Dynamic balls and bodies stop and shove each other, and stop at what else is in their way, in the step
  /// of dt, s, that has begun, or, with what the cloths gave them, ended: their ways are bent, and solids().
  /// Again where a hit turned one by so much that what was told of its points by the way that it began with
  /// is off by more than 0.1 mm. `pins` hold up what they meet.
  /// `pushed`, once the step has ended: what it has pushed them apart by, which friction also has. Without it
  /// the step begins: the impulses start from those that were found when the last one began.
  void meet(BodyCollision& collision, double dt, const std::vector<PinnedNode>& pins = {},
            const std::vector<BodyTouch>* pushed = nullptr);
  /// After meet, with the ways as it has left them: where two that touch, or may, would push one another.
  std::vector<BodyTouch> touches(const BodyCollision& collision) const;
  /// A ball or a body whose place or velocity is beyond this, m or m/s, or not a number, is put back to its
  /// last good place, at rest and without its path. Single precision, which frames have, still holds it.
  static constexpr double kFarthest = 1e30;
  /// The balls and bodies put back since the last call.
  std::vector<ColliderId> take_stopped() { return std::exchange(stopped_, {}); }

  /// What lasts from step to step (world/state.h); of the same obstacles.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(balls_, targets_, hands_, impulses_, stopped_, next_id_);
    for (Obstacle& obstacle : obstacles_) archive(obstacle);
    if (Archive::is_loading::value) gather_solids();
  }

 private:
  /// Where a ball was told to go. Kept for one step after it got there, to bring it to rest.
  struct Target {
    BallId ball;
    Vec3 position;
    bool reached;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(ball, position, reached);
    }
  };
  void gather_solids();
  void forget_target(BallId id);
  /// Decides what sleeps through the step of dt, s, in which all that no force moves goes as it does now.
  void let_sleep(double dt, const Vec3& gravity, const std::vector<Sleeper>& cloths);
  /// meet(), once. Returns how far a body's points may be off, m: the second order of the turn it was given.
  double bend_ways(const std::vector<BodyContact>& contacts, double dt, const std::vector<PinnedNode>& pins,
                   std::vector<BodyImpulse>& impulses);
  /// What is next to the solid wakes.
  void wake_near(const Solid& solid);
  void stop_bad_balls();
  void stop_bad_body(Obstacle& obstacle);

  std::vector<Ball> balls_;
  std::vector<Obstacle> obstacles_;
  std::vector<Solid> solids_;
  std::vector<Target> targets_;
  std::vector<BodyHand> hands_;
  KeptImpulses impulses_;  ///< those found when the last step began
  std::vector<ColliderId> stopped_;
  BallId next_id_ = 1;
  double sleep_speed_ = 0;
};

}  // namespace weft
