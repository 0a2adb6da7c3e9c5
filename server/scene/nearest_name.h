#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace weft::scene {

/// The name that was probably meant by `given`: the one with the fewest characters left out, added, changed
/// or swapped with their neighbour (optimal string alignment), whatever their case, at most one in three;
/// else the only one that has `given` in it, or is in it. Empty if there is none, or `given` is one of them.
std::string_view nearest_name(std::string_view given, const std::vector<std::string_view>& names);

/// `; did you mean "NAME"?` of that name; empty without one.
std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& names);

}  // namespace weft::scene
