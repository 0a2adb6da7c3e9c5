#include "host/live_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
      sight_(scene_.simulation, limits_.frame_bytes),
      composition_(scene_.simulation) {
  frame_stride_ =
      std::max(1, static_cast<int>(std::lround(1.0 / (kFrameRate * scene_.simulation.time_step))));
  if (plays()) {
    composition_.follow(simulation_);
    told_ = told();
  }
  sight_.find_bounds(simulation_.cloths());
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
  sight_.look(seat);
  seat.viewer->send(visit, make_text(scene_text(scene_, simulation_,
                                                {epoch_, paused_, composition_.effects_off(),
                                                 composition_.effects(), composition_.materials()},
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

void LiveScene::request_levels() {
  if (seats_.empty() || plays()) return;
  const std::vector<int> wanted = sight_.wanted_levels(seats_);
  quality_.want_level(*std::max_element(wanted.begin(), wanted.end()));
  use_chosen_integrator();
  const int cap = quality_.level_cap().value_or(kMaxLevel);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Cloth<float>& cloth = simulation_.cloths()[i];
    // One that rests keeps its level, and so all it has.
    const bool rests =
        cloth.description().relevance.unseen == Relevance::Unseen::sleep && sight_.unseen(seats_, i);
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
  composition_.put_into(description);
  const Colliders& colliders = simulation_.colliders();
  for (std::size_t i = 0; i < description.balls.size(); ++i) {
    const Ball* ball = colliders.find(static_cast<BallId>(i + 1));  // as long as nobody took it away
    if (ball != nullptr) description.balls[i].friction = ball->friction;
  }
  for (std::size_t i = 0; i < description.obstacles.size(); ++i)
    description.obstacles[i].friction = colliders.obstacles()[i].solid.friction;
  return description;
}

json LiveScene::studied_json() const {
  json all{{"off", composition_.effects_off()},
           {"parameters", parameters_json(composition_.effects())},
           {"materials", materials_json(composition_.materials(), composition_.effects())}};
  const SimulationDescription now = studied();
  for (const BallDescription& ball : now.balls) all["balls"].push_back(ball.friction);
  for (const ObstacleDescription& obstacle : now.obstacles) all["obstacles"].push_back(obstacle.friction);
  return all;
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
  for (Seat& seat : seats_) sight_.look(seat, 1);
  if (plays()) {
    play_step();
  } else {
    simulate_step();
  }
  sight_.find_bounds(simulation_.cloths());
  const bool asked_for = waiting_steps_ > 0 && --waiting_steps_ == 0;
  state_newer_ = true;
  if (asked_for || simulation_.step_count() % static_cast<std::uint64_t>(frame_stride_) == 0)
    frame_due_ = true;
}

void LiveScene::simulate_step() {
  request_levels();
  recompose(composition_.take_due());
  put_bodies_.limit_work(recorded_);
  recorded_.step();
  tell_guard_events();
  for (const PutBody& body : put_bodies_.take_costly(recorded_)) take_away(body);
  const auto& cloths = simulation_.cloths();
  const bool as_asked = std::all_of(cloths.begin(), cloths.end(),
                                    [](const Cloth<float>& cloth) { return cloth.steps_as_asked(); });
  if (as_asked) quality_.stepped(simulation_.profile().total * 1e3);  // no other step tells what it takes
  remove_lost_balls();
}

void LiveScene::recompose(Recompose what) {
  if (what == Recompose::nothing) return;
  if (what == Recompose::effects) recorded_.run(command::SetEffects{studied().effects});
  const std::vector<Material>& materials = composition_.materials();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (simulation_.cloths()[i].description().material != materials[i])
      recorded_.run(command::SetMaterial{i, materials[i]});
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
  const json before = studied_json();
  const bool found = recorded_.run(command::RemoveBall{id});
  if (studied_json() != before) study_outdated();
  return found;
}

void LiveScene::find_range() {
  range_.extend(Vec3::Zero());
  for (const BoundingSphere& cloth : sight_.bounds()) range_.extend(cloth.centre);
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
    seat.puts_again_at = simulation_.step_count() + PutBodies::pause(scene_.simulation.time_step);
  }
}

}  // namespace weft::host
