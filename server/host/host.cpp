#include "host/host.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace weft::host {

Host::Host(const protocol::Limits& limits, const std::string& version) : limits_(limits), metrics_(version) {}

Host::~Host() {
  // All of them first: each then ends while others are waited for.
  for (const auto& scene : scenes_) scene->request_stop();
}

void Host::add(scene::Scene scene) {
  if (find(scene.name)) throw std::invalid_argument("there are two scenes named " + scene.name);
  scenes_.push_back(std::make_unique<SceneRunner>(std::move(scene), limits_, metrics_));
}

SceneRunner* Host::find(std::string_view name) const {
  const auto found =
      std::find_if(scenes_.begin(), scenes_.end(), [&](const auto& s) { return s->name() == name; });
  return found == scenes_.end() ? nullptr : found->get();
}

nlohmann::json Host::list() const {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& scene : scenes_) {
    list.push_back({{"name", scene->name()},
                    {"title", scene->title()},
                    {"viewers", scene->viewers()},
                    {"cloths", scene->cloths()}});
  }
  return list;
}

}  // namespace weft::host
