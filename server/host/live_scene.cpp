#include "host/live_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/sheet/diagnostics.h"
#include "host/random_name.h"
#include "host/scene_messages.h"
#include "host/tuning.h"

namespace weft::host {
namespace {

using nlohmann::json;

/// Frames a second that are sent at most; scenes with shorter steps show every nth.
constexpr double kFrameRate = 60.0;
/// Of a seat: 128 bits.
constexpr std::size_t kTokenDigits = 32;

}  // namespace

LiveScene::LiveScene(scene::Scene scene, const protocol::Limits& limits,
                     const std::optional<Playing>& playing)
    : scene_(std::move(scene)),
      limits_(limits),
      recorded_(scene_.simulation, playing),
      quality_(playing ? scene::Quality{} : scene_.quality, scene_.simulation.integrator),
      effects_(scene_.simulation.effects) {
  for (const Cloth<float>& cloth : simulation_.cloths()) {
    finest_sendable_.push_back(finest_sendable_level(cloth.description().base_cells, limits_.frame_bytes));
    materials_.push_back(cloth.description().material);
  }
  frame_stride_ =
      std::max(1, static_cast<int>(std::lround(1.0 / (kFrameRate * scene_.simulation.time_step))));
  unseen_steps_ = std::max(1, static_cast<int>(std::lround(kUnseenTime / scene_.simulation.time_step)));
  if (plays()) {
    take_over_played();
    told_ = told();
  }
  find_bounds();
  find_range();
  encoder_.capture(simulation_, {});
}

// --- Viewers ---

void LiveScene::add_viewer(std::shared_ptr<Viewer> viewer, std::uint64_t visit) {
  tell_events();  // to those who are there: what this viewer is sent has these changes
  Seat seat;
  seat.viewer = std::move(viewer);
  seat.visit = visit;
  seat.number = ++seats_made_;
  seat.token = random_name(kTokenDigits);
  seat.distance = scene_.camera_distance;
  look(seat);
  seat.viewer->send(
      visit, make_text(scene_text(scene_, simulation_, {epoch_, paused_, effects_off_, effects_, materials_},
                                  seat)));
  for (const GuardLog::Notice& notice : guard_.standing())
    seat.viewer->send(visit, make_text(protocol::notice_text(notice.code, notice.message)));
  seats_.push_back(std::move(seat));
  request_levels();
}

void LiveScene::remove_viewer(const Viewer* viewer, std::uint64_t visit) {
  std::erase_if(seats_, [&](const Seat& seat) {
    if (seat.viewer.get() != viewer || seat.visit != visit) return false;
    for (const GrabId grab : seat.grabs) recorded_.run(command::Release{grab});  // its hands are gone
    return true;
  });
}

void LiveScene::lose_viewer(const Viewer* viewer, std::uint64_t visit, TimePoint until) {
  for (Seat& seat : seats_) {
    if (seat.viewer.get() == viewer && seat.visit == visit && !seat.grabs.empty())
      lost_.push_back({{seat.token, std::exchange(seat.grabs, {})}, until});
  }
  remove_viewer(viewer, visit);
}

void LiveScene::release_lost(TimePoint now) {
  std::erase_if(lost_, [&](const LostSeat& seat) {
    if (now < seat.until) return false;
    for (const GrabId grab : seat.grabs) recorded_.run(command::Release{grab});
    return true;
  });
}

void LiveScene::look(Seat& seat, int steps) {
  const LevelPolicy& policy = scene_.simulation.level_policy;
  const std::size_t cloths = simulation_.cloths().size();
  const bool first = seat.policy_levels.empty();
  seat.distances.resize(cloths);
  seat.policy_levels.resize(cloths);
  seat.levels.resize(cloths);
  seat.steps_unseen.resize(cloths, 0);
  for (std::size_t i = 0; i < cloths; ++i) {
    const double distance = seat.eye ? (*seat.eye - bounds_[i].centre).norm() : seat.distance;
    const int level = first ? policy.level_at(distance) : policy.level_at(distance, seat.policy_levels[i]);
    const ClothDescription& cloth = scene_.simulation.cloths[i];
    seat.distances[i] = distance;
    seat.policy_levels[i] = level;
    seat.levels[i] = std::min(std::clamp(level, cloth.min_level, cloth.max_level), finest_sendable_[i]);
    seat.steps_unseen[i] = sees(seat, i) ? 0 : std::min(seat.steps_unseen[i] + steps, unseen_steps_ + 1);
    if (lost(seat, i)) seat.levels[i] = std::min(cloth.min_level, seat.levels[i]);
  }
}

bool LiveScene::sees(const Seat& seat, std::size_t cloth) const {
  const Relevance& relevance = scene_.simulation.cloths[cloth].relevance;
  if (relevance.unseen == Relevance::Unseen::step) return true;
  const BoundingSphere& bounds = bounds_[cloth];
  return seat.distances[cloth] - bounds.radius <= relevance.far && (!seat.cone || seat.cone->touches(bounds));
}

bool LiveScene::unseen(std::size_t cloth) const {
  const bool all = nobody_placed();
  return std::all_of(seats_.begin(), seats_.end(),
                     [&](const Seat& seat) { return !(all || seat.placed) || lost(seat, cloth); });
}

bool LiveScene::nobody_placed() const {
  return std::none_of(seats_.begin(), seats_.end(), [](const Seat& seat) { return seat.placed; });
}

void LiveScene::request_levels() {
  if (seats_.empty() || plays()) return;
  std::vector<int> wanted(simulation_.cloths().size(), 0);
  const bool all = nobody_placed();
  for (const Seat& seat : seats_) {
    if (!all && !seat.placed) continue;
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = std::max(wanted[i], seat.levels[i]);
  }
  quality_.want_level(*std::max_element(wanted.begin(), wanted.end()));
  use_chosen_integrator();
  const int cap = quality_.level_cap().value_or(kMaxLevel);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Cloth<float>& cloth = simulation_.cloths()[i];
    // One that rests keeps its level, and so all it has.
    const bool rests = cloth.description().relevance.unseen == Relevance::Unseen::sleep && unseen(i);
    if (cloth.resting() != rests) recorded_.run(command::SetResting{i, rests});
    if (rests) continue;
    const int finest = std::min(wanted[i], cap);
    if (cloth.wanted_level() != cloth.within_levels(finest)) recorded_.run(command::RequestLevel{i, finest});
    // A scene that stands still gets finer at once, so that looking closer shows something. It does not get
    // coarser: what a merge drops would be missing when the viewer comes back.
    if (!wants_step() && finest > cloth.level() && recorded_.run(command::ApplyLevel{i})) state_changed();
  }
}

