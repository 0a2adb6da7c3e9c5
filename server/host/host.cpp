#include "host/host.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "cloth/world/simulation.h"
#include "host/random_name.h"

namespace weft::host {
namespace {

using Why = NotMade::Why;
constexpr std::size_t kInstanceDigits = 16;

/// As a file's name without its extension, and a part of an URL.
bool is_scene_name(std::string_view name) {
  return !name.empty() && name.size() <= scene::kLongestSceneName &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string_view::npos;
}

/// At the finest levels.
long count_nodes(const SimulationDescription& simulation) {
  long nodes = 0;
  for (const ClothDescription& cloth : simulation.cloths) {
    const Grid grid = cloth.base_cells.at(cloth.max_level);
    nodes += long{grid.rows} * grid.cols;
  }
  return nodes;
}

/// Whether its first step at the finest levels does no more work than that.
bool first_step_within(const SimulationDescription& description, double most) {
  Simulation<float> simulation(description);
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    simulation.request_level(i, description.cloths[i].max_level);
    simulation.cloths()[i].set_most_work(most);
  }
  simulation.step();
  double work = 0;
  for (const Cloth<float>& cloth : simulation.cloths()) work += cloth.work();
  return work <= most;
}

}  // namespace

Host::Host(const protocol::Limits& limits, const std::string& version, const MakingLimits& making,
           const LogFolders& folders)
    : limits_(limits),
      making_(making),
      instance_(random_name(kInstanceDigits)),
      folders_(folders),
      metrics_(version) {}

Host::~Host() {
  // All of them first: each then ends while others are waited for.
  for (const Served& scene : scenes_) scene.runner->request_stop();
}

bool Host::taken(std::string_view name) const {
  const auto ending = ending_.find(name);
  return std::any_of(scenes_.begin(), scenes_.end(),
                     [&](const Served& scene) { return scene.runner->name() == name; }) ||
         (ending != ending_.end() && !ending->second.expired());
}

void Host::add(scene::Scene scene) {
  const std::lock_guard lock(mutex_);
  if (taken(scene.name)) throw std::invalid_argument("there are two scenes named " + scene.name);
  start(std::move(scene), std::nullopt);
}

void Host::play(const Playing& playing) {
  scene::Scene scene = playing.recording->scene();
  const std::lock_guard lock(mutex_);
  if (taken(scene.name)) throw std::invalid_argument("there are two scenes named " + scene.name);
  scenes_.push_back({std::make_shared<SceneRunner>(std::move(scene), limits_, metrics_, LogPlaces{}, playing),
                     std::nullopt});
}

void Host::start(scene::Scene scene, std::optional<long> nodes) {
  LogPlaces places;
  places.made = nodes.has_value();
  if (!folders_.record.empty()) places.record = folders_.record / (scene.name + ".weftrec");
  if (!folders_.data.empty()) places.data = folders_.data / scene.name;
  scenes_.push_back({std::make_shared<SceneRunner>(std::move(scene), limits_, metrics_, places), nodes});
}

void Host::restore_made() {
  const std::lock_guard lock(mutex_);
  remove_gone(folders_.data);
  for (const KeptScene& kept : made_scenes_in(folders_.data)) {
    scene::Result read = scene::parse(kept.document, kept.name);
    auto* scene = std::get_if<scene::Scene>(&read);
    if (scene == nullptr || taken(kept.name)) continue;
    const long nodes = count_nodes(scene->simulation);
    start(std::move(*scene), nodes);
  }
}

std::optional<NotMade> Host::refusal(const std::string& name, long nodes) const {
  if (taken(name)) return NotMade{Why::exists, "there is a scene named " + name + " already", {}};
  if (!folders_.data.empty() && std::filesystem::exists(folders_.data / name))
    return NotMade{Why::exists, "there are data of a scene named " + name + " that is not served now", {}};
  std::size_t made = 0;
  long used = 0;
  for (const Served& scene : scenes_) {
    made += scene.nodes.has_value();
    used += scene.nodes.value_or(0);
  }
  if (made >= making_.scenes)
    return NotMade{Why::full,
                   "clients have made " + std::to_string(made) + " scenes, the most allowed: end one first",
                   {}};
  if (used + nodes > making_.nodes)
    return NotMade{Why::too_large,
                   "the scene has " + std::to_string(nodes) + " nodes at its finest levels, beside " +
                       std::to_string(used) +
                       " of others made by clients; allowed: " + std::to_string(making_.nodes) + " in all",
                   {}};
  return std::nullopt;
}

std::optional<NotMade> Host::make(const std::string& name, std::string_view document) {
  if (!is_scene_name(name))
    return NotMade{
        Why::bad_name,
        "a scene's name must be 1.." + std::to_string(scene::kLongestSceneName) + " of a-z, 0-9 and -",
        {}};
  scene::Result read = scene::parse(document, name);
  if (auto* problems = std::get_if<std::vector<scene::Problem>>(&read))
    return NotMade{Why::problems, "the document has problems", std::move(*problems)};
  scene::Scene scene = std::get<scene::Scene>(std::move(read));
  const SimulationDescription& simulation = scene.simulation;
  const std::size_t colliders = simulation.balls.size() + simulation.obstacles.size();
  if (colliders > making_.colliders)
    return NotMade{Why::too_large,
                   "the scene has " + std::to_string(colliders) +
                       " balls and obstacles; allowed: " + std::to_string(making_.colliders),
                   {}};
  const long nodes = count_nodes(simulation);
  {
    const std::lock_guard lock(mutex_);
    if (auto no = refusal(name, nodes)) return no;
  }
  if (!first_step_within(simulation, making_.work))
    return NotMade{Why::too_costly, "a step of the scene takes more work than a client's may", {}};
  {
    const std::lock_guard lock(mutex_);
    if (auto no = refusal(name, nodes)) return no;  // another client was faster
    ending_.erase(name);
    start(std::move(scene), nodes);
  }
  if (!folders_.data.empty()) wait_until_kept(folders_.data / name);
  return std::nullopt;
}

Host::Ending Host::end(std::string_view name) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(scenes_.begin(), scenes_.end(),
                                  [&](const Served& scene) { return scene.runner->name() == name; });
  if (found == scenes_.end()) return Ending::unknown;
  if (!found->nodes) return Ending::own;
  found->runner->forget();
  found->runner->request_stop();
  std::erase_if(ending_, [](const auto& each) { return each.second.expired(); });
  ending_[found->runner->name()] = found->runner;
  if (!folders_.data.empty()) set_gone(folders_.data / found->runner->name());
  scenes_.erase(found);
  return Ending::ended;
}

std::shared_ptr<SceneRunner> Host::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(scenes_.begin(), scenes_.end(),
                                  [&](const Served& scene) { return scene.runner->name() == name; });
  return found == scenes_.end() ? nullptr : found->runner;
}

std::vector<std::shared_ptr<SceneRunner>> Host::scenes() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<SceneRunner>> all;
  for (const Served& scene : scenes_) all.push_back(scene.runner);
  return all;
}

nlohmann::json Host::list() const {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& scene : scenes()) {
    list.push_back({{"name", scene->name()},
                    {"title", scene->title()},
                    {"viewers", scene->viewers()},
                    {"cloths", scene->cloths()}});
  }
  return list;
}

}  // namespace weft::host
