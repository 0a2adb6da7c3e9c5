#pragma once
/// What members of client messages hold beside numbers and texts.
#include <array>
#include <map>
#include <string>
#include <vector>

namespace weft::protocol {

using Vector = std::array<double, 3>;
using Turn = std::array<double, 4>;  ///< w, x, y, z; unit length after parsing
/// A ball's, "kinematic" or "dynamic" on the wire.
enum class Motion { kinematic, dynamic };
/// A number, or an array of several.
using Numbers = std::vector<double>;
using Parameters = std::map<std::string, Numbers>;  ///< by name, at least one

}  // namespace weft::protocol
