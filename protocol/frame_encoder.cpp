/// Records of frame.h to bytes.
#include <cstring>

#include "protocol/frame_layout.h"
#include "protocol/rice_codec.h"

namespace weft::protocol {
namespace {

template <class T>
void put(std::uint8_t* record, std::size_t offset, T value) {
  std::memcpy(record + offset, &value, sizeof value);
}

std::vector<std::uint8_t> header(const FrameStamp& stamp, std::uint8_t type, std::uint8_t codec,
                                 std::size_t cols, std::size_t rows) {
  std::vector<std::uint8_t> record(kHeaderBytes, 0);
  std::memcpy(record.data(), kMagic.data(), kMagic.size());
  put(record.data(), kVersionAt, kVersion);
  put(record.data(), kTypeAt, type);
  put(record.data(), kFlagsAt, stamp.flags);
  put(record.data(), kHeaderLengthAt, static_cast<std::uint16_t>(kHeaderBytes));
  put(record.data(), kCodecAt, codec);
  put(record.data(), kFrameAt, stamp.frame);
  put(record.data(), kEpochAt, stamp.epoch);
  put(record.data(), kTimeAt, stamp.time);
  put(record.data(), kServerMsAt, stamp.server_ms);
  put(record.data(), kColsAt, static_cast<std::uint16_t>(cols));
  put(record.data(), kRowsAt, static_cast<std::uint16_t>(rows));
  return record;
}

void put_payload_length(std::vector<std::uint8_t>& record) {
  put(record.data(), kPayloadLengthAt, static_cast<std::uint32_t>(record.size() - kHeaderBytes));
}

/// By codec 4; by codec 1 where nothing can be foreseen of the grid, so that no record is larger than codec 1
/// can make it.
void encode_smaller(const GridView& grid, const Quantisation& quantisation,
                    std::vector<std::uint8_t>& record) {
  encode_rice_grid(grid, quantisation, record);
  put(record.data(), kCodecAt, kRiceCodec);
  const std::size_t values = 3 * static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.cols);
  if (record.size() - kHeaderBytes <= 2 * values) return;  // codec 1 may take 19 bits a value
  std::vector<std::uint8_t> plain(record.begin(), record.begin() + kHeaderBytes);
  encode_grid(grid, quantisation, plain);
  if (plain.size() > record.size()) return;
  put(plain.data(), kCodecAt, kGridCodec);
  record = std::move(plain);
}

}  // namespace

std::vector<std::uint8_t> encode_cloth_record(const FrameStamp& stamp, std::uint32_t cloth, int level,
                                              int simulated_level, int bits, const GridView& grid,
                                              int min_exponent, GridCoding coding) {
  auto record = header(stamp, kClothRecord, kGridCodec, static_cast<std::size_t>(grid.cols),
                       static_cast<std::size_t>(grid.rows));
  const Quantisation quantisation = choose_quantisation(grid, bits, min_exponent);
  put(record.data(), kBitsAt, static_cast<std::uint8_t>(bits));
  put(record.data(), kClothAt, cloth);
  put(record.data(), kLevelAt, static_cast<std::uint8_t>(level));
  put(record.data(), kSimulatedLevelAt, static_cast<std::uint8_t>(simulated_level));
  put(record.data(), kOriginAt, quantisation.origin);
  put(record.data(), kQuantumAt, quantisation.quantum);
  if (coding == GridCoding::plain) {
    encode_grid(grid, quantisation, record);
  } else {
    encode_smaller(grid, quantisation, record);
  }
  put_payload_length(record);
  return record;
}

std::vector<std::uint8_t> encode_tears_record(const FrameStamp& stamp, std::uint32_t cloth, int level,
                                              int simulated_level, int rows, int cols,
                                              std::span<const std::uint32_t> torn_faces) {
  auto record =
      header(stamp, kTearsRecord, kGapsCodec, static_cast<std::size_t>(cols), static_cast<std::size_t>(rows));
  put(record.data(), kClothAt, cloth);
  put(record.data(), kLevelAt, static_cast<std::uint8_t>(level));
  put(record.data(), kSimulatedLevelAt, static_cast<std::uint8_t>(simulated_level));
  std::uint32_t next = 0;
  for (const std::uint32_t face : torn_faces) {
    std::uint32_t gap = face - next;
    for (; gap >= 0x80U; gap >>= 7U) record.push_back(static_cast<std::uint8_t>(gap | 0x80U));
    record.push_back(static_cast<std::uint8_t>(gap));
    next = face + 1;
  }
  put_payload_length(record);
  return record;
}

std::vector<std::uint8_t> encode_balls_record(const FrameStamp& stamp, std::span<const FrameBall> balls) {
  auto record = header(stamp, kBallsRecord, kListCodec, balls.size(), 1);
  record.resize(kHeaderBytes + balls.size() * kBallBytes);
  std::uint8_t* to = record.data() + kHeaderBytes;
  for (const FrameBall& ball : balls) {
    put(to, 0, ball.id);
    put(to, 4, ball.position);
    put(to, 16, ball.radius);
    put(to, 20, std::uint32_t{ball.dynamic});
    to += kBallBytes;
  }
  put_payload_length(record);
  return record;
}

std::vector<std::uint8_t> encode_obstacles_record(const FrameStamp& stamp,
                                                  std::span<const FrameObstacle> obstacles) {
  auto record = header(stamp, kObstaclesRecord, kListCodec, obstacles.size(), 1);
  record.resize(kHeaderBytes + obstacles.size() * kObstacleBytes);
  std::uint8_t* to = record.data() + kHeaderBytes;
  for (const FrameObstacle& obstacle : obstacles) {
    put(to, 0, obstacle.obstacle);
    put(to, 4, obstacle.position);
    put(to, 16, obstacle.quaternion);
    to += kObstacleBytes;
  }
  put_payload_length(record);
  return record;
}

void mark_last(std::vector<std::uint8_t>& message, std::size_t offset) {
  message[offset + kFlagsAt] |= static_cast<std::uint8_t>(kFlagLast);
}

}  // namespace weft::protocol
