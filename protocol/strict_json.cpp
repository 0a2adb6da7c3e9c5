#include "protocol/strict_json.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace weft::protocol {
namespace {

using nlohmann::json;

/// Builds the tree as the parser reads, and stops it at the first fault (a handler that returns false ends
/// the parse).
class Builder : public nlohmann::json_sax<json> {
 public:
  Builder(StrictJson& result, int max_depth) : result_(result), max_depth_(max_depth) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // no such thing in JSON text

  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.key = std::move(name);
    if (!level.container->contains(level.key)) return true;
    const std::string path = here();
    return fail({"bad_json", path, path + " is given twice"});
  }

  bool parse_error(std::size_t position, const std::string& token, const json::exception& why) override {
    constexpr int kNumberOverflow = 406;
    if (why.id == kNumberOverflow) {
      const std::string path = here();
      return fail({"range", path, path + " is " + token.substr(0, 40) + "; allowed: finite numbers"});
    }
    return fail({"bad_json", "", "not JSON, seen at byte " + std::to_string(position)});
  }

 private:
  struct Level {
    json* container;
    std::string key;  ///< the member being read, in an object
  };

  bool fail(JsonFault fault) {
    result_.fault = std::move(fault);
    return false;
  }

  /// Pointer to the value being read.
  std::string here() const {
    std::string path;
    for (const Level& level : levels_) {
      // An open child is in its array already; the value being read is not yet.
      const std::size_t in_array = level.container->size() - (&level == &levels_.back() ? 0 : 1);
      path = pointer_to(path, level.container->is_array() ? std::to_string(in_array) : level.key);
    }
    return path;
  }

  /// Puts a value where the text has it. Its address lasts: a parent gets no further member before its child
  /// is closed.
  json* place(json value) {
    if (levels_.empty()) return &(result_.tree = std::move(value));
    Level& level = levels_.back();
    if (level.container->is_array()) {
      level.container->push_back(std::move(value));
      return &level.container->back();
    }
    if (levels_.size() == 1 && level.key == "id") result_.id = request_id(value);
    return &((*level.container)[level.key] = std::move(value));
  }

  bool add(json value) {
    place(std::move(value));
    return true;
  }

  bool open(json container) {
    if (levels_.size() == static_cast<std::size_t>(max_depth_))
      return fail({"bad_json", here(), "nested deeper than " + std::to_string(max_depth_) + " levels"});
    levels_.push_back({place(std::move(container)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  StrictJson& result_;
  int max_depth_;
  std::vector<Level> levels_;
};

}  // namespace

std::optional<std::int64_t> request_id(const json& value) {
  if (!value.is_number()) return {};
  const double number = value.get<double>();
  if (number != std::floor(number) || number < 1 || number > std::numeric_limits<std::int32_t>::max())
    return {};
  return static_cast<std::int64_t>(number);
}

std::string pointer_to(const std::string& path, std::string_view name) {
  std::string pointer = path + '/';
  for (const char c : name) {
    if (c == '~')
      pointer += "~0";
    else if (c == '/')
      pointer += "~1";
    else
      pointer += c;
  }
  return pointer;
}

StrictJson read_strictly(std::string_view text, int max_depth) {
  StrictJson result;
  Builder builder(result, max_depth);
  json::sax_parse(text, &builder);
  return result;
}

}  // namespace weft::protocol
