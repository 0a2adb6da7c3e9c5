/// What LiveScene sends its viewers: frames, events and stats.
#include <algorithm>
#include <utility>

#include "host/live_scene.h"
#include "host/scene_messages.h"

namespace weft::host {

using nlohmann::json;

std::vector<int> LiveScene::sent_levels(const Seat& seat) const {
  std::vector<int> levels = seat.levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const int coarsest = std::min(levels[i], scene_.simulation.cloths[i].min_level);
    levels[i] = std::max(coarsest, levels[i] - seat.link.coarser());
  }
  return levels;
}

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
      seat.viewer->publish(seat.visit,
                           encoder_.message(sent_levels(seat), seat.cone, seat.viewer->grid_coding()));
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
    state.unseen.push_back(sight_.unseen(seats_, i));
  }
  state.quality = quality_.stats_json();
  state.guard = guard_.stats_json();
  for (Seat& seat : seats_) {
    int most = 0;  // levels that it may lose
    for (std::size_t i = 0; i < seat.levels.size() && seat.viewer->takes_coarser(); ++i)
      most = std::max(most, seat.levels[i] - scene_.simulation.cloths[i].min_level);
    const int coarser = seat.link.coarser();
    seat.link.passed(seat.viewer->flow(), most);
    if (seat.link.coarser() != coarser) seat.wants_frame = true;  // no other may come soon
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

SceneMetrics::Limited LiveScene::limited_viewers() const {
  SceneMetrics::Limited limited;
  for (const Seat& seat : seats_) {
    limited.by_link += seat.link.limit() == LinkKeeper::Limit::link;
    limited.by_client += seat.link.limit() == LinkKeeper::Limit::client;
  }
  return limited;
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
