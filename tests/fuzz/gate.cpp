#include "net/frame_gate.h"

#include <algorithm>
#include <string>
#include <utility>

#include "targets.h"

namespace weft::fuzz {
namespace {

constexpr int kFramesPerSecond = 5;

/// What the gate hands on of `bytes` that come in pieces of at most `piece`, when short texts are shown to
/// `take`.
std::string through(std::string_view bytes, std::size_t piece, net::FrameGate::Take take = {}) {
  constexpr net::FrameGate::TimePoint kNow{};
  net::FrameGate gate(kFramesPerSecond, kNow);
  gate.show_texts_to(std::move(take));
  std::string handed_on;
  while (!bytes.empty() && !gate.shut()) {
    const std::span<char> room = gate.room();
    require(!room.empty(), "there is always room");
    const std::size_t count = std::min({piece, room.size(), bytes.size()});
    std::copy_n(bytes.begin(), count, room.begin());
    bytes.remove_prefix(count);
    gate.received(count, kNow);
    handed_on += gate.ready();
    gate.taken(gate.ready().size());
  }
  return handed_on;
}

}  // namespace

// However the bytes come, the same is handed on: what came, up to a close in place of what breaks the rules.
void gate(Input input) {
  constexpr std::size_t kCloseBytes = 8;
  const std::string bytes = text_of(input);
  const std::string whole = through(bytes, bytes.size());
  for (const std::size_t piece : {1U, 3U, 17U})
    require(through(bytes, piece) == whole, "pieces make no difference");
  require(through(bytes, bytes.size(), [](std::string_view) { return false; }) == whole,
          "what is looked at and not taken goes on as it came");
  std::size_t taken = 0;
  const std::string left = through(bytes, bytes.size(), [&](std::string_view text) {
    constexpr std::size_t kShort = 125, kHead = 6;
    require(text.size() <= kShort, "only what is short is shown");
    taken += text.size() + kHead;
    return true;
  });
  require(left.size() + taken <= bytes.size() + kCloseBytes, "what is taken is not handed on");
  const auto [from, in] = std::mismatch(whole.begin(), whole.end(), bytes.begin(), bytes.end());
  require(from == whole.end() || whole.end() - from <= static_cast<std::ptrdiff_t>(kCloseBytes),
          "what is handed on has come");
}

}  // namespace weft::fuzz
