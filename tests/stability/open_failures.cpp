#include "open_failures.h"

#include <fstream>
#include <set>
#include <stdexcept>

namespace weft::stability {

bool is_open(const std::string& name) {
  static const std::set<std::string> names = [] {
    std::ifstream file(WEFT_STABILITY_OPEN);
    if (!file) throw std::runtime_error(WEFT_STABILITY_OPEN " cannot be read");
    std::set<std::string> read;
    for (std::string line; std::getline(file, line);) read.insert(line.substr(0, line.find(' ')));
    return read;
  }();
  return names.contains(name);
}

}  // namespace weft::stability