void LiveScene::use_chosen_integrator() {
  if (const auto integrator = quality_.take_change()) recorded_.run(command::SetIntegrator{*integrator});
}

SimulationDescription LiveScene::studied() const {
  SimulationDescription description = scene_.simulation;
  description.effects = effects_;
  std::erase_if(description.effects,
                [&](const EffectDescription& effect) { return is_off(name_of(effect)); });
  for (std::size_t i = 0; i < materials_.size(); ++i) description.cloths[i].material = materials_[i];
  const Colliders& colliders = simulation_.colliders();
  for (std::size_t i = 0; i < description.balls.size(); ++i) {
    const Ball* ball = colliders.find(static_cast<BallId>(i + 1));  // as long as nobody took it away
    if (ball != nullptr) description.balls[i].friction = ball->friction;
  }
  for (std::size_t i = 0; i < description.obstacles.size(); ++i)
    description.obstacles[i].friction = colliders.obstacles()[i].solid.friction;
  return description;
}

json LiveScene::composition() const {
  json all{{"off", effects_off_},
           {"parameters", parameters_json(effects_)},
           {"materials", materials_json(materials_, effects_)}};
  const SimulationDescription now = studied();
  for (const BallDescription& ball : now.balls) all["balls"].push_back(ball.friction);
  for (const ObstacleDescription& obstacle : now.obstacles) all["obstacles"].push_back(obstacle.friction);
  return all;
}

bool LiveScene::is_off(std::string_view effect) const {
  return std::find(effects_off_.begin(), effects_off_.end(), effect) != effects_off_.end();
}

void LiveScene::composition_changed(Recompose what) {
  recompose_ = std::max(recompose_, what);
  study_outdated();
}

