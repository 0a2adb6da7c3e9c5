/// Frames as a client sends them (RFC 6455, section 5.2), through the gate before the WebSocket.
#include "net/frame_gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace weft::net {
namespace {

using namespace std::chrono_literals;

constexpr FrameGate::TimePoint kStart{};
constexpr int kFramesPerSecond = 5;

/// A frame with the mask 1, 2, 3, 4. `first` holds the final bit and the opcode.
std::string frame(unsigned first, std::string payload) {
  std::string bytes{static_cast<char>(first)};
  if (payload.size() < 126) {
    bytes += static_cast<char>(0x80 | payload.size());
  } else {
    bytes += {static_cast<char>(0x80 | 126), static_cast<char>(payload.size() >> 8),
              static_cast<char>(payload.size())};
  }
  bytes += "\1\2\3\4";
  for (std::size_t i = 0; i < payload.size(); ++i)
    payload[i] = static_cast<char>(payload[i] ^ static_cast<char>(1 + i % 4));
  return bytes + payload;
}
std::string text(const std::string& payload) { return frame(0x81, payload); }
std::string ping() { return frame(0x89, "x"); }
std::string closing(unsigned code) {
  return frame(0x88, {static_cast<char>(code >> 8), static_cast<char>(code)});
}

/// What the gate puts in a bad frame's place.
std::string substitute(unsigned code) {
  return std::string("\x88\x82\0\0\0\0", 6) + static_cast<char>(code >> 8) + static_cast<char>(code);
}

/// What the gate hands on of `bytes` that come in pieces of at most `piece`.
std::string through(FrameGate& gate, std::string_view bytes, std::size_t piece,
                    FrameGate::TimePoint now = kStart) {
  std::string handed_on;
  while (!bytes.empty() && !gate.shut()) {
    const std::span<char> room = gate.room();
    const std::size_t count = std::min({piece, room.size(), bytes.size()});
    std::copy_n(bytes.begin(), count, room.begin());
    bytes.remove_prefix(count);
    gate.received(count, now);
    handed_on += gate.ready();
    gate.taken(gate.ready().size());
  }
  return handed_on;
}

TEST(FrameGate, HandsOnWhatIsWithinTheRules) {
  const std::string bytes = text("{}") + ping() + text(std::string(3000, 'a')) + frame(0x01, "b") +
                            frame(0x80, "c") + text("") + closing(1000);
  for (const std::size_t piece : {1U, 2U, 3U, 7U, 500U, 100000U}) {
    FrameGate gate(kFramesPerSecond, kStart);
    EXPECT_EQ(through(gate, bytes, piece), bytes) << piece;
    EXPECT_FALSE(gate.shut());
  }
}

/// Shows short texts to a listener who takes those that begin with "ack".
struct Listener {
  std::vector<std::string> heard;
  explicit Listener(FrameGate& gate) {
    gate.show_texts_to([this](std::string_view said) {
      heard.emplace_back(said);
      return said.starts_with("ack");
    });
  }
};

TEST(FrameGate, WhatIsTakenAsideIsNotHandedOn) {
  FrameGate gate(kFramesPerSecond, kStart);
  Listener listener(gate);
  const std::string bytes = text("ack 1") + text("camera") + text("ack 2") + ping() + text("ack 3");
  EXPECT_EQ(through(gate, bytes, bytes.size()), text("camera") + ping());
  EXPECT_EQ(listener.heard, (std::vector<std::string>{"ack 1", "camera", "ack 2", "ack 3"}));
  // All of it handed on or taken: what comes next stands where it should.
  EXPECT_EQ(through(gate, text("next"), 100), text("next"));
}

TEST(FrameGate, OnlyAWholeShortMaskedTextIsTakenAside) {
  std::string unmasked = text("ack");
  unmasked[1] = 3;
  unmasked.erase(2, 4);
  for (const std::string& bytes :
       {frame(0x82, "ack"), frame(0x01, "ack") + frame(0x80, "ack"), frame(0x89, "ack"), unmasked,
        text("ack" + std::string(123, '.')), frame(0x01, "b") + text("ack") /* within another message */}) {
    FrameGate gate(kFramesPerSecond, kStart);
    Listener listener(gate);
    EXPECT_EQ(through(gate, bytes, bytes.size()), bytes);
    EXPECT_EQ(listener.heard, std::vector<std::string>());
  }
  // One that comes in two parts has been handed on in part.
  FrameGate gate(kFramesPerSecond, kStart);
  Listener listener(gate);
  EXPECT_EQ(through(gate, text("ack"), 7), text("ack"));
  EXPECT_EQ(listener.heard, std::vector<std::string>());
  // 125 bytes are the longest (RFC 6455 has their length in one byte).
  const std::string longest = "ack" + std::string(122, '.');
  EXPECT_EQ(through(gate, text(longest), 1000), "");
  EXPECT_EQ(listener.heard, std::vector<std::string>{longest});
}

TEST(FrameGate, AfterAMessageInFragmentsTextsAreTakenAsideAgain) {
  FrameGate gate(kFramesPerSecond, kStart);
  Listener listener(gate);
  const std::string message = frame(0x01, "b") + ping() + frame(0x80, "c");
  EXPECT_EQ(through(gate, message + text("ack"), 1000), message);
  EXPECT_EQ(listener.heard, std::vector<std::string>{"ack"});
}

TEST(FrameGate, ControlFramesAndFragmentsBeyondTheRateAre1008) {
  for (const unsigned first : {0x89U, 0x8aU, 0x00U}) {  // ping, pong, a fragment in the middle
    std::string bytes = frame(0x01, "");
    for (int i = 1; i < kFramesPerSecond; ++i) bytes += frame(first, "");
    for (const std::size_t piece : {1U, 4U, 100000U}) {
      FrameGate gate(kFramesPerSecond, kStart);
      EXPECT_EQ(through(gate, bytes + frame(first, "") + text("lost"), piece), bytes + substitute(1008));
      EXPECT_TRUE(gate.shut());
    }
  }
}

TEST(FrameGate, TheRateIsASecond) {
  FrameGate gate(kFramesPerSecond, kStart);
  std::string burst;
  for (int i = 0; i < kFramesPerSecond; ++i) burst += ping();
  for (int second = 0; second < 3; ++second) {
    EXPECT_EQ(through(gate, burst, 100000, kStart + second * 1s), burst);
  }
  EXPECT_EQ(through(gate, ping(), 100000, kStart + 2s), substitute(1008));
}

TEST(FrameGate, MessagesAreNotCounted) {
  FrameGate gate(kFramesPerSecond, kStart);
  std::string bytes;
  for (int i = 0; i < 100; ++i) bytes += text("{\"op\":\"ack\",\"f\":1}");
  EXPECT_EQ(through(gate, bytes, 10), bytes);
}

/// RFC 6455, section 7.4: 1000 to 1003 and 1007 to 1011 are defined there, 1012 and 1013 with IANA; 1004 to
/// 1006 and 1015 must not be sent; 3000 to 4999 belong to libraries and applications.
TEST(FrameGate, CloseCodesThatMayNotBeSentAre1002) {
  for (const unsigned code : {0U, 1U, 999U, 1004U, 1005U, 1006U, 1014U, 1015U, 1016U, 2999U, 5000U, 65535U}) {
    EXPECT_FALSE(close_code_allowed(static_cast<std::uint16_t>(code))) << code;
    for (const std::size_t piece : {1U, 100U}) {
      FrameGate gate(kFramesPerSecond, kStart);
      EXPECT_EQ(through(gate, text("a") + closing(code), piece), text("a") + substitute(1002)) << code;
    }
  }
  for (const unsigned code : {1000U, 1001U, 1002U, 1003U, 1007U, 1011U, 1012U, 1013U, 3000U, 4004U, 4999U}) {
    FrameGate gate(kFramesPerSecond, kStart);
    EXPECT_EQ(through(gate, closing(code), 1), closing(code));
    EXPECT_FALSE(gate.shut()) << code;
  }
}

// The edges of The Unicode Standard's table 3-7.
TEST(FrameRules, TellUtf8) {
  for (const char* text : {"", "a", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
                           "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(is_utf8(text)) << ::testing::PrintToString(text);
  }
  for (const char* text : {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
                           "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82", "a\xff"}) {
    EXPECT_FALSE(is_utf8(text)) << ::testing::PrintToString(text);
  }
}

/// Section 8.1; the characters of table 3-7 of the Unicode Standard, at its edges.
TEST(FrameGate, ReasonsThatAreNoTextAre1007) {
  const std::string good = "\x03\xe8";  // 1000
  for (const std::string text : {"", "why", "\xce\xba", "\xc2\x80", "\xe0\xa0\x80", "\xed\x9f\xbf",
                                 "\xee\x80\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    for (const std::size_t piece : {1U, 100U}) {
      FrameGate gate(kFramesPerSecond, kStart);
      EXPECT_EQ(through(gate, frame(0x88, good + text), piece), frame(0x88, good + text)) << text;
    }
  }
  for (const std::string text : {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
                                 "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xce", "why\xff", "\xe2\x82\x28"}) {
    for (const std::size_t piece : {1U, 100U}) {
      FrameGate gate(kFramesPerSecond, kStart);
      EXPECT_EQ(through(gate, frame(0x88, good + text), piece), substitute(1007)) << text;
    }
  }
}

/// Section 5.2: the highest bit of a length in 64 bits is 0.
TEST(FrameGate, ALengthBeyond63BitsIs1002) {
  FrameGate gate(kFramesPerSecond, kStart);
  const std::string head = std::string("\x81\xff\x80") + std::string(7, '\0') + "\1\2\3\4";
  EXPECT_EQ(through(gate, head, 1), substitute(1002));
  FrameGate longest(kFramesPerSecond, kStart);  // too long for a message, which the WebSocket tells
  const std::string all = "\x81\xff\x7f" + std::string(7, '\xff') + "\1\2\3\4";
  EXPECT_EQ(through(longest, all, 1), all);
}

TEST(FrameGate, ACloseWithoutACodeIsHandedOn) {
  FrameGate gate(kFramesPerSecond, kStart);
  EXPECT_EQ(through(gate, frame(0x88, ""), 1), frame(0x88, ""));
  FrameGate half(kFramesPerSecond, kStart);  // half a code: the WebSocket refuses it
  EXPECT_EQ(through(half, frame(0x88, "x"), 1), frame(0x88, "x"));
}

TEST(FrameHead, TellsLengthsOfAllThreeForms) {
  const auto size_and_payload = [](std::string_view bytes) {
    const auto head = parse_frame_head(bytes);
    return head ? std::pair(head->size, head->payload) : std::pair(std::size_t{0}, std::uint64_t{0});
  };
  using Expected = std::pair<std::size_t, std::uint64_t>;
  EXPECT_EQ(size_and_payload("\x81\x05"), Expected(2, 5));  // without a mask
  EXPECT_EQ(size_and_payload(std::string_view("\x81\x85\0\0\0\0", 6)), Expected(6, 5));
  EXPECT_EQ(size_and_payload(std::string_view("\x81\xfe\x01\x02\0\0\0\0", 8)), Expected(8, 0x102));
  EXPECT_EQ(size_and_payload(std::string_view("\x82\xff\0\0\0\x01\0\0\0\0\0\0\0\0", 14)),
            Expected(14, std::uint64_t{1} << 32));
  for (std::size_t length = 0; length < 14; ++length) {
    EXPECT_FALSE(
        parse_frame_head(std::string_view("\x82\xff\0\0\0\x01\0\0\0\0\0\0\0\0", 14).substr(0, length)));
  }
}

}  // namespace
}  // namespace weft::net
