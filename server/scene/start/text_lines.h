#pragma once
/// Lines and numbers of a text, taken from its front, in any locale.
#include <array>
#include <string_view>

namespace weft::scene {

/// Takes the next line, without its end.
std::string_view take_line(std::string_view& text);

/// Takes the next number and the blanks, commas, brackets and parentheses before it. Throws
/// std::invalid_argument if there is none, or it is not finite.
double take_number(std::string_view& text);

/// The same of several.
template <std::size_t count>
std::array<double, count> take_numbers(std::string_view& text) {
  std::array<double, count> numbers{};
  for (double& number : numbers) number = take_number(text);
  return numbers;
}

}  // namespace weft::scene
