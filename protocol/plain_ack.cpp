#include "protocol/plain_ack.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>

namespace weft::protocol {
namespace {

/// Takes the word off the front of the text, with spaces before it; false if it does not stand there.
bool skip(std::string_view& text, std::string_view word) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

}  // namespace

std::optional<std::uint32_t> read_plain_ack(std::string_view text) {
  for (const std::string_view word : {"{", "\"op\"", ":", "\"ack\"", ",", "\"f\"", ":"}) {
    if (!skip(text, word)) return std::nullopt;
  }
  skip(text, "");
  std::uint32_t frame = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  // JSON has no number with a zero before others.
  if (error != std::errc() || (text.front() == '0' && end != text.data() + 1)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (!skip(text, "}")) return std::nullopt;
  skip(text, "");
  return text.empty() ? std::optional(frame) : std::nullopt;
}

}  // namespace weft::protocol
