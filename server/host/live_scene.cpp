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

std::vector<int> LiveScene::sent_levels(const Seat& seat) const {
  std::vector<int> levels = seat.levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const int coarsest = std::min(levels[i], scene_.simulation.cloths[i].min_level);
    levels[i] = std::max(coarsest, levels[i] - seat.link.coarser());
  }
  return levels;
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

// --- What viewers are sent ---

bool LiveScene::frame_wanted() const {
  return frame_due_ ||
         std::any_of(seats_.begin(), seats_.end(), [](const Seat& seat) { return seat.wants_frame; });
}

bool LiveScene::has_news() const { return frame_wanted() || !events_.empty(); }

void LiveScene::tell_events() {
  events_.flush([this](std::string text, std::string_view key) { tell_all(std::move(text), key); });
}

void LiveScene::publish(std::uint32_t server_ms) {
  if (!frame_wanted()) return;
  if (state_newer_) {
    protocol::FrameStamp stamp;
    stamp.frame = static_cast<std::uint32_t>(simulation_.step_count());
    stamp.epoch = epoch_;
    stamp.time = simulation_.time();
    stamp.server_ms = server_ms;
    stamp.flags = flags();
    encoder_.capture(simulation_, stamp);
  }
  state_newer_ = false;
  encoder_.set_flags(flags());
  for (Seat& seat : seats_) {
    if (frame_due_ || seat.wants_frame)
      seat.viewer->publish(seat.visit, encoder_.message(sent_levels(seat), seat.cone));
    seat.wants_frame = false;
  }
  frame_due_ = false;
}

void LiveScene::send_stats(double rate) {
  StatsState state;
  state.rate = rate;
  state.slow = slow_;
  state.viewers = seats_.size();
  for (std::size_t i = 0; i < simulation_.cloths().size(); ++i) {
    state.substeps.push_back(simulation_.report(i).substeps);
    state.levels.push_back(encoder_.simulated_level(i));
    state.unseen.push_back(unseen(i));
  }
  state.quality = quality_.stats_json();
  state.guard = guard_.stats_json();
  for (Seat& seat : seats_) {
    int most = 0;  // levels that it may lose
    for (std::size_t i = 0; i < seat.levels.size() && seat.viewer->takes_coarser(); ++i)
      most = std::max(most, seat.levels[i] - scene_.simulation.cloths[i].min_level);
    seat.link.passed(seat.viewer->flow(), most);
    seat.viewer->send(seat.visit, make_text(stats_text(simulation_, state, seat, sent_levels(seat))),
                      "stats");
  }
}

std::vector<int> LiveScene::viewers_by_level() const {
  std::vector<int> viewers(kMaxLevel + 1, 0);
  for (const Seat& seat : seats_)
    ++viewers[static_cast<std::size_t>(*std::max_element(seat.levels.begin(), seat.levels.end()))];
  return viewers;
}

void LiveScene::set_paused(bool paused) {
  if (paused_ == paused) return;
  paused_ = paused;
  frame_due_ = true;  // its flag tells
  events_.add(paused ? "pause" : "resume", "", simulation_.step_count(), [paused] {
    return json{{"paused", paused}};
  });
}

void LiveScene::state_changed() {
  state_newer_ = true;
  frame_due_ = true;
}

void LiveScene::balls_changed(const char* kind, std::uint64_t frame, BallId id) {
  if (!wants_step()) state_changed();
  events_.add(kind, "", frame, [this, id] {
    return json{{"ball", id}, {"balls", balls_json(simulation_.colliders())}};
  });
}

void LiveScene::pins_changed(const char* kind, std::size_t cloth) {
  events_.add(kind, std::to_string(cloth), takes_effect_, [this, cloth] {
    return json{{"cloth", cloth}, {"pins", pins_json(simulation_.cloths()[cloth].description())}};
  });
}

void LiveScene::tell_all(std::string text, std::string_view key) {
  const Text message = make_text(std::move(text));
  for (const Seat& seat : seats_) seat.viewer->send(seat.visit, message, key);
}

void LiveScene::tell_curve() {
  if (!quality_.has_outcome()) return;
  for (Seat& seat : seats_) {
    if (std::exchange(seat.wants_curve, false))
      seat.viewer->send(seat.visit, make_text(quality_.curve_text()));
  }
}

std::uint16_t LiveScene::flags() const {
  const int bits = (paused_ ? protocol::kFlagPaused : 0) | (slow_ ? protocol::kFlagSlow : 0);
  return static_cast<std::uint16_t>(bits);
}

}  // namespace weft::host
