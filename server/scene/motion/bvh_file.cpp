#include "scene/motion/bvh_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "scene/object.h"

namespace weft::scene {
namespace {

constexpr std::string_view kBvhBlanks = " \t\r\n\v\f";

/// The text's words, and the line that the last one was in.
class BvhWords {
 public:
  explicit BvhWords(std::string_view text) : text_(text) {}

  /// Empty at the text's end.
  std::string_view next() {
    skip_blanks();
    const std::size_t end = std::min(text_.find_first_of(kBvhBlanks), text_.size());
    const std::string_view word = text_.substr(0, end);
    text_.remove_prefix(end);
    return word;
  }
  /// What the line has left, but for a brace at its end, which is read next.
  std::string_view rest_of_line() {
    const std::size_t end = std::min(text_.find_first_of("\r\n{"), text_.size());
    std::string_view rest = text_.substr(0, end);
    text_.remove_prefix(end);
    const std::size_t first = rest.find_first_not_of(kBvhBlanks);
    if (first == rest.npos) return {};
    return rest.substr(first, rest.find_last_not_of(kBvhBlanks) - first + 1);
  }
  void expect(std::string_view word) {
    if (const std::string_view found = next(); found != word) refuse(found, quoted_list({word}));
  }
  double number(double least, double most, const std::string& what) { return read(least, most, what); }
  std::size_t count(std::size_t least, std::size_t most, const std::string& what) {
    return read(least, most, what + " from " + std::to_string(least) + " to " + std::to_string(most));
  }
  [[noreturn]] void refuse(std::string_view found, const std::string& expected) const {
    std::string shown(found.substr(0, 40));
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    fail(found.empty() ? "ends in" : "has " + quoted_list({shown}) + " in", "; must be " + expected);
  }
  [[noreturn]] void fail(const std::string& before, const std::string& after) const {
    throw std::invalid_argument(before + " line " + std::to_string(line_) + after);
  }

 private:
  template <class Number>
  Number read(Number least, Number most, const std::string& what) {
    const std::string_view word = next();
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = error == std::errc() && end == word.data() + word.size();
    if (!whole || !(value >= least && value <= most)) refuse(word, what);
    return value;
  }
  void skip_blanks() {
    const std::size_t first = std::min(text_.find_first_not_of(kBvhBlanks), text_.size());
    line_ += static_cast<std::size_t>(std::count(text_.begin(), text_.begin() + first, '\n'));
    text_.remove_prefix(first);
  }

