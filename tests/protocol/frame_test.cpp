// Frames against the shared vectors: what they decode to, what is refused and why, and that encoding gives
// their bytes.
#include "protocol/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "protocol/rice_codec.h"
#include "vectors.h"

namespace weft::protocol {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::from_hex;
using test::load;

const json& frames() {
  static const json loaded = load("protocol/vectors/frames.json");
  return loaded;
}

FrameStamp stamp_of(const json& expect) {
  return {expect["f"], expect["epoch"], expect["time"], expect["server_ms"], expect["flags"]};
}

TEST(Frame, GoodVectorsDecodeToTheirValues) {
  for (const json& vector : frames()["good"]) {
    SCOPED_TRACE(vector["name"].get<std::string>());
    const json& expect = vector["expect"];
    Frame frame;
    std::string error;
    ASSERT_TRUE(decode_frame(from_hex(vector["hex"]), frame, error)) << error;

    const FrameStamp stamp = stamp_of(expect);
    EXPECT_EQ(frame.stamp.frame, stamp.frame);
    EXPECT_EQ(frame.stamp.epoch, stamp.epoch);
    EXPECT_EQ(frame.stamp.time, stamp.time);
    EXPECT_EQ(frame.stamp.server_ms, stamp.server_ms);
    EXPECT_EQ(frame.stamp.flags, stamp.flags);

    ASSERT_EQ(frame.cloths.size(), expect["cloths"].size());
    for (std::size_t i = 0; i < frame.cloths.size(); ++i) {
      const ClothRecord& cloth = frame.cloths[i];
      const json& wanted = expect["cloths"][i];
      EXPECT_EQ(cloth.cloth, wanted["cloth"]);
      EXPECT_EQ(cloth.level, wanted["level"]);
      EXPECT_EQ(cloth.simulated_level, wanted["simulated_level"]);
      EXPECT_EQ(cloth.rows, wanted["rows"]);
      EXPECT_EQ(cloth.cols, wanted["cols"]);
      EXPECT_EQ(cloth.quantisation.bits, wanted["bits"]);
      EXPECT_EQ(cloth.quantisation.quantum, wanted["quantum"].get<float>());
      EXPECT_EQ(cloth.quantisation.origin, (wanted["origin"].get<std::array<float, 3>>()));
      EXPECT_EQ(bytes_of(cloth.positions), from_hex(wanted["positions_f32"]));
      EXPECT_EQ(cloth.torn_faces, wanted["torn"].get<std::vector<std::uint32_t>>());
    }

    ASSERT_EQ(frame.balls.size(), expect["balls"].size());
    for (std::size_t i = 0; i < frame.balls.size(); ++i) {
      const json& wanted = expect["balls"][i];
      const FrameBall ball{wanted["ball"], wanted["position"].get<std::array<float, 3>>(), wanted["radius"],
                           wanted["motion"] == "dynamic"};
      EXPECT_EQ(frame.balls[i], ball);
    }

    ASSERT_EQ(frame.obstacles.size(), expect["obstacles"].size());
    for (std::size_t i = 0; i < frame.obstacles.size(); ++i) {
      const json& wanted = expect["obstacles"][i];
      const FrameObstacle obstacle{wanted["obstacle"], wanted["position"].get<std::array<float, 3>>(),
                                   wanted["quaternion"].get<std::array<float, 4>>()};
      EXPECT_EQ(frame.obstacles[i], obstacle);
    }
  }
}

TEST(Frame, BadVectorsAreRefusedWithTheirReason) {
  for (const json& vector : frames()["bad"]) {
    SCOPED_TRACE(vector["name"].get<std::string>());
    Frame frame;
    std::string error;
    EXPECT_FALSE(decode_frame(from_hex(vector["hex"]), frame, error));
    EXPECT_EQ(error, vector["error"].get<std::string>());
  }
}

// The script that writes the vectors is itself held to a frame computed by hand.
TEST(Frame, VectorComputedByHand) {
  const json hand = load("tests/protocol/hand_frame.json");
  std::string hex;
  for (const char* part : {"header", "payload"}) {
    for (const std::string line : hand[part]) hex += line;
  }
  std::erase(hex, ' ');
  EXPECT_EQ(frames()["good"][0]["name"], "small");
  EXPECT_EQ(frames()["good"][0]["hex"], hex);

  const std::array<float, 4> x{0, 1, 0, 1}, y{1, 1, 0, 0}, z{0, 0, 0, 255};
  const GridView grid{{x.data(), y.data(), z.data()}, 2, 2, 2, 1};
  auto record = encode_cloth_record({120, 1, 2.0, 4115200, 0}, 0, 5, 6, 8, grid);
  mark_last(record, 0);
  EXPECT_EQ(record, from_hex(hex));
}

// Each vector's first cloth, encoded again from its positions (those that are exact in f32), gives the
// vector's payload.
TEST(Frame, EncodingGivesTheVectorsBytes) {
  int whole_records = 0;
  for (const json& vector : frames()["good"]) {
    const json& expect = vector["expect"];
    if (expect["cloths"].size() != 1 || vector["name"] == "far" || vector["name"] == "wide_groups") continue;
    SCOPED_TRACE(vector["name"].get<std::string>());
    const json& cloth = expect["cloths"][0];
    const Quantisation lattice{cloth["bits"], cloth["origin"].get<std::array<float, 3>>(), cloth["quantum"]};
    std::array<std::vector<float>, 3> axes;
    for (int axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t q : cloth["q"][static_cast<std::size_t>(axis)])
        axes[static_cast<std::size_t>(axis)].push_back(static_cast<float>(lattice.decode(axis, q)));
    }
    const int rows = cloth["rows"], cols = cloth["cols"];
    const GridView grid{{axes[0].data(), axes[1].data(), axes[2].data()}, rows, cols, cols, 1};

    const auto bytes = from_hex(vector["hex"]);
    const bool rice = bytes[10] == 4;  // the header's codec
    std::vector<std::uint8_t> payload;
    (rice ? encode_rice_grid : encode_grid)(grid, lattice, payload);
    const auto found = std::search(bytes.begin(), bytes.end(), payload.begin(), payload.end());
    EXPECT_NE(found, bytes.end()) << "payload differs";

    if (cloth["finest"] && bytes.size() == kHeaderBytes + payload.size() && stamp_of(expect).flags == 0) {
      ++whole_records;
      auto record = encode_cloth_record(stamp_of(expect), cloth["cloth"], cloth["level"],
                                        cloth["simulated_level"], cloth["bits"], grid, kMinQuantumExponent,
                                        rice ? GridCoding::rice : GridCoding::plain);
      mark_last(record, 0);
      EXPECT_EQ(record, bytes);
    }
  }
  EXPECT_GE(whole_records, 6);
}

