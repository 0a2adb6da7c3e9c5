#pragma once
/// Binary messages of PROTOCOL.md section 4: records <-> bytes.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/grid_codec.h"

namespace weft::protocol {

inline constexpr std::size_t kHeaderBytes = 64;
inline constexpr std::uint8_t kClothRecord = 1, kBallsRecord = 2, kObstaclesRecord = 3, kTearsRecord = 4;
inline constexpr std::uint16_t kFlagLast = 1, kFlagPaused = 2, kFlagSlow = 4;

/// What all records of one message share.
struct FrameStamp {
  std::uint32_t frame = 0;  ///< steps since the epoch began
  std::uint32_t epoch = 0;
  double time = 0;  ///< simulated, s
  std::uint32_t server_ms = 0;
  std::uint16_t flags = 0;  ///< without kFlagLast
};

struct FrameBall {
  std::uint32_t id = 0;
  std::array<float, 3> position{};
  float radius = 0;
  bool dynamic = false;
  bool operator==(const FrameBall&) const = default;
};

/// An obstacle that is not where `scene` says.
struct FrameObstacle {
  std::uint32_t obstacle = 0;  ///< its place in `scene`
  std::array<float, 3> position{};
  std::array<float, 4> quaternion{};  ///< w, x, y, z
  bool operator==(const FrameObstacle&) const = default;
};

/// How a cloth's positions are written: as every client reads them (codec 1), or smaller for those that have
/// the capability grid.rice (codec 4, or 1 where that is smaller).
enum class GridCoding { plain, rice };

/// One cloth's record, last or not: encoded once a level, lattice and coding, and shared by all viewers of
/// these. `min_exponent`: as in choose_quantisation.
std::vector<std::uint8_t> encode_cloth_record(const FrameStamp& stamp, std::uint32_t cloth, int level,
                                              int simulated_level, int bits, const GridView& grid,
                                              int min_exponent = kMinQuantumExponent,
                                              GridCoding coding = GridCoding::plain);
/// What is torn of a cloth whose mesh has rows x cols nodes: face r * (cols - 1) + c is that right of and
/// below node (r, c); ascending, at least one. To follow the cloth's own record.
std::vector<std::uint8_t> encode_tears_record(const FrameStamp& stamp, std::uint32_t cloth, int level,
                                              int simulated_level, int rows, int cols,
                                              std::span<const std::uint32_t> torn_faces);
std::vector<std::uint8_t> encode_balls_record(const FrameStamp& stamp, std::span<const FrameBall> balls);
std::vector<std::uint8_t> encode_obstacles_record(const FrameStamp& stamp,
                                                  std::span<const FrameObstacle> obstacles);
/// Sets kFlagLast in the record that starts at `offset`.
void mark_last(std::vector<std::uint8_t>& message, std::size_t offset);

struct ClothRecord {
  std::uint32_t cloth = 0;
  int level = 0, simulated_level = 0;
  int rows = 0, cols = 0;
  Quantisation quantisation;
  std::vector<float> positions;           ///< x, y, z interleaved, row by row, m
  std::vector<std::uint32_t> torn_faces;  ///< as in encode_tears_record; empty while the cloth is whole
};

struct Frame {
  FrameStamp stamp;
  std::vector<ClothRecord> cloths;
  std::vector<FrameBall> balls;
  std::vector<FrameObstacle> obstacles;
};

/// What the first record's header says of the message's step, without a look at the rest; nothing if that is
/// not a header. For whoever counts frames.
std::optional<FrameStamp> read_stamp(std::span<const std::uint8_t> message);

/// Decodes one binary message. False, with a reason in `error`, on anything malformed.
bool decode_frame(std::span<const std::uint8_t> message, Frame& frame, std::string& error);

}  // namespace weft::protocol
