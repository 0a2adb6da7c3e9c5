#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace weft::protocol {

/// The frame that `{"op":"ack","f":FRAME}` acknowledges, with JSON's spaces where they may be: as all clients
/// write what they send most. Nothing for any other text, an acknowledgement written otherwise among them,
/// which parse_request() reads.
std::optional<std::uint32_t> read_plain_ack(std::string_view text);

}  // namespace weft::protocol
