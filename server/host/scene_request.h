#pragma once
#include <cstdint>
#include <optional>

#include "protocol/message.h"

namespace weft::host {

using protocol::SceneCommand;

struct SceneRequest {
  std::optional<std::int64_t> id;
  SceneCommand command;
};

}  // namespace weft::host
