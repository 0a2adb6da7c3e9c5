#include "record/chunks.h"

#include <boost/crc.hpp>
#include <limits>
#include <stdexcept>

namespace weft::record {
namespace {

constexpr std::size_t kHead = 9;  // bytes before a chunk's own

void append(std::string& to, std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) to += static_cast<char>(number >> shift & 0xff);
}

std::uint32_t number_at(std::string_view text, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[at + i])) << 8 * i;
  return number;
}

std::uint32_t checksum(std::string_view kind_and_size, std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(kind_and_size.data(), kind_and_size.size());
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace

void append_chunk(std::string& to, const Chunk& chunk) {
  if (chunk.bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("a chunk of a recording has less than 4 GiB");
  std::string head(1, static_cast<char>(chunk.kind));
  append(head, static_cast<std::uint32_t>(chunk.bytes.size()));
  append(head, checksum(head, chunk.bytes));
  to += head;
  to += chunk.bytes;
}

ChunkReader::ChunkReader(std::string_view text) : text_(text), at_(kMark.size()) {
  if (!text.starts_with(kMark)) throw std::invalid_argument("it is no recording of this format");
}

std::optional<Chunk> ChunkReader::next() {
  if (at_ == text_.size() || !damage_.empty()) return std::nullopt;
  const std::string_view rest = text_.substr(at_);
  if (rest.size() < kHead || rest.size() - kHead < number_at(rest, 1)) {
    damage_ = "it is cut short at byte " + std::to_string(at_);
    return std::nullopt;
  }
  const std::string_view bytes = rest.substr(kHead, number_at(rest, 1));
  if (checksum(rest.substr(0, 5), bytes) != number_at(rest, 5)) {
    damage_ = "it is damaged at byte " + std::to_string(at_);
    return std::nullopt;
  }
  at_ += kHead + bytes.size();
  return Chunk{static_cast<ChunkKind>(rest[0]), bytes};
}

}  // namespace weft::record
