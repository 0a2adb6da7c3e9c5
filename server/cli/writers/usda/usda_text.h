#pragma once
/// Values as USD's text has them.
#include <cstdint>
#include <span>
#include <string>

#include "cloth/world/description.h"

namespace weft::cli {

/// [(x, y, z), ...] of values interleaved; `width` 2 or 3.
std::string usda_vectors(std::span<const float> values, std::size_t width);
/// [a, b, ...]
std::string usda_integers(std::span<const std::uint32_t> values);
/// (x, y, z)
std::string usda_vector(const Vec3& value);
/// (w, x, y, z), unit.
std::string usda_quaternion(const Quaternion& value);
/// The corners of the box around points: [(x, y, z), (x, y, z)].
std::string usda_extent(std::span<const float> points);
/// `name` as that of a prim: letters, digits and _, no digit first.
std::string usda_name(const std::string& name);

}  // namespace weft::cli
