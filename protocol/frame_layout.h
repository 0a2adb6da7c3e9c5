#pragma once
/// Where a record of frame.h has what: shared by encoder and decoder, for their .cpp files only.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "protocol/frame.h"

namespace weft::protocol {

static_assert(std::endian::native == std::endian::little, "fields are stored as they lie in memory");

inline constexpr std::array<std::uint8_t, 4> kMagic{'W', 'E', 'F', 'T'};
inline constexpr std::uint8_t kVersion = 1, kGridCodec = 1, kListCodec = 2, kGapsCodec = 3, kRiceCodec = 4;
inline constexpr std::size_t kBallBytes = 24, kObstacleBytes = 32, kMaxHeaderBytes = 256;

/// Offsets of a record's header's fields.
enum Offset : std::size_t {
  kVersionAt = 4,
  kTypeAt = 5,
  kFlagsAt = 6,
  kHeaderLengthAt = 8,
  kCodecAt = 10,
  kBitsAt = 11,
  kClothAt = 12,
  kFrameAt = 16,
  kEpochAt = 20,
  kTimeAt = 24,
  kServerMsAt = 32,
  kLevelAt = 36,
  kSimulatedLevelAt = 37,
  kColsAt = 40,
  kRowsAt = 42,
  kOriginAt = 44,
  kQuantumAt = 56,
  kPayloadLengthAt = 60,
};

}  // namespace weft::protocol
