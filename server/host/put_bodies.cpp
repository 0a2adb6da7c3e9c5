/// What viewers' balls and obstacles may cost: a step of a cloth among them may take only so much work,
/// counted so that it is the same on any machine. What makes it take more is taken away again.
#include <algorithm>
#include <cmath>

#include "cloth/sheet/diagnostics.h"
#include "host/live_scene.h"
#include "host/refusal.h"
#include "protocol/member.h"

namespace weft::host {
namespace {

using protocol::Error;

/// Times the work of the cloth's last step before viewers put anything, and at least so much (a quarter of a
/// second or so): a ball dragged through a flag at level 6 takes a third of it, one that swallows the flag's
/// pole passes it in its first step.
constexpr double kMostTimes = 8, kLeastWork = 1.2e7;
/// Of the bodies at a cloth those put within so many steps before the newest answer for it.
constexpr std::uint64_t kTogether = 60;
/// For so long, s of the scene, who put them may put nothing.
constexpr double kPause = 10;

/// How the work of a step grows with the level: four times the nodes, in twice the substeps.
double scale_of(int level) { return std::exp2(3 * level); }

bool meets(const Solid& solid, const BoundingSphere& cloth) {
  if (std::holds_alternative<HalfSpace>(solid.shape)) return true;
  return (solid.position - cloth.centre).norm() <= outer_radius(solid.shape) + cloth.radius;
}

}  // namespace

std::optional<Error> LiveScene::too_large(double radius) const {
  double most = 0;
  for (const ClothDescription& cloth : scene_.simulation.cloths) most = std::max(most, cloth.size.norm());
  most = std::ceil(100 * most) / 100;
  if (radius <= most) return {};
  const auto fault = protocol::refuse(
      "range", "/radius", radius, protocol::range_text({0.01, most, "m, in this scene: its cloth's size"}));
  return refused("range", "/radius", fault.message);
}

std::optional<Error> LiveScene::may_not_put(const Seat& seat) const {
  if (simulation_.step_count() >= seat.puts_again_at) return {};
  return refused(
      "limit", "",
      "what this viewer put made a step take too much work; it may put something again from step " +
          std::to_string(seat.puts_again_at) + " on");
}

void LiveScene::has_put(ColliderId body, const Seat& seat) {
  const auto known = std::find_if(put_.begin(), put_.end(), [&](const PutBody& b) { return b.id == body; });
  PutBody& put = known == put_.end() ? put_.emplace_back() : *known;
  if (put.id == 0 && body >= kFirstObstacle)
    put.before = simulation_.colliders().obstacles()[body - kFirstObstacle].pose;
  put.id = body;
  put.viewer = seat.number;
  put.step = simulation_.step_count();
}

void LiveScene::limit_work() {
  std::erase_if(put_, [&](const PutBody& body) {
    return body.id < kFirstObstacle && simulation_.colliders().find(body.id) == nullptr;
  });
  usual_work_.resize(simulation_.cloths().size(), 0);
  for (std::size_t i = 0; i < usual_work_.size(); ++i) {
    const Cloth<float>& cloth = simulation_.cloths()[i];
    const double usual = usual_work_[i] * scale_of(cloth.level());
    const double most = put_.empty() ? WorkLimit::kNone : std::max(kLeastWork, kMostTimes * usual);
    if (cloth.most_work() != most) recorded_.run(command::SetMostWork{i, most});
  }
}

void LiveScene::take_away_costly() {
  std::vector<PutBody> guilty;
  for (std::size_t i = 0; i < usual_work_.size(); ++i) {
    const Cloth<float>& cloth = simulation_.cloths()[i];
    if (put_.empty() && cloth.work() > 0) usual_work_[i] = cloth.work() / scale_of(cloth.level());
    if (!cloth.cost_too_much()) continue;
    recorded_.run(command::TryAgain{i});
    const BoundingSphere bounds = bounding_sphere(cloth.particles());
    const std::size_t before = guilty.size();
    for (const Solid& solid : simulation_.colliders().solids()) {
      const auto put =
          std::find_if(put_.begin(), put_.end(), [&](const PutBody& body) { return body.id == solid.id; });
      if (put == put_.end() || !meets(solid, bounds)) continue;
      guilty.push_back(*put);
      put_.erase(put);
    }
    // It takes so much without them, by another command.
    if (guilty.size() == before) usual_work_[i] = cloth.work() / scale_of(cloth.level());
  }
  std::uint64_t newest = 0;
  for (const PutBody& body : guilty) newest = std::max(newest, body.step);
  for (const PutBody& body : guilty) {
    if (body.step + kTogether < newest) {
      put_.push_back(body);
    } else {
      take_away(body);
    }
  }
}

void LiveScene::take_away(const PutBody& body) {
  std::string what;
  if (body.id < kFirstObstacle) {
    what = "ball " + std::to_string(body.id) + " was taken away";
    remove_ball(body.id);
    balls_changed("ball.remove", simulation_.step_count(), body.id);
  } else {
    const std::size_t obstacle = body.id - kFirstObstacle;
    what = "obstacle " + std::to_string(obstacle) + " was put back to where it was";
    recorded_.run(command::MoveObstacle{obstacle, body.before});
  }
  tell_all(protocol::notice_text("too_costly", what + ": a step with it takes more work than it may"));
  for (Seat& seat : seats_) {
    if (seat.number != body.viewer) continue;
    seat.puts_again_at = simulation_.step_count() +
                         static_cast<std::uint64_t>(std::ceil(kPause / scene_.simulation.time_step));
  }
}

}  // namespace weft::host
