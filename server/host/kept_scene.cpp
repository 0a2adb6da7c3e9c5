/// LiveScene's state beside its simulation, as it is written down and read.
#include <algorithm>

#include "cloth/world/description_archive.h"
#include "host/live_scene.h"

namespace weft::host {

std::string LiveScene::save_service() const {
  ServiceState state;
  state.epoch = epoch_;
  state.paused = paused_;
  state.waiting_steps = waiting_steps_;
  state.wish = quality_.wished();
  composition_.save(state);
  put_bodies_.save(state);
  state.held.assign(lost_.begin(), lost_.end());
  for (const Seat& seat : seats_) {
    if (!seat.grabs.empty()) state.held.push_back({seat.token, seat.grabs});
  }
  std::string bytes;
  StateWriter writer(bytes);
  writer(state);
  return bytes;
}

void LiveScene::go_on_from(std::string_view state, std::string_view service, TimePoint until) {
  ServiceState then;
  StateReader reader(service);
  reader(then);
  recorded_.load(state);
  epoch_ = then.epoch + 1;
  paused_ = then.paused;
  waiting_steps_ = then.waiting_steps;
  composition_.load(then);
  put_bodies_.load(then);
  for (HeldSeat& seat : then.held) lost_.push_back({std::move(seat), until});
  release_unheld();
  quality_.go_on_with(then.wish);
  study_outdated();
  sight_.find_bounds(simulation_.cloths());
  state_changed();
}

void LiveScene::release_unheld() {
  std::vector<GrabId> all;
  for (const Cloth<float>& cloth : simulation_.cloths())
    for (const Grab& grab : cloth.grabs()) all.push_back(grab.id);
  for (const BodyHand& hand : simulation_.colliders().hands()) all.push_back(hand.id);
  for (const GrabId grab : all) {
    const bool held = std::any_of(lost_.begin(), lost_.end(), [&](const LostSeat& seat) {
      return std::find(seat.grabs.begin(), seat.grabs.end(), grab) != seat.grabs.end();
    });
    if (!held) recorded_.run(command::Release{grab});
  }
}

}  // namespace weft::host
