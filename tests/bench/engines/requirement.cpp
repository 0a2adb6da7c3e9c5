#include "engines/requirement.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "engines/frame_cost.h"
#include "engines/many_cloths.h"
#include "timing.h"

namespace weft::bench {
namespace {

std::string nodes_text(int level) {
  const std::string side = std::to_string((1 << level) + 1);
  return side + " x " + side;
}

/// Cost of `numerator`'s frame over `denominator`'s, times `scale`, at most `most`.
Requirement cost_ratio(const std::string& what, const Measurement* numerator, const Measurement* denominator,
                       double scale, double most) {
  Requirement requirement{what, "<= " + text(most), "", {}};
  if (numerator == nullptr || denominator == nullptr) return requirement;
  const double ratio = scale * numerator->median_ms / denominator->median_ms;
  requirement.measured = text(ratio) + " (" + text(scale * numerator->least_ms / denominator->least_ms) + ")";
  requirement.holds = ratio <= most;
  return requirement;
}

}  // namespace

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

std::string time_text(const Measurement& measurement) {
  return text(measurement.median_ms) + " (" + text(measurement.least_ms) + ") ms";
}

std::string ratio_text(const Measurement& slow, const Measurement& fast) {
  return text(slow.median_ms / fast.median_ms) + " (" + text(slow.least_ms / fast.least_ms) + ")";
}

std::vector<Requirement> own_requirements(const Rows& rows, double damping) {
  const auto at = [&](int level) { return rows.bdf2({'H', level, damping}); };
  std::vector<Requirement> all;
  Requirement strain{"bdf2, 65 x 65: max strain", "< 0.5 %", "", {}};
  if (const Measurement* m = at(6)) {
    strain.measured = text(100 * m->max_strain) + " %";
    strain.holds = m->sound() && m->max_strain < 0.005;
  }
  all.push_back(strain);
  for (const auto& [level, most] : {std::pair{6, 0.8}, std::pair{7, 4.0}}) {
    Requirement time{"bdf2, " + nodes_text(level) + ": a frame", "<= " + text(most) + " ms", "", {}};
    if (const Measurement* m = at(level)) {
      time.measured = time_text(*m);
      time.holds = m->sound() && m->median_ms <= most;
    }
    all.push_back(time);
  }
  const double fewer = std::pow(65.0 / 257.0, 2);
  all.push_back(cost_ratio("bdf2: time a node, 257 x 257 over 65 x 65", at(8), at(6), fewer, 1.3));
  for (const int level : {6, 5}) {
    all.push_back(cost_ratio("bdf2: a frame, " + nodes_text(level - 1) + " over " + nodes_text(level),
                             at(level - 1), at(level), 1, 0.3));
  }
  return all;
}

std::vector<Requirement> energy_requirements(const Rows& rows) {
  const EngineScene scene{'H', 6, 2.0};
  constexpr int kSubsteps = 8;
  Requirement at_end{"bdf2: energy after 5 s against the converged", "within 10 %", "", {}};
  Requirement departure{"bdf2: largest departure of its energy in 5 s, of all energy lost", "-", "", {}};
  Requirement motion{"bdf2: rms speed of the last second over the converged", "-", "", {}};
  const Measurement* bdf2 = rows.bdf2(scene);
  if (bdf2 == nullptr || !bdf2->complete()) return {at_end, departure, motion};

  const auto converged = [&](int substeps) {
    Trial trial(make_reference(scene, substeps), scene, std::numeric_limits<double>::infinity());
    trial.run(kFrames);
    return trial.measurement();
  };
  const Measurement reference = converged(kSubsteps), half = converged(kSubsteps / 2);
  const auto departs = [&](const Measurement& m) {
    double most = 0;
    for (std::size_t i = 0; i < kFrames; ++i)
      most = std::max(most, std::abs(m.energy[i] - reference.energy[i]));
    return text(100 * most / std::abs(reference.energy.back())) + " %";
  };
  const auto error = [&](const Measurement& m) {
    return std::abs(m.energy.back() / reference.energy.back() - 1);
  };
  at_end.measured = text(100 * error(*bdf2)) +
                    " % (with half its substeps the converged: " + text(100 * error(half)) + " %)";
  at_end.holds = error(*bdf2) <= 0.1;
  departure.measured = departs(*bdf2) + " (" + departs(half) + ")";
  motion.measured =
      text(bdf2->rms_speed / reference.rms_speed) + " (" + text(half.rms_speed / reference.rms_speed) + ")";
  return {at_end, departure, motion};
}

std::vector<Requirement> crowd_requirements() {
  constexpr int kCloths = 300;
  constexpr double kFrame = 1e3 / 60;  // ms
  const ManyCloths flags = measure_flags(kCloths, 4);
  const auto fit = [&](double ms) { return std::to_string(static_cast<int>(kCloths * kFrame / ms)); };
  return {{"flags of 17 x 17 nodes, bdf2, together at 60 Hz on one core", ">= 300",
           fit(flags.median_ms) + " (" + fit(flags.least_ms) + "): 300 take " + text(flags.median_ms) + " ms",
           flags.median_ms <= kFrame}};
}

std::vector<Requirement> instruction_set_requirements() {
  constexpr int kLevel = 6, kTurns = 5;
  std::vector<Requirement> all;
  for (const char* method : {"symplectic_euler", "xpbd", "bdf2"}) {
    std::vector<double> chosen, portable;
    for (int i = 0; i < kTurns; ++i) {
      chosen.push_back(frame_cost(method, kLevel));
      portable.push_back(weft_portable::bench::frame_cost(method, kLevel));
    }
    const double ratio = median(portable) / median(chosen);
    all.push_back({std::string(method) + ": portable build's frame over the shipped one's", ">= 3",
                   text(ratio) + ": " + text(median(portable)) + " over " + text(median(chosen)) + " ms",
                   ratio >= 3});
  }
  return all;
}

}  // namespace weft::bench
