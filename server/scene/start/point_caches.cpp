#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "scene/readers.h"
#include "scene/start/start_files.h"

namespace weft::scene {
namespace {

constexpr std::uint64_t kWord = 4;                // bytes of an integer or a float
constexpr std::uint64_t kPointBytes = 3 * kWord;  // x, y, z

/// A number of four bytes, of either order; the file is as long as that.
template <class Number>
Number word(std::string_view bytes, std::uint64_t at, std::endian order) {
  static_assert(sizeof(Number) == kWord && std::endian::native == std::endian::little);
  std::array<char, kWord> raw{};
  std::memcpy(raw.data(), bytes.data() + at, kWord);
  if (order == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

/// Throws if the file is not as long as its header says.
void check_cache(std::string_view bytes, std::uint64_t header, std::uint64_t frames, std::uint64_t points) {
  if (points == 0 || points > kMaxClothNodes)
    throw std::invalid_argument("has " + std::to_string(points) + " points; must have 1 to " +
                                std::to_string(kMaxClothNodes));
  const std::uint64_t expected = header + frames * points * kPointBytes;
  if (bytes.size() != expected)
    throw std::invalid_argument("has " + std::to_string(bytes.size()) + " bytes; " + std::to_string(frames) +
                                " frames of " + std::to_string(points) + " points have " +
                                std::to_string(expected));
}

StartMesh points_at(std::string_view bytes, std::uint64_t at, std::uint64_t points, std::endian order) {
  StartMesh mesh;
  for (std::uint64_t i = 0; i < points; ++i) {
    Vec3& node = mesh.nodes.emplace_back();
    for (int axis = 0; axis < 3; ++axis, at += kWord) node[axis] = word<float>(bytes, at, order);
    if (!node.allFinite()) throw std::invalid_argument("has a point that is not finite");
  }
  return mesh;
}

}  // namespace

StartMesh read_mdd_start(std::string_view bytes, const StartChoice& choice) {
  constexpr std::uint64_t kCounts = 2 * kWord;
  if (bytes.size() < kCounts) throw std::invalid_argument("ends within its header");
  const std::uint64_t frames = word<std::uint32_t>(bytes, 0, std::endian::big);
  const std::uint64_t points = word<std::uint32_t>(bytes, kWord, std::endian::big);
  const std::uint64_t header = kCounts + frames * kWord;
  check_cache(bytes, header, frames, points);
  std::vector<double> times;
  for (std::uint64_t i = 0; i < frames; ++i)
    times.push_back(word<float>(bytes, kCounts + i * kWord, std::endian::big));
  const std::uint64_t chosen = chosen_frame(choice, times);
  return points_at(bytes, header + chosen * points * kPointBytes, points, std::endian::big);
}

StartMesh read_pc2_start(std::string_view bytes, const StartChoice& choice) {
  constexpr std::string_view kSignature{"POINTCACHE2\0", 12};
  constexpr std::uint64_t kPointsAt = 16, kFramesAt = 28, kHeader = 32;
  if (!bytes.starts_with(kSignature) || bytes.size() < kHeader)
    throw std::invalid_argument("does not begin with the header of a .pc2 file");
  if (choice.time) throw std::invalid_argument("has frames, and no times; \"frame\" chooses one");
  const std::uint64_t frames = word<std::uint32_t>(bytes, kFramesAt, std::endian::little);
  const std::uint64_t points = word<std::uint32_t>(bytes, kPointsAt, std::endian::little);
  check_cache(bytes, kHeader, frames, points);
  const std::uint64_t chosen = chosen_frame(choice, std::vector<double>(frames));
  return points_at(bytes, kHeader + chosen * points * kPointBytes, points, std::endian::little);
}

}  // namespace weft::scene
