#include <nlohmann/json.hpp>
#include <variant>

#include "protocol/message.h"
#include "targets.h"

namespace weft::fuzz {

// A request means the same once it is written and read again; a refusal says why and can be sent.
void messages(Input input) {
  const auto parsed = protocol::parse_request(text_of(input));
  if (const auto* error = std::get_if<protocol::Error>(&parsed)) {
    require(!error->code.empty() && !error->message.empty(), "a refusal has a code and a message");
    require(nlohmann::json::accept(protocol::error_text(*error)), "a refusal is sent as JSON");
    return;
  }
  const auto& request = std::get<protocol::Request>(parsed);
  const std::string text = protocol::to_text(request);
  // Written with all members, a message may be longer than it came.
  protocol::Limits roomy;
  roomy.message_bytes = 1 << 20;
  const auto again = protocol::parse_request(text, roomy);
  require(std::holds_alternative<protocol::Request>(again), "a written request can be read");
  const auto& same = std::get<protocol::Request>(again);
  require(same.id == request.id && same.command.index() == request.command.index(),
          "a written request is the same request");
}

}  // namespace weft::fuzz
