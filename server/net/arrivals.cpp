/// SceneClient::Arrivals.
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "net/scene_client.h"

namespace weft::net {
namespace {

/// A frame is late that took so much longer than the one before.
constexpr std::uint32_t kLateMs = 100;

/// This side's clock as FrameStamp::server_ms is the server's.
std::uint32_t now_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

}  // namespace

bool SceneClient::Arrivals::late(std::uint32_t server_ms) const {
  // Both clocks wrap: the difference is the shorter way round.
  const auto later = static_cast<std::int32_t>(now_ms() - server_ms - usual_);
  return last_ && later > std::max<std::int64_t>(kLateMs, 2 * std::int64_t{pace_});
}

void SceneClient::Arrivals::taken(std::uint32_t server_ms) {
  const std::uint32_t now = now_ms();
  if (last_) pace_ = now - *last_;
  last_ = now;
  usual_ = now - server_ms;
}

}  // namespace weft::net