  std::string_view text_;
  std::size_t line_ = 1;
};

/// What the numbers of a frame say, in their order.
struct BvhChannel {
  std::size_t node;
  bool turns;  ///< else it is a position
  int axis;    ///< 0, 1, 2: x, y, z
};

constexpr double kBvhFarthest = 1e9;  // of a number in the file, whatever its unit

Vec3 read_offset(BvhWords& words) {
  Vec3 offset(0, 0, 0);
  for (double& component : offset)
    component = words.number(-kBvhFarthest, kBvhFarthest, "a number from -1e9 to 1e9");
  return offset;
}

BvhChannel read_channel(BvhWords& words, std::size_t node) {
  static constexpr std::array<std::string_view, 6> kNames = {"Xposition", "Yposition", "Zposition",
                                                             "Xrotation", "Yrotation", "Zrotation"};
  const std::string_view word = words.next();
  const auto* const found = std::find(kNames.begin(), kNames.end(), word);
  if (found == kNames.end())
    words.refuse(word, "a channel: Xposition, Yposition, Zposition, Xrotation, Yrotation or Zrotation");
  const auto index = static_cast<int>(found - kNames.begin());
  return {node, index >= 3, index % 3};
}

/// The joints as they are nested, until the word that ends them.
void read_hierarchy(BvhWords& words, Skeleton& skeleton, std::vector<BvhChannel>& channels) {
  int open = -1;          // the joint whose braces are open
  bool in_end = false;    // within an End Site's
  std::vector<int> ends;  // of each node, how many it has
  const auto begin_node = [&](std::string name, bool end) {
    if (skeleton.nodes.size() == kMaxSkeletonNodes)
      words.fail("has in",
                 " a joint too many; at most " + std::to_string(kMaxSkeletonNodes) + " are allowed");
    words.expect("{");
    words.expect("OFFSET");
    Skeleton::Node& node = skeleton.nodes.emplace_back();
    node.name = std::move(name);
    node.parent = open;
    node.translation = read_offset(words);
    node.end = end;
    ends.push_back(0);
  };
  const auto begin_joint = [&] {
    const std::string_view name = words.rest_of_line();
    if (name.empty() || name.size() > kMaxNodeName)
      words.refuse(name, "a joint's name of at most " + std::to_string(kMaxNodeName) + " characters");
    begin_node(std::string(name), false);
    open = static_cast<int>(skeleton.nodes.size()) - 1;
  };
  for (std::string_view word = words.next(); word != "MOTION" || open >= 0; word = words.next()) {
    if (in_end) {
      if (word != "}") words.refuse(word, "\"}\"");
      in_end = false;
    } else if (open < 0) {
      if (word != "ROOT") words.refuse(word, skeleton.nodes.empty() ? "\"ROOT\"" : "\"ROOT\" or \"MOTION\"");
      begin_joint();
    } else if (word == "JOINT") {
      begin_joint();
    } else if (word == "End") {
      words.expect("Site");
      const auto joint = static_cast<std::size_t>(open);
      const int number = ++ends[joint];
      begin_node(skeleton.nodes[joint].name + "_end" + (number > 1 ? "_" + std::to_string(number) : ""),
                 true);
      in_end = true;
    } else if (word == "CHANNELS") {
      const bool again = std::any_of(channels.begin(), channels.end(), [&](const BvhChannel& channel) {
        return channel.node == static_cast<std::size_t>(open);
      });
      if (again) words.fail("has CHANNELS again in", "; a joint has them once");
      const std::size_t count = words.count(0, 6, "a number of channels");
      for (std::size_t i = 0; i < count; ++i)
        channels.push_back(read_channel(words, static_cast<std::size_t>(open)));
    } else if (word == "}") {
      open = skeleton.nodes[static_cast<std::size_t>(open)].parent;
    } else {
      words.refuse(word, "\"CHANNELS\", \"JOINT\", \"End Site\" or \"}\"");
    }
  }
  if (skeleton.nodes.empty()) words.fail("has no joint before", "; must begin with ROOT");
}

/// A frame's numbers, to the nodes' tracks.
void read_frame(BvhWords& words, const Skeleton& skeleton, const std::vector<BvhChannel>& channels,
                Skeleton::Clip& clip) {
  for (std::size_t i = 0; i < channels.size();) {
    const std::size_t node = channels[i].node;
    std::optional<Vec3> place;  // the axes without a channel stay
    std::optional<Quaternion> turn;
    for (; i < channels.size() && channels[i].node == node; ++i) {
      const double number = words.number(-kBvhFarthest, kBvhFarthest, "a number from -1e9 to 1e9");
      if (!channels[i].turns) {
        if (!place) place = skeleton.nodes[node].translation;
        (*place)[channels[i].axis] = number;
        continue;
      }
      const Eigen::AngleAxisd about(number * std::numbers::pi / 180, Vec3::Unit(channels[i].axis));
      turn = turn.value_or(Quaternion::Identity()) * about;
    }
    if (place) clip.nodes[node].translation.values.push_back(*place);
    if (turn) clip.nodes[node].rotation.values.push_back(*turn);
  }
}

}  // namespace

Skeleton parse_bvh(std::string_view text) {
  BvhWords words(text);
  Skeleton skeleton;
  std::vector<BvhChannel> channels;
  words.expect("HIERARCHY");
  read_hierarchy(words, skeleton, channels);
  check_depth(skeleton);
  words.expect("Frames:");
  const std::size_t frames = words.count(1, kMaxBvhNumbers, "a number of frames");
  if (frames * channels.size() > kMaxBvhNumbers)
    words.fail(
        "has " + std::to_string(frames) + " frames of " + std::to_string(channels.size()) + " channels by",
        "; at most " + std::to_string(kMaxBvhNumbers) + " numbers are allowed");
  words.expect("Frame");
  words.expect("Time:");
  Skeleton::Clip& clip = skeleton.clips.emplace_back();
  clip.interval = words.number(1e-4, 10, "a time from 0.0001 to 10 s");
  clip.duration = clip.interval * static_cast<double>(frames - 1);
  clip.nodes.resize(skeleton.nodes.size());
  for (std::size_t frame = 0; frame < frames; ++frame) read_frame(words, skeleton, channels, clip);
  if (const std::string_view more = words.next(); !more.empty())
    words.refuse(more, "the end: all " + std::to_string(frames) + " frames are before it");
  const auto set_times = [&](auto& track) {
    for (std::size_t i = 0; i < track.values.size(); ++i)
      track.times.push_back(clip.interval * static_cast<double>(i));
  };
  for (Skeleton::Motion& motion : clip.nodes) {
    set_times(motion.translation);
    set_times(motion.rotation);
  }
  return skeleton;
}

}  // namespace weft::scene
