#pragma once
#include <random>
#include <string>

namespace weft::host {

/// So many hexadecimal digits that nobody can guess.
inline std::string random_name(std::size_t digits) {
  std::random_device random;  // the system's own
  std::string name;
  while (name.size() < digits) {
    char eight[9];
    std::snprintf(eight, sizeof eight, "%08x", random());
    name += eight;
  }
  name.resize(digits);
  return name;
}

}  // namespace weft::host
