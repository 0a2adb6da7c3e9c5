#include "cli/toml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace weft::cli {
namespace {

constexpr std::string_view kBlanks = " \t\r", kEndsOfWord = " \t\r\n,[]#=\"'";
/// What follows a backslash, and what it stands for.
constexpr std::array<std::pair<char, char>, 7> kEscapes{
    {{'b', '\b'}, {'t', '\t'}, {'n', '\n'}, {'f', '\f'}, {'r', '\r'}, {'"', '"'}, {'\\', '\\'}}};

bool is_control(char c) { return (c >= 0 && c < ' ' && c != '\t') || c == '\x7f'; }

void append_utf8(std::string& text, std::uint32_t code) {
  const auto byte = [&](std::uint32_t value) { text += static_cast<char>(value); };
  const auto tail = [&](int shift) { byte(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xc0 | code >> 6);
  } else {
    if (code < 0x10000) {
      byte(0xe0 | code >> 12);
    } else {
      byte(0xf0 | code >> 18);
      tail(12);
    }
    tail(6);
  }
  tail(0);
}

class Reader {
 public:
  explicit Reader(std::string_view text) : left_(text) {}

  std::vector<TomlEntry> read() {
    std::vector<TomlEntry> entries;
    for (skip_lines(); !left_.empty(); skip_lines()) {
      if (next() == '[') refuse_table();
      TomlEntry entry{word("a name"), {}};
      skip_blanks();
      if (!take('=')) refuse(entry.name + " must be followed by = and a value");
      skip_blanks();
      if (take('[')) {
        entry.values = array();
      } else {
        entry.values.push_back(word("a value"));
      }
      skip_blanks();
      if (!left_.empty() && next() != '#' && next() != '\n')
        refuse("after the value of " + entry.name + " only a comment is allowed");
      entries.push_back(std::move(entry));
    }
    return entries;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument("line " + std::to_string(line_) + ": " + what);
  }
  [[noreturn]] void refuse_table() const {
    std::string_view header = left_.substr(0, left_.find('\n'));
    header = header.substr(0, header.find_last_of(']') + 1);
    refuse(std::string(header) + " is unknown; allowed: options, without tables");
  }

  /// Only if something is left.
  char next() const { return left_.front(); }
  bool take(char c) {
    if (!left_.starts_with(c)) return false;
    left_.remove_prefix(1);
    return true;
  }
  void skip_blanks() { left_.remove_prefix(std::min(left_.find_first_not_of(kBlanks), left_.size())); }
  /// To what is neither blank nor a comment, in this line or a later one.
  void skip_lines() {
    for (skip_blanks(); left_.starts_with('\n') || left_.starts_with('#'); skip_blanks()) {
      if (next() == '#') left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
      if (take('\n')) ++line_;
    }
  }

  /// Behind its bracket.
  std::vector<std::string> array() {
    std::vector<std::string> values;
    for (skip_lines(); !take(']'); skip_lines()) {
      values.push_back(word("a value or ]"));
      skip_lines();
      if (!take(',') && !left_.starts_with(']')) refuse("values of an array must be separated by commas");
    }
    return values;
  }

  std::string word(const char* wanted) {
    if (take('"')) return quoted();
    if (take('\'')) return literal();
    const std::string_view bare = left_.substr(0, left_.find_first_of(kEndsOfWord));
    if (bare.empty()) refuse(std::string(wanted) + " is missing");
    if (std::any_of(bare.begin(), bare.end(), is_control)) refuse_control();
    left_.remove_prefix(bare.size());
    return std::string(bare);
  }

  [[noreturn]] void refuse_control() const { refuse("control characters are allowed as escapes alone"); }

  char in_string() {
    if (left_.empty() || next() == '\n') refuse("a string must end in the line in which it begins");
    if (is_control(next())) refuse_control();
    const char c = next();
    left_.remove_prefix(1);
    return c;
  }

  std::string literal() {
    std::string text;
    for (char c = in_string(); c != '\''; c = in_string()) text += c;
    return text;
  }

  std::string quoted() {
    std::string text;
    for (char c = in_string(); c != '"'; c = in_string()) {
      if (c == '\\') {
        append_escaped(text);
      } else {
        text += c;
      }
    }
    return text;
  }

  void append_escaped(std::string& text) {
    const char name = in_string();
    if (name == 'u' || name == 'U') return append_utf8(text, code_point(name == 'u' ? 4 : 8));
    const auto* const escape = std::find_if(kEscapes.begin(), kEscapes.end(),
                                            [&](const auto& known) { return known.first == name; });
    if (escape == kEscapes.end())
      refuse(std::string("\\") + name + R"( is unknown; allowed: \b \t \n \f \r \" \\ \uXXXX \UXXXXXXXX)");
    text += escape->second;
  }

  std::uint32_t code_point(std::size_t digits) {
    const std::string_view hex = left_.substr(0, digits);
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    if (hex.size() < digits || error != std::errc() || end != hex.data() + digits || surrogate ||
        code > 0x10ffff)
      refuse("\\u and \\U must be followed by 4 and 8 hexadecimal digits of a character");
    left_.remove_prefix(digits);
    return code;
  }

  std::string_view left_;
  int line_ = 1;
};

}  // namespace

std::vector<TomlEntry> read_toml(std::string_view text) { return Reader(text).read(); }

std::string toml_string(std::string_view value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (is_control(c)) {
      text.append("\\u00") += kDigits[static_cast<std::size_t>(c) / 16];
      text += kDigits[static_cast<std::size_t>(c) % 16];
    } else {
      text += c;
    }
  }
  return text + '"';
}

}  // namespace weft::cli