TEST(Frame, TearsRecordGivesTheVectorsBytes) {
  int records = 0;
  for (const json& vector : frames()["good"]) {
    const json& cloth = vector["expect"]["cloths"].empty() ? json() : vector["expect"]["cloths"][0];
    if (cloth.is_null() || cloth["torn"].empty() || vector["name"] == "torn_wide") continue;
    const auto bytes = from_hex(vector["hex"]);
    auto record = encode_tears_record(stamp_of(vector["expect"]), cloth["cloth"], cloth["level"],
                                      cloth["simulated_level"], cloth["rows"], cloth["cols"],
                                      cloth["torn"].get<std::vector<std::uint32_t>>());
    if (vector["expect"]["cloths"].size() == 1) mark_last(record, 0);
    const auto found = std::search(bytes.begin(), bytes.end(), record.begin(), record.end());
    EXPECT_NE(found, bytes.end()) << vector["name"];
    ++records;
  }
  EXPECT_EQ(records, 2);
}

TEST(Frame, BallsRecordGivesTheVectorsBytes) {
  for (const json& vector : frames()["good"]) {
    if (vector["name"] != "balls_only" && vector["name"] != "no_balls") continue;
    Frame frame;
    std::string error;
    ASSERT_TRUE(decode_frame(from_hex(vector["hex"]), frame, error)) << error;
    auto record = encode_balls_record(frame.stamp, frame.balls);
    mark_last(record, 0);
    EXPECT_EQ(record, from_hex(vector["hex"]));
  }
}

TEST(Frame, ObstaclesRecordGivesTheVectorsBytes) {
  const auto vector = std::find_if(frames()["good"].begin(), frames()["good"].end(),
                                   [](const json& each) { return each["name"] == "obstacles_only"; });
  ASSERT_NE(vector, frames()["good"].end());
  Frame frame;
  std::string error;
  ASSERT_TRUE(decode_frame(from_hex((*vector)["hex"]), frame, error)) << error;
  auto record = encode_obstacles_record(frame.stamp, frame.obstacles);
  mark_last(record, 0);
  EXPECT_EQ(record, from_hex((*vector)["hex"]));
}

TEST(Frame, EveryBeginningOfAMessageIsRefused) {
  for (const json& vector : frames()["good"]) {
    SCOPED_TRACE(vector["name"].get<std::string>());
    const auto bytes = from_hex(vector["hex"]);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      // A copy of its own, so that the address sanitizer sees a byte read too far.
      const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      Frame frame;
      std::string error;
      ASSERT_FALSE(decode_frame(cut, frame, error)) << size << " bytes";
      ASSERT_FALSE(error.empty());
    }
  }
}

// Whatever a mutation makes of a message, decoding ends with an answer, and what is accepted is within
// bounds.
TEST(Frame, MutatedMessagesNeverBreakTheDecoder) {
  constexpr int kMutations = 2000;
  std::mt19937 random(20260101);
  const auto below = [&](std::size_t end) { return random() % end; };
  int accepted = 0, refused = 0;
  for (const json& vector : frames()["good"]) {
    SCOPED_TRACE(vector["name"].get<std::string>());
    const auto original = from_hex(vector["hex"]);
    for (int i = 0; i < kMutations; ++i) {
      auto bytes = original;
      for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
        // Half of them in the first header, where the decisions are taken.
        const std::size_t at = below(below(2) == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size());
        switch (below(4)) {
          case 0:
            bytes[at] = static_cast<std::uint8_t>(random());
            break;
          case 1:
            bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1U << below(8));
            break;
          case 2:
            bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
            break;
          default:
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                         static_cast<std::uint8_t>(random()));
        }
        if (bytes.empty()) break;
      }
      bytes.shrink_to_fit();
      Frame frame;
      std::string error;
      if (decode_frame(bytes, frame, error)) {
        ++accepted;
        for (const ClothRecord& cloth : frame.cloths) {
          ASSERT_EQ(cloth.positions.size(), static_cast<std::size_t>(cloth.rows * cloth.cols * 3));
          for (const float value : cloth.positions) ASSERT_TRUE(std::isfinite(value));
        }
      } else {
        ++refused;
        ASSERT_FALSE(error.empty());
      }
    }
  }
  // Both happen: a changed counter is still a frame, a changed length is not.
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace weft::protocol
