#pragma once
/// A recording's bytes: a mark, then chunks, each with its kind, its size and a checksum. Written one after
/// the other, so that whatever was written before a machine stops can be read.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weft::record {

/// Begins each recording; its last byte is the format's number.
inline constexpr std::string_view kMark{"weftrec\x01", 8};

enum class ChunkKind : std::uint8_t {
  scene = 1,     ///< JSON: what is simulated, and by which build of Weft
  state = 2,     ///< of the simulation (cloth/world/state.h)
  commands = 3,  ///< and steps, in their order
  hash = 4,      ///< of the state, after what came before
  service = 5,   ///< of the scene being served, beside its simulation
};

struct Chunk {
  ChunkKind kind = ChunkKind::scene;
  std::string_view bytes;
};

/// Appends a chunk: kind (1 byte), size (4, little endian), CRC-32 of kind, size and bytes (4), bytes.
void append_chunk(std::string& to, const Chunk& chunk);

/// Chunks of a text, which must outlive it, one after the other.
class ChunkReader {
 public:
  /// Throws std::invalid_argument if it does not begin with kMark.
  explicit ChunkReader(std::string_view text);

  /// Nothing where the text ends, or is damaged.
  std::optional<Chunk> next();
  /// What is wrong with what comes next, and at which byte; empty where the text just ends.
  const std::string& damage() const { return damage_; }

 private:
  std::string_view text_;
  std::size_t at_;
  std::string damage_;
};

}  // namespace weft::record
