#include "fabric/report.h"

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "fabric/cantilever.h"
#include "fabric/drape.h"
#include "fabric/pure_bending.h"
#include "fabric/shear.h"
#include "fabric/specimen.h"
#include "fabric/tensile.h"

namespace weft::fabric {
namespace {

using Clock = std::chrono::steady_clock;

class Bench {
 public:
  explicit Bench(std::string fabric) : fabric_(std::move(fabric)) {}

  /// Adds the numbers that `instrument` gives by `add(name, unit, value)`; if it finds none, one of `name`.
  template <class Instrument>
  void run(const std::string& name, const std::string& unit, Instrument instrument) {
    const auto begin = Clock::now();
    const std::size_t first = readings_.size();
    try {
      instrument();
    } catch (const NoRest& none) {
      readings_.push_back({name, unit, {}, none.what(), {}, 0});
    }
    if (readings_.size() > first)
      readings_[first].seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  }
  void add(const std::string& name, const std::string& unit, double value) {
    readings_.push_back({name, unit, value, "", {}, 0});
  }
  void add(Quantity quantity, double value) {
    readings_.push_back({std::string(name_of(quantity)), std::string(unit_of(quantity)), value, "",
                         published_of(fabric_, quantity), 0});
  }
  std::vector<Reading> take() { return std::move(readings_); }

 private:
  std::string fabric_;
  std::vector<Reading> readings_;
};

std::string text_of(const char* format, auto... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string range_of(const Published& published) {
  return published.low == published.high ? text_of("%.4g", published.low)
                                         : text_of("%.4g to %.4g", published.low, published.high);
}

}  // namespace

std::vector<Reading> test(const Material& material, const std::string& fabric, int drape_cells) {
  const Material weft = turned(material);
  Bench bench(fabric);
  const auto both = [&](const char* name, const char* unit, auto instrument) {
    bench.run(std::string(name) + "_warp", unit, [&] { instrument(material, true); });
    bench.run(std::string(name) + "_weft", unit, [&] { instrument(weft, false); });
  };
  both("bending_length", "m", [&](const Material& strip, bool warp) {
    bench.add(warp ? Quantity::bending_length_warp : Quantity::bending_length_weft,
              cantilever(strip).bending_length());
  });
  both("bending_rigidity", "N m", [&](const Material& strip, bool warp) {
    bench.add(warp ? "bending_rigidity_warp" : "bending_rigidity_weft", "N m", pure_bending(strip));
  });
  both("stretch", "N/m", [&](const Material& strip, bool warp) {
    bench.add(warp ? Quantity::stretch_warp : Quantity::stretch_weft,
              kLargestLoad / tensile(strip, false).extension);
  });
  both("emt_limited", "", [&](const Material& strip, bool warp) {
    const Tensile pulled = tensile(strip, true);
    const std::string along = warp ? "_warp" : "_weft";
    bench.add("emt_limited" + along, "", pulled.extension);
    bench.add("wt_limited" + along, "J/m2", pulled.work);
    bench.add("lt_limited" + along, "", pulled.linearity);
  });
  bench.run("shear", "N/m", [&] {
    const Shear sheared = shear(material, false);
    bench.add(Quantity::shear, sheared.stiffness);
    bench.add("shear_gf_cm_degree", "gf/(cm deg)", sheared.stiffness / kGramForcePerDegree);
    bench.add("shear_force_8_degrees", "N/m", sheared.at_8_degrees);
  });
  bench.run("drape", "", [&] {
    const Drape draped = drape(material, drape_cells);
    bench.add(Quantity::drape, draped.coefficient);
    bench.add("folds", "", draped.folds);
  });
  return bench.take();
}

double deviation(double value, const Published& published) {
  if (value < published.low) return value / published.low - 1;
  if (value > published.high) return value / published.high - 1;
  return 0;
}

std::string table(const std::vector<Reading>& readings) {
  std::string text;
  for (const Reading& reading : readings) {
    const std::string value = reading.value ? text_of("%.4g", *reading.value) : "-";
    text += text_of("%-24s %10s %-12s", reading.name.c_str(), value.c_str(), reading.unit.c_str());
    text += reading.seconds > 0 ? text_of("%7.2f s\n", reading.seconds) : "\n";
    if (!reading.value) text += "    " + reading.why + "\n";
    for (const Published& each : reading.published) {
      text += text_of("    measured %s, %+.0f %%%s: ", range_of(each).c_str(),
                      100 * deviation(*reading.value, each), each.same_cloth ? "" : ", like cloth");
      text += std::string(each.source) + "\n";
    }
  }
  return text;
}

nlohmann::json json_of(const std::vector<Reading>& readings) {
  nlohmann::json all = nlohmann::json::object();
  for (const Reading& reading : readings) {
    nlohmann::json& one = all[reading.name];
    one = {{"unit", reading.unit}, {"seconds", reading.seconds}};
    if (reading.value) {
      one["simulated"] = *reading.value;
    } else {
      one["why"] = reading.why;
    }
    for (const Published& each : reading.published) {
      one["measured"].push_back({{"range", {each.low, each.high}},
                                 {"same_cloth", each.same_cloth},
                                 {"deviation", deviation(*reading.value, each)},
                                 {"source", each.source}});
    }
  }
  return all;
}

}  // namespace weft::fabric
