#include "cli/writers/usda/usda_text.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "cli/writers/output_file.h"

namespace weft::cli {
namespace {

template <class Number>
void append_tuple(std::string& text, std::span<const Number> values) {
  char before = '(';
  for (const Number value : values) {
    text += before;
    if (before == ',') text += ' ';
    append_number(text, value);
    before = ',';
  }
  text += ')';
}

}  // namespace

std::string usda_vectors(std::span<const float> values, std::size_t width) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); i += width) {
    if (i > 0) text += ", ";
    append_tuple(text, values.subspan(i, width));
  }
  text += ']';
  return text;
}

std::string usda_integers(std::span<const std::uint32_t> values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i)
    text.append(i > 0 ? ", " : "").append(std::to_string(values[i]));
  text += ']';
  return text;
}

std::string usda_vector(const Vec3& value) {
  std::string text;
  append_tuple(text, std::span<const double>(value.data(), 3));
  return text;
}

std::string usda_quaternion(const Quaternion& value) {
  const Eigen::Quaternionf unit = value.cast<float>().normalized();
  const std::array<float, 4> parts{unit.w(), unit.x(), unit.y(), unit.z()};
  std::string text;
  append_tuple(text, std::span<const float>(parts));
  return text;
}

std::string usda_extent(std::span<const float> points) {
  std::array<float, 6> corners{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    corners[axis] = corners[axis + 3] = points[axis];
    for (std::size_t i = axis; i < points.size(); i += 3) {
      corners[axis] = std::min(corners[axis], points[i]);
      corners[axis + 3] = std::max(corners[axis + 3], points[i]);
    }
  }
  return usda_vectors(corners, 3);
}

std::string usda_name(const std::string& name) {
  std::string result = name;
  for (char& c : result) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) != 0)
    result.insert(0, 1, '_');
  return result;
}

}  // namespace weft::cli
