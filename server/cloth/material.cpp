#include "cloth/material.h"

#include <algorithm>
#include <array>

namespace weft {

std::span<const Fabric> fabrics() {
  static constexpr std::array<Fabric, 4> kFabrics{{
      {"silk", {0.06, 1000, 10, 0.1, 0.05}, ""},
      {"cotton", {0.15, 3000, 50, 1, 0.1}, ""},
      {"wool", {0.25, 2000, 50, 1, 0.1}, ""},
      {"denim", {0.4, 10000, 500, 5, 0.2}, ""},
  }};
  return kFabrics;
}

const Fabric* find_fabric(std::string_view name) {
  const auto all = fabrics();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Fabric& fabric) { return fabric.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace weft
