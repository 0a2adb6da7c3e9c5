/// LiveScene's state beside its simulation, as it is written down and read.
#include <algorithm>

#include "cloth/world/description_archive.h"
#include "host/live_scene.h"

namespace weft::host {

std::string LiveScene::save_service() const {
  const ServiceState state{epoch_,       paused_,           waiting_steps_, effects_,
                           effects_off_, quality_.wished(), put_,           usual_work_};
  std::string bytes;
  StateWriter writer(bytes);
  writer(state);
  return bytes;
}

void LiveScene::go_on_from(std::string_view state, std::string_view service) {
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
  std::transform(simulation_.cloths().begin(), simulation_.cloths().end(), materials_.begin(),
                 [](const Cloth<float>& cloth) { return cloth.description().material; });
  quality_.go_on_with(then.wish);
  study_outdated();
  find_bounds();
  state_changed();
}

}  // namespace weft::host
