#include "study/effects.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "cloth/world/simulation.h"
#include "study/thread_time.h"
#include "study/trajectory.h"

namespace weft::study {
namespace {

/// Mean of the middle half: as steady as the median, finer than the clock's tick.
double middle_mean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
  const auto first = values.begin() + quarter, last = values.end() - quarter;
  return std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
}

double middle_difference(const std::vector<double>& more, std::vector<double> less) {
  std::transform(more.begin(), more.end(), less.begin(), less.begin(), std::minus<>());
  return middle_mean(std::move(less));
}

enum class Solids { scene, none };

/// Pins that go with an obstacle stay where they are.
SimulationDescription without_colliders(SimulationDescription description) {
  description.balls.clear();
  description.obstacles.clear();
  for (ClothDescription& cloth : description.cloths) {
    for (PinRegion& pin : cloth.pins) pin.obstacle.reset();
  }
  return description;
}

/// Calls visit(friction) for each of the scene's coefficients.
template <class Description, class Visit>
void for_each_friction(Description& description, Visit visit) {
  for (auto& ball : description.balls) visit(ball.friction);
  for (auto& obstacle : description.obstacles) visit(obstacle.friction);
  for (auto& effect : description.effects) {
    if (auto* contact = std::get_if<ClothContactEffect>(&effect)) visit(contact->friction);
  }
}

/// What a scene may have beside its effects and colliders.
struct Part {
  std::string_view name;
  bool (*is_in)(const SimulationDescription&);
  void (*remove)(SimulationDescription&);
};
constexpr Part kParts[] = {
    {"gusts", [](const SimulationDescription& d) { return d.wind.gusts.intensity > 0; },
     [](SimulationDescription& d) { d.wind.gusts = {}; }},
    {"turbulence", [](const SimulationDescription& d) { return d.wind.turbulence.intensity > 0; },
     [](SimulationDescription& d) { d.wind.turbulence = {}; }},
    {"wind zones", [](const SimulationDescription& d) { return !d.wind.zones.empty(); },
     [](SimulationDescription& d) { d.wind.zones.clear(); }},
    {"friction",
     [](const SimulationDescription& d) {
       bool any = false;
       for_each_friction(d, [&](double friction) { any = any || friction > 0; });
       return any;
     },
     [](SimulationDescription& d) { for_each_friction(d, [](double& friction) { friction = 0; }); }},
};

/// The scene with some of its effects, and what its frames took, ms.
struct Variant {
  Variant(const SimulationDescription& description, int level, Solids solids_of = Solids::scene)
      : solids(solids_of),
        simulation(
            at_level<float>(solids == Solids::none ? without_colliders(description) : description, level)) {}

  void begin_at(const Simulation<float>& other) {
    if (solids == Solids::none) {
      simulation.take_cloths(other);
    } else {
      simulation.take_state(other);
    }
    take_parts_away(other.wind());
  }
  /// What is taken over of parts that the variant has not.
  void take_parts_away(const Wind& there) {
    const SimulationDescription& own = simulation.description();
    if (own.wind.gusts.intensity != there.gusts.intensity ||
        own.wind.turbulence.intensity != there.turbulence.intensity ||
        own.wind.zones.size() != there.zones.size()) {
      simulation.set_wind(own.wind);
    }
    for (std::size_t i = 0; i < own.balls.size(); ++i) {
      simulation.set_ball_friction(simulation.colliders().balls()[i].id, own.balls[i].friction);
    }
    for (std::size_t i = 0; i < own.obstacles.size(); ++i) {
      simulation.set_obstacle_friction(i, own.obstacles[i].friction);
    }
  }
  void step() {
    const double begin = thread_time();
    simulation.step();
    frames.push_back(1e3 * (thread_time() - begin));
  }

  Solids solids;
  Simulation<float> simulation;
  std::vector<double> frames;
};

std::string row(std::string_view name, double milliseconds, double all) {
  char text[100];
  std::snprintf(text, sizeof text, "  %-24.*s %9.4f %7.1f %%\n", static_cast<int>(name.size()), name.data(),
                milliseconds, all > 0 ? 100 * milliseconds / all : 0);
  return text;
}

}  // namespace

EffectsStudy study_effects(const SimulationDescription& description, int level, int frames,
                           const std::function<void()>& watch) {
  const std::size_t effects = description.effects.size();
  std::vector<const Part*> parts;
  for (const Part& part : kParts) {
    if (part.is_in(description)) parts.push_back(&part);
  }
  // All, without the first effect, ..., without the last, without each part, no contact, none.
  std::vector<Variant> variants;
  variants.reserve(effects + parts.size() + 3);
  variants.emplace_back(description, level);
  for (std::size_t i = 0; i < effects; ++i) {
    SimulationDescription without = description;
    without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(i));
    variants.emplace_back(without, level);
  }
  for (const Part* part : parts) {
    SimulationDescription without = description;
    part->remove(without);
    variants.emplace_back(without, level);
  }
  variants.emplace_back(description, level, Solids::none);
  SimulationDescription bare = description;
  bare.effects.clear();
  variants.emplace_back(bare, level, Solids::none);
  const Variant &all = variants.front(), &no_contact = *std::prev(variants.end(), 2), &none = variants.back();

  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 1; i < variants.size(); ++i) variants[i].begin_at(all.simulation);
    for (std::size_t i = 0; i < variants.size(); ++i) {
      variants[(i + static_cast<std::size_t>(frame)) % variants.size()].step();
    }
    watch();
  }

  EffectsStudy study;
  study.level = level;
  study.all = middle_mean(all.frames);
  auto without = variants.begin() + 1;
  for (const EffectDescription& effect : description.effects) {
    study.effects.push_back({name_of(effect), middle_difference(all.frames, (without++)->frames)});
  }
  for (const Part* part : parts) {
    study.parts.push_back({part->name, middle_difference(all.frames, (without++)->frames)});
  }
  if (!description.balls.empty() || !description.obstacles.empty()) {
    study.contact = middle_difference(all.frames, no_contact.frames);
  }
  study.rest = middle_mean(none.frames);
  return study;
}

std::string table(const EffectsStudy& study) {
  std::string text = "level " + std::to_string(study.level) + "                     ms/frame     share\n";
  for (const EffectCost& effect : study.effects) text += row(effect.name, effect.milliseconds, study.all);
  for (const EffectCost& part : study.parts) text += row(part.name, part.milliseconds, study.all);
  text += row("contact", study.contact, study.all);
  text += row("springs, integrator", study.rest, study.all);
  return text + row("all", study.all, study.all);
}

}  // namespace weft::study