void LiveScene::study_outdated() {
  ++study_number_;
  quality_.outdated();
  const auto waits = [](const Seat& seat) { return seat.wants_curve; };
  if (std::any_of(seats_.begin(), seats_.end(), waits)) quality_.ask();
  use_chosen_integrator();
}

void LiveScene::take_study(StudyOutcome outcome) {
  quality_.studied(std::move(outcome));
  request_levels();
  tell_curve();
}

// --- Steps ---

bool LiveScene::wants_step() const { return !seats_.empty() && (!paused_ || waiting_steps_ > 0); }

void LiveScene::step() {
  for (Seat& seat : seats_) look(seat, 1);
  if (plays()) {
    play_step();
  } else {
    simulate_step();
  }
  find_bounds();
  const bool asked_for = waiting_steps_ > 0 && --waiting_steps_ == 0;
  state_newer_ = true;
  if (asked_for || simulation_.step_count() % static_cast<std::uint64_t>(frame_stride_) == 0)
    frame_due_ = true;
}

void LiveScene::simulate_step() {
  request_levels();
  recompose(std::exchange(recompose_, Recompose::nothing));
  limit_work();
  recorded_.step();
  tell_guard_events();
  take_away_costly();
  const auto& cloths = simulation_.cloths();
  const bool as_asked = std::all_of(cloths.begin(), cloths.end(),
                                    [](const Cloth<float>& cloth) { return cloth.steps_as_asked(); });
  if (as_asked) quality_.stepped(simulation_.profile().total * 1e3);  // no other step tells what it takes
  remove_lost_balls();
}

void LiveScene::recompose(Recompose what) {
  if (what == Recompose::nothing) return;
  if (what == Recompose::effects) recorded_.run(command::SetEffects{studied().effects});
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    if (simulation_.cloths()[i].description().material != materials_[i])
      recorded_.run(command::SetMaterial{i, materials_[i]});
  }
}

void LiveScene::set_slow(bool slow) {
  if (slow_ == slow) return;
  slow_ = slow;
  tell_all(slow ? protocol::notice_text("slow",
                                        "steps take longer than their time: the clock runs behind real time")
                : protocol::notice_text("real_time", "the clock runs in real time again"));
}

void LiveScene::tell_guard_events() {
  for (GuardLog::Notice& notice : guard_.stepped(simulation_)) {
    tell_all(protocol::notice_text(notice.code, notice.message));
    warnings_.push_back(std::move(notice.message));
  }
}

bool LiveScene::remove_ball(BallId id) {
  const json before = composition();
  const bool found = recorded_.run(command::RemoveBall{id});
  if (composition() != before) study_outdated();
  return found;
}

void LiveScene::find_range() {
  range_.extend(Vec3::Zero());
  for (const BoundingSphere& cloth : bounds_) range_.extend(cloth.centre);
  for (const Ball& ball : simulation_.colliders().balls()) range_.extend(ball.position);
  for (const Obstacle& obstacle : simulation_.colliders().obstacles()) range_.extend(obstacle.pose.position);
  range_ = {range_.min() - Vec3::Constant(kBallRange), range_.max() + Vec3::Constant(kBallRange)};
}

void LiveScene::remove_lost_balls() {
  std::vector<BallId> lost;
  for (const Ball& ball : simulation_.colliders().balls()) {
    const bool dynamic = ball.motion == BallDescription::Motion::dynamic;
    if (dynamic && !range_.contains(ball.position)) lost.push_back(ball.id);
  }
  for (const BallId id : lost) {
    remove_ball(id);
    balls_changed("ball.remove", simulation_.step_count(), id);
  }
  const auto& obstacles = simulation_.colliders().obstacles();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Pose& pose = obstacles[i].pose;
    const bool flies = obstacles[i].flies();
    if (flies && !range_.contains(pose.position)) recorded_.run(command::MoveObstacle{i, pose});
  }
}

void LiveScene::find_bounds() {
  bounds_.clear();
  for (const Cloth<float>& cloth : simulation_.cloths()) {
    const bool in_full = cloth.description().relevance.unseen != Relevance::Unseen::step;
    bounds_.push_back(in_full ? bounding_sphere(cloth.particles())
                              : BoundingSphere{centre(cloth.particles()), 0});
  }
}

}  // namespace weft::host
