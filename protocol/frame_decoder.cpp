/// Bytes, of whomever, to records of frame.h.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "protocol/frame_layout.h"
#include "protocol/rice_codec.h"

namespace weft::protocol {
namespace {

template <class T>
T get(std::span<const std::uint8_t> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

bool finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// A lattice all of whose positions are finite floats, with a normal power of two as quantum.
bool usable(const Quantisation& lattice) {
  // Neither sign nor fraction bits; an exponent of neither zeros (subnormal) nor ones (infinite).
  const auto bits = std::bit_cast<std::uint32_t>(lattice.quantum);
  const std::uint32_t exponent = bits >> 23;
  if ((bits & 0x807fffffU) != 0 || exponent == 0 || exponent == 255) return false;
  const double reach = double(lattice.quantum) * double((1 << lattice.bits) - 1);
  return std::all_of(lattice.origin.begin(), lattice.origin.end(), [&](float origin) {
    return std::abs(double(origin)) + reach <= double(std::numeric_limits<float>::max());  // false for a NaN
  });
}

FrameStamp stamp_of(std::span<const std::uint8_t> header) {
  FrameStamp stamp;
  stamp.frame = get<std::uint32_t>(header, kFrameAt);
  stamp.epoch = get<std::uint32_t>(header, kEpochAt);
  stamp.time = get<double>(header, kTimeAt);
  stamp.server_ms = get<std::uint32_t>(header, kServerMsAt);
  stamp.flags = static_cast<std::uint16_t>(get<std::uint16_t>(header, kFlagsAt) & ~kFlagLast);
  return stamp;
}

/// The records of one message, one after the other; the first fault ends it.
class Reader {
 public:
  Reader(Frame& frame, std::string& error) : frame_(frame), error_(error) {}

  bool read(std::span<const std::uint8_t> message) {
    if (message.empty()) return fail("empty message");
    for (bool last = false; !message.empty();) {
      if (last) return fail("bytes after the last record");
      if (message.size() < kHeaderBytes) return fail("header cut short");
      if (std::memcmp(message.data(), kMagic.data(), kMagic.size()) != 0) return fail("wrong magic");
      if (message[kVersionAt] != kVersion) return fail("version " + std::to_string(message[kVersionAt]));
      const std::size_t header_bytes = get<std::uint16_t>(message, kHeaderLengthAt);
      if (header_bytes < kHeaderBytes || header_bytes > kMaxHeaderBytes || header_bytes % 8 != 0)
        return fail("header_length " + std::to_string(header_bytes));
      if (message.size() < header_bytes) return fail("header cut short");
      const std::size_t payload_bytes = get<std::uint32_t>(message, kPayloadLengthAt);
      if (message.size() - header_bytes < payload_bytes) return fail("payload cut short");

      last = (get<std::uint16_t>(message, kFlagsAt) & kFlagLast) != 0;
      const auto payload = message.subspan(header_bytes, payload_bytes);
      if (!stamp(message) || !record(message, payload)) return false;
      message = message.subspan(header_bytes + payload_bytes);
      if (message.empty() && !last) return fail("last record is missing");
    }
    return true;
  }

 private:
  bool fail(std::string reason) {
    error_ = std::move(reason);
    return false;
  }

  /// All records of a message are of one step.
  bool stamp(std::span<const std::uint8_t> header) {
    const FrameStamp stamp = stamp_of(header);
    if (!std::isfinite(stamp.time)) return fail("time is not finite");
    if (stamped_ && (stamp.frame != frame_.stamp.frame || stamp.epoch != frame_.stamp.epoch))
      return fail("records of different steps");
    if (!stamped_) frame_.stamp = stamp;
    stamped_ = true;
    return true;
  }

  bool record(std::span<const std::uint8_t> header, std::span<const std::uint8_t> payload) {
    switch (header[kTypeAt]) {
      case kClothRecord:
        return cloth(header, payload);
      case kTearsRecord:
        return tears(header, payload);
      case kBallsRecord:
        return balls(header, payload);
      case kObstaclesRecord:
        return obstacles(header, payload);
      default:
        return true;  // of a later minor version
    }
  }

  bool cloth(std::span<const std::uint8_t> header, std::span<const std::uint8_t> payload) {
    const auto codec = header[kCodecAt];
    if (codec != kGridCodec && codec != kRiceCodec) return fail("codec " + std::to_string(codec));
    ClothRecord cloth;
    cloth.cloth = get<std::uint32_t>(header, kClothAt);
    cloth.level = header[kLevelAt];
    cloth.simulated_level = header[kSimulatedLevelAt];
    cloth.cols = get<std::uint16_t>(header, kColsAt);
    cloth.rows = get<std::uint16_t>(header, kRowsAt);
    cloth.quantisation.bits = header[kBitsAt];
    cloth.quantisation.origin = get<std::array<float, 3>>(header, kOriginAt);
    cloth.quantisation.quantum = get<float>(header, kQuantumAt);
    if (cloth.quantisation.bits < 8 || cloth.quantisation.bits > 16)
      return fail(std::to_string(cloth.quantisation.bits) + " bits");
    if (!usable(cloth.quantisation)) return fail("unusable origin or quantum");
    const auto decode = codec == kRiceCodec ? decode_rice_grid : decode_grid;
    if (!decode(payload, cloth.rows, cloth.cols, cloth.quantisation, cloth.positions, error_)) return false;
    frame_.cloths.push_back(std::move(cloth));
    return true;
  }

  bool tears(std::span<const std::uint8_t> header, std::span<const std::uint8_t> payload) {
    if (header[kCodecAt] != kGapsCodec) return fail("codec " + std::to_string(header[kCodecAt]));
    const auto index = get<std::uint32_t>(header, kClothAt);
    const auto cloth = std::find_if(frame_.cloths.begin(), frame_.cloths.end(),
                                    [&](const ClothRecord& each) { return each.cloth == index; });
    if (cloth == frame_.cloths.end() || cloth->cols != get<std::uint16_t>(header, kColsAt) ||
        cloth->rows != get<std::uint16_t>(header, kRowsAt))
      return fail("tears of no mesh before them");
    const auto faces = static_cast<std::uint32_t>((cloth->rows - 1) * (cloth->cols - 1));
    std::uint32_t next = 0;  // the least that the next face can be
    for (std::size_t at = 0; at < payload.size();) {
      std::uint32_t gap = 0;
      int shift = 0;
      for (bool more = true; more; shift += 7) {
        if (at == payload.size() || shift > 14) return fail("unreadable gap between tears");
        more = (payload[at] & 0x80U) != 0;
        gap |= static_cast<std::uint32_t>(payload[at++] & 0x7fU) << shift;
      }
      if (gap >= faces - next) return fail("tear beyond the mesh");
      cloth->torn_faces.push_back(next + gap);
      next += gap + 1;
    }
    return true;
  }

  /// Checks a list of `things`, `bytes` each.
  bool list(std::span<const std::uint8_t> header, std::span<const std::uint8_t> payload, const char* things,
            std::size_t bytes) {
    if (header[kCodecAt] != kListCodec) return fail("codec " + std::to_string(header[kCodecAt]));
    const std::size_t count = get<std::uint16_t>(header, kColsAt);
    if (get<std::uint16_t>(header, kRowsAt) != 1) return fail(std::string(things) + " in more than one row");
    if (payload.size() != count * bytes)
      return fail(std::string(things) + " of another length than their number");
    return true;
  }

  bool balls(std::span<const std::uint8_t> header, std::span<const std::uint8_t> payload) {
    if (!list(header, payload, "balls", kBallBytes)) return false;
    for (std::size_t at = 0; at < payload.size(); at += kBallBytes) {
      FrameBall ball;
      ball.id = get<std::uint32_t>(payload, at);
      ball.position = get<std::array<float, 3>>(payload, at + 4);
      ball.radius = get<float>(payload, at + 16);
      const auto motion = get<std::uint32_t>(payload, at + 20);
      if (!finite(ball.position) || !std::isfinite(ball.radius)) return fail("ball is not finite");
      if (motion > 1) return fail("ball with motion " + std::to_string(motion));
      ball.dynamic = motion == 1;
      frame_.balls.push_back(ball);
    }
    return true;
  }

  bool obstacles(std::span<const std::uint8_t> header, std::span<const std::uint8_t> payload) {
    if (!list(header, payload, "obstacles", kObstacleBytes)) return false;
    for (std::size_t at = 0; at < payload.size(); at += kObstacleBytes) {
      const FrameObstacle obstacle{get<std::uint32_t>(payload, at),
                                   get<std::array<float, 3>>(payload, at + 4),
                                   get<std::array<float, 4>>(payload, at + 16)};
      if (!finite(obstacle.position) || !finite(obstacle.quaternion)) return fail("obstacle is not finite");
      frame_.obstacles.push_back(obstacle);
    }
    return true;
  }

  Frame& frame_;
  std::string& error_;
  bool stamped_ = false;
};

}  // namespace

std::optional<FrameStamp> read_stamp(std::span<const std::uint8_t> message) {
  if (message.size() < kHeaderBytes || std::memcmp(message.data(), kMagic.data(), kMagic.size()) != 0 ||
      message[kVersionAt] != kVersion)
    return std::nullopt;
  return stamp_of(message);
}

bool decode_frame(std::span<const std::uint8_t> message, Frame& frame, std::string& error) {
  frame = {};
  return Reader(frame, error).read(message);
}

}  // namespace weft::protocol
