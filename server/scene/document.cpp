#include "scene/document.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <utility>

namespace weft::scene {
namespace {

using nlohmann::json;

/// Numbers beyond a double's range that one file may have before reading gives up: each costs another pass.
constexpr std::size_t kMaxOverflows = 20;

/// Builds the tree from the parser's events, since the parser's own tree drops duplicate keys silently and
/// has no limit on depth.
class TreeBuilder final : public nlohmann::json_sax<json> {
 public:
  json take_tree() { return std::move(root_); }
  std::vector<Problem> take_problems() { return std::move(problems_); }
  bool stopped_by_overflow() const { return overflow_; }
  std::size_t stopped_at() const { return position_; }
  const std::string& literal() const { return literal_; }

  /// JSON pointer of the value the parser is at.
  std::string path() const {
    std::string text;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const bool innermost = i + 1 == open_.size();
      if (open_[i].value->is_object()) {
        text += pointer_token(open_[i].key);
      } else {  // an inner container is in its array already, a value being read is not
        text += pointer_token(std::to_string(open_[i].value->size() - (innermost ? 0 : 1)));
      }
    }
    return text;
  }

  bool null() override { return place(nullptr) != nullptr; }
  bool boolean(bool value) override { return place(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return place(value) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return place(value) != nullptr; }
  bool number_float(number_float_t value, const string_t&) override { return place(value) != nullptr; }
  bool string(string_t& value) override { return place(std::move(value)) != nullptr; }
  bool binary(binary_t&) override { return false; }  // not part of JSON text
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    open_.back().key = name;
    if (open_.back().value->contains(name))
      problems_.push_back({path(), "the key appears twice in its object"});
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token, const json::exception& error) override {
    constexpr int kNumberOverflow = 406;  // the parser's number for "number overflow"
    overflow_ = error.id == kNumberOverflow;
    position_ = position;
    literal_ = token;
    if (!overflow_) problems_ = {{"", "not JSON: " + without_prefix(error.what())}};
    return false;
  }

 private:
  struct Open {
    json* value;
    std::string key;
  };

  json* place(json value) {
    if (open_.empty()) return &(root_ = std::move(value));
    Open& parent = open_.back();
    if (parent.value->is_array()) {
      parent.value->push_back(std::move(value));
      return &parent.value->back();
    }
    return &((*parent.value)[parent.key] = std::move(value));
  }
  bool open(json value) {
    if (open_.size() == kMaxDepth) {
      problems_ = {{path(), "nested deeper than " + std::to_string(kMaxDepth) + " levels"}};
      return false;
    }
    open_.push_back({place(std::move(value)), {}});
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  /// The parser's text without its own name and number: it goes on with line and column. It quotes the file,
  /// which may hold any bytes; a message is plain text.
  static std::string without_prefix(std::string_view what) {
    constexpr std::string_view kPrefix = "parse error at ";
    const std::size_t at = what.find(kPrefix);
    std::string text(at == std::string_view::npos ? what : what.substr(at + kPrefix.size()));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
  }

  json root_;
  std::vector<Open> open_;  ///< the containers around the value being read
  std::vector<Problem> problems_;
  bool overflow_ = false;
  std::size_t position_ = 0;  ///< bytes read when the parser stopped
  std::string literal_;       ///< what it had just read
};

}  // namespace

std::optional<std::string> read_text_file(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::array<char, 65536> chunk{};
  do {
    file.read(chunk.data(), chunk.size());
    text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  } while (file && text.size() <= kMaxTextBytes);
  if (!file && !file.eof()) return std::nullopt;
  return text;
}

std::string pointer_token(std::string_view token) {
  std::string text = "/";
  for (const char c : token) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

Document read_document(std::string_view text) {
  Document document;
  if (text.size() > kMaxTextBytes) {
    document.problems = {{"", "the text has " + std::to_string(text.size()) + " bytes; at most " +
                                  std::to_string(kMaxTextBytes) + " are allowed"}};
    return document;
  }
  std::string copy(text);
  while (true) {
    TreeBuilder builder;
    document.readable = json::sax_parse(copy, &builder);
    if (!builder.stopped_by_overflow()) {
      document.tree = builder.take_tree();
      document.problems = builder.take_problems();
      return document;
    }
    // The parser stops at 1e999. A null of the same length takes its place, so that the rest can be read as
    // well.
    const std::string& literal = builder.literal();
    document.overflows[builder.path()] = literal;
    if (document.overflows.size() > kMaxOverflows) {
      document.problems = {
          {builder.path(), "is " + literal + ", one of too many numbers that are not finite"}};
      return document;
    }
    std::string replacement = "null";
    replacement.resize(literal.size(), ' ');
    copy.replace(builder.stopped_at() - literal.size(), literal.size(), replacement);
  }
}

}  // namespace weft::scene
