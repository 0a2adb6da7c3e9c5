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
  state.effects = effects_;
  state.effects_off = effects_off_;
  state.materials = materials_;
  state.recompose = recompose_;
  state.wish = quality_.wished();
  state.put = put_;
  state.usual_work = usual_work_;
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
  effects_ = std::move(then.effects);
  effects_off_ = std::move(then.effects_off);
  put_ = std::move(then.put);
  for (PutBody& body : put_) body.viewer = 0;  // nobody who is here
  usual_work_ = std::move(then.usual_work);
  for (HeldSeat& seat : then.held) lost_.push_back({std::move(seat), until});
  if (then.materials.size() == materials_.size()) materials_ = std::move(then.materials);
  recompose_ = then.recompose;
  release_unheld();
  quality_.go_on_with(then.wish);
  study_outdated();
  find_bounds();
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
