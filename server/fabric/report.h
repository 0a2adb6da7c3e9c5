#pragma once
/// All instruments' numbers of one material, beside what others have measured.
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cloth/sheet/material.h"
#include "fabric/published.h"

namespace weft::fabric {

struct Reading {
  std::string name;  ///< of the quantity, or of one that nobody has published
  std::string unit;
  std::optional<double> value;       ///< nothing where the instrument finds no rest
  std::string why;                   ///< it found none
  std::vector<Published> published;  ///< none without a value
  double seconds = 0;                ///< that the instrument took
};

/// Runs every instrument. `fabric` names what published() is asked for; empty: nothing. `drape_cells` as in
/// drape().
std::vector<Reading> test(const Material& material, const std::string& fabric, int drape_cells);

/// How far a value is from the nearest end of what was published, a share of that; 0 within.
double deviation(double value, const Published& published);

/// Plain text: a line a reading and a line for each source.
std::string table(const std::vector<Reading>& readings);
nlohmann::json json_of(const std::vector<Reading>& readings);

}  // namespace weft::fabric
