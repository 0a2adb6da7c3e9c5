#pragma once
#include <chrono>
#include <cstdint>

namespace weft::host {

/// The server's monotonic clock as frames and pongs have it: ms, the low 32 bits.
inline std::uint32_t server_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

}  // namespace weft::host
