#include "study/effects.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "cloth/simulation.h"
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
  std::vector<Variant> variants;  // all, without the first effect, ..., without the last, no contact, none
  variants.reserve(effects + 3);
  variants.emplace_back(description, level);
  for (std::size_t i = 0; i < effects; ++i) {
    SimulationDescription without = description;
    without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(i));
    variants.emplace_back(without, level);
  }
  variants.emplace_back(description, level, Solids::none);
  SimulationDescription bare = description;
  bare.effects.clear();
  variants.emplace_back(bare, level, Solids::none);
  const Variant &all = variants.front(), &no_contact = variants[effects + 1], &none = variants.back();

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
  for (std::size_t i = 0; i < effects; ++i) {
    const auto name =
        std::visit([](const auto& each) { return std::string_view(each.kName); }, description.effects[i]);
    study.effects.push_back({name, middle_difference(all.frames, variants[i + 1].frames)});
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
  text += row("contact", study.contact, study.all);
  text += row("springs, integrator", study.rest, study.all);
  return text + row("all", study.all, study.all);
}

}  // namespace weft::study
