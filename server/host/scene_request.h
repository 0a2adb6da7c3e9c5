#pragma once
#include <cstdint>
#include <optional>
#include <variant>

#include "protocol/message.h"

namespace weft::host {

/// The commands that are the scene's to carry out; the rest is answered by Connection.
using SceneCommand =
    std::variant<protocol::Camera, protocol::BallAdd, protocol::BallMove, protocol::BallThrow,
                 protocol::BallRemove, protocol::ObstacleMove, protocol::ObstacleThrow,
                 protocol::ObstacleGrab, protocol::ClothGrab, protocol::GrabMove, protocol::GrabRelease,
                 protocol::ClothPin, protocol::ClothUnpin, protocol::ClothTune, protocol::FrictionSet,
                 protocol::EffectSet, protocol::EffectTune, protocol::WindSet, protocol::WindZoneSet,
                 protocol::Quality, protocol::Cost, protocol::Pause, protocol::Resume, protocol::Reset,
                 protocol::Step>;

struct SceneRequest {
  std::optional<std::int64_t> id;
  SceneCommand command;
};

}  // namespace weft::host
