#include "scene/start/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

namespace weft::scene {

std::string_view take_line(std::string_view& text) {
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

double take_number(std::string_view& text) {
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t,[(])")));
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) {
    constexpr std::size_t kTold = 20;
    throw std::invalid_argument("has \"" + std::string(text.substr(0, std::min(kTold, text.find('\n')))) +
                                "\" where a number is expected");
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

}  // namespace weft::scene
