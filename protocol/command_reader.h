#pragma once
/// Client messages as a table of operations and their members: reading, checking and writing all come from
/// it.
#include <nlohmann/json.hpp>
#include <optional>

#include "protocol/message.h"
#include "protocol/strict_json.h"

namespace weft::protocol {

/// Fills `request` from a message. The first fault, in the order: object, id, op, unknown members, then the
/// op's members as PROTOCOL.md lists them.
std::optional<JsonFault> read_command(const nlohmann::json& message, Request& request);

/// The inverse: op, id, then the members in the table's order.
void write_command(const Request& request, nlohmann::ordered_json& message);

}  // namespace weft::protocol
