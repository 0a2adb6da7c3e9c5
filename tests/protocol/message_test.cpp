// Control messages against the shared vectors, and what no vector can hold.
#include "protocol/message.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "protocol/plain_ack.h"
#include "vectors.h"

namespace weft::protocol {
namespace {

using nlohmann::json;
using test::from_hex;
using test::load;

const json& messages() {
  static const json loaded = load("protocol/vectors/messages.json");
  return loaded;
}

std::string text_of(const json& vector) {
  if (vector.contains("text")) return vector["text"];
  const auto bytes = from_hex(vector["hex"]);
  return {bytes.begin(), bytes.end()};
}

/// Equal up to the rounding of a normalised direction.
void expect_same(const json& got, const json& wanted) {
  if (wanted.is_number()) {
    ASSERT_TRUE(got.is_number());
    EXPECT_NEAR(got.get<double>(), wanted.get<double>(), 1e-15 * std::abs(wanted.get<double>()));
    return;
  }
  ASSERT_EQ(got.type(), wanted.type()) << got << " and " << wanted;
  if (!wanted.is_structured()) {
    EXPECT_EQ(got, wanted);
    return;
  }
  ASSERT_EQ(got.size(), wanted.size()) << got << " and " << wanted;
  for (const auto& [name, value] : wanted.items()) {
    if (wanted.is_object()) {
      ASSERT_TRUE(got.contains(name)) << name;
      expect_same(got[name], value);
    } else {
      const auto i = static_cast<std::size_t>(std::stoi(name));
      expect_same(got[i], value);
    }
  }
}

TEST(Message, GoodVectorsMeanWhatTheySay) {
  for (const json& vector : messages()["good"]) {
    const std::string text = vector["text"];
    SCOPED_TRACE(text);
    const auto parsed = parse_request(text);
    ASSERT_TRUE(std::holds_alternative<Request>(parsed)) << std::get<Error>(parsed).message;
    expect_same(json::parse(to_text(std::get<Request>(parsed))), vector["normal"]);
  }
}

// Each command written and read again is the same command.
TEST(Message, WritingIsTheInverseOfReading) {
  for (const json& vector : messages()["good"]) {
    SCOPED_TRACE(vector["text"].get<std::string>());
    const std::string once = to_text(std::get<Request>(parse_request(vector["text"].get<std::string>())));
    const auto again = parse_request(once);
    ASSERT_TRUE(std::holds_alternative<Request>(again)) << std::get<Error>(again).message;
    expect_same(json::parse(to_text(std::get<Request>(again))), json::parse(once));
  }
}

TEST(Message, BadVectorsAreRefusedExactly) {
  for (const json& vector : messages()["bad"]) {
    const std::string text = text_of(vector);
    SCOPED_TRACE(text);
    const auto parsed = parse_request(text);
    ASSERT_TRUE(std::holds_alternative<Error>(parsed));
    const Error& error = std::get<Error>(parsed);
    EXPECT_EQ(error.code, vector["code"].get<std::string>());
    EXPECT_EQ(error.path, vector["path"].get<std::string>());
    EXPECT_EQ(error.message, vector["message"].get<std::string>());
    EXPECT_EQ(error.re, vector.contains("re") ? std::optional<std::int64_t>(vector["re"]) : std::nullopt);
  }
}

TEST(Message, ValuesReachTheCommand) {
  const auto parsed = parse_request(
      R"({"op":"ball.add","id":5,"position":[1,2,3],"radius":0.5,"velocity":[4,5,6],"motion":"dynamic","mass":7})");
  const auto& request = std::get<Request>(parsed);
  const auto& ball = std::get<BallAdd>(request.command);
  EXPECT_EQ(request.id, 5);
  EXPECT_EQ(ball.position, (Vector{1, 2, 3}));
  EXPECT_EQ(ball.radius, 0.5);
  EXPECT_EQ(ball.velocity, (Vector{4, 5, 6}));
  EXPECT_EQ(ball.motion, Motion::dynamic);
  EXPECT_EQ(ball.mass, 7);
}

TEST(Message, WindIsOfUnitLength) {
  const auto parsed = parse_request(R"({"op":"wind.set","direction":[-1,2,-2],"speed":1})");
  const Vector direction = std::get<WindSet>(std::get<Request>(parsed).command).direction;
  EXPECT_DOUBLE_EQ(direction[0], -1.0 / 3);
  EXPECT_DOUBLE_EQ(direction[1], 2.0 / 3);
  EXPECT_DOUBLE_EQ(direction[2], -2.0 / 3);
}

TEST(Message, TooLargeIsSaidBeforeReading) {
  Limits limits;
  const std::string text = R"({"op":"pause"})" + std::string(limits.message_bytes, ' ');
  const Error error = std::get<Error>(parse_request(text, limits));
  EXPECT_EQ(error.code, "too_large");
  EXPECT_EQ(error.message, "the message has 16398 bytes; allowed: 16384");
  EXPECT_TRUE(std::holds_alternative<Request>(parse_request(text.substr(0, limits.message_bytes), limits)));
}

// The depth is limited while reading: a large text of brackets costs no deep tree.
TEST(Message, DepthIsTheLimitsOwn) {
  Limits limits;
  limits.json_depth = 2;
  EXPECT_TRUE(std::holds_alternative<Request>(parse_request(R"({"op":"camera","eye":[0,0,1]})", limits)));
  limits.json_depth = 1;
  EXPECT_EQ(std::get<Error>(parse_request(R"({"op":"camera","eye":[0,0,1]})", limits)).message,
            "nested deeper than 1 levels");
  limits.message_bytes = 10000000;
  EXPECT_EQ(std::get<Error>(parse_request(std::string(10000000, '['), limits)).code, "bad_json");
}

TEST(Message, LongValuesAreShownShortened) {
  // Cut between characters: 40 two-byte letters are 82 bytes with their quotes, the 60th byte is inside one.
  std::string letters;
  for (int i = 0; i < 40; ++i) letters += "\u00e4";
  const Error error = std::get<Error>(parse_request(R"({"op":"step","count":")" + letters + "\"}"));
  EXPECT_EQ(error.message, "/count is \"" + letters.substr(0, 58) + "...; allowed: an integer 1..600");
}

TEST(Message, ServerTextsAreTheContracts) {
  EXPECT_EQ(ok_text(7, 120), R"({"op":"ok","re":7,"f":120})");
  EXPECT_EQ(ok_text(7, 120, {{"ball", 2}}), R"({"op":"ok","re":7,"f":120,"ball":2})");
  EXPECT_EQ(error_text({7, "range", "/speed", "no"}),
            R"({"op":"error","re":7,"code":"range","path":"/speed","message":"no"})");
  EXPECT_EQ(error_text({{}, "bad_json", "", "no"}),
            R"({"op":"error","code":"bad_json","path":"","message":"no"})");
  EXPECT_EQ(pong_text(8, 1.5, 120, 2.0, 4115200),
            R"({"op":"pong","re":8,"t":1.5,"f":120,"time":2.0,"server_ms":4115200})");
  EXPECT_EQ(pong_text({}, 1.5, 120, 2.0, 4294967295),
            R"({"op":"pong","t":1.5,"f":120,"time":2.0,"server_ms":4294967295})");
  EXPECT_EQ(event_text("wind", 121, {{"wind", {{"speed", 2}}}}),
            R"({"op":"event","kind":"wind","f":121,"wind":{"speed":2}})");
  EXPECT_EQ(notice_text("slow", "behind"), R"({"op":"notice","code":"slow","message":"behind"})");
  EXPECT_EQ(json::parse(welcome_text("0.1.0", "5f3c2a7b9e104d68", Role::control, Limits{})),
            load("protocol/vectors/server_messages.json")["good"][0]);
}

// A client's text may come back in an error: not even broken UTF-8 may make writing it fail.
TEST(Message, ErrorTextSurvivesBrokenUtf8) {
  EXPECT_EQ(json::parse(error_text({1, "not_found", "/scene", "no \xff"}))["message"], "no \uFFFD");
}

/// The frame that parse_request() finds acknowledged, if it is a plain acknowledgement without an id.
std::optional<std::uint32_t> acknowledged(const std::string& text) {
  const auto parsed = parse_request(text);
  const auto* request = std::get_if<Request>(&parsed);
  const auto* ack = request && !request->id ? std::get_if<Ack>(&request->command) : nullptr;
  return ack ? std::optional(ack->f) : std::nullopt;
}

TEST(Message, APlainAcknowledgementIsReadAsTheParserReadsIt) {
  for (const std::string text : {R"({"op":"ack","f":120})", R"({"op": "ack", "f": 120})",
                                 " {\t\"op\" :\r\n\"ack\" , \"f\": 120 } \n"}) {
    EXPECT_EQ(read_plain_ack(text), 120U) << text;
    EXPECT_EQ(acknowledged(text), 120U) << text;
  }
  EXPECT_EQ(read_plain_ack(R"({"op":"ack","f":0})"), 0U);
  EXPECT_EQ(read_plain_ack(R"({"op":"ack","f":4294967295})"), 4294967295U);
  for (const std::string text :
       {R"({"op":"ack","f":4294967296})", R"({"op":"ack","f":-1})", R"({"op":"ack","f":007})",
        R"({"op":"ack","f":1.5})", R"({"op":"ack","f":})", R"({"op":"ack","f":1)", R"({"op":"ack","f":1}})",
        R"({"op":"ack","f":1,"f":2})", R"({"op":"ping","t":1})", R"({"op":"ack"})", "", "{", "ack"}) {
    EXPECT_EQ(read_plain_ack(text), std::nullopt) << text;
    EXPECT_EQ(acknowledged(text), std::nullopt) << text;
  }
  // What the parser takes and is not plain is the parser's.
  EXPECT_EQ(read_plain_ack(R"({"f":1,"op":"ack"})"), std::nullopt);
  EXPECT_EQ(read_plain_ack(R"({"op":"ack","f":1,"id":2})"), std::nullopt);
  EXPECT_EQ(read_plain_ack(R"({"op":"ack","f":1e0})"), std::nullopt);
}

TEST(Message, NoMutationOfAnAcknowledgementIsReadOtherwiseThanByTheParser) {
  constexpr int kMutations = 20000;
  constexpr std::string_view kLikely = "{}[]\",:0123456789eE+-. \t\nackopf\\";
  const std::string original = R"({"op": "ack", "f": 120})";
  std::mt19937 random(20261128);
  int plain = 0;
  for (int i = 0; i < kMutations; ++i) {
    std::string text = original;
    for (std::size_t changes = 1 + random() % 3; changes > 0; --changes)
      text[random() % text.size()] = kLikely[random() % kLikely.size()];
    const auto frame = read_plain_ack(text);
    plain += frame.has_value();
    if (!frame) continue;
    ASSERT_EQ(acknowledged(text), frame) << text;
  }
  EXPECT_GT(plain, 100);  // such as other digits
}

// Whatever a mutation makes of a message, parsing gives a request or an error, and never throws.
TEST(Message, MutatedMessagesNeverBreakTheParser) {
  constexpr int kMutations = 2000;
  constexpr std::string_view kLikely = "{}[]\",:0123456789eE+-.truefalsn\\/\xc3\xff";
  std::mt19937 random(20260102);
  const auto below = [&](std::size_t end) { return random() % end; };
  int accepted = 0, refused = 0;
  for (const json& vector : messages()["good"]) {
    const std::string original = vector["text"];
    SCOPED_TRACE(original);
    for (int i = 0; i < kMutations; ++i) {
      std::string text = original;
      for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
        const std::size_t at = below(text.size() + 1);
        const char c = kLikely[below(kLikely.size())];
        switch (below(3)) {
          case 0:
            text.insert(at, 1, c);
            break;
          case 1:
            text.erase(at, 1 + below(3));
            break;
          default:
            if (at < text.size()) text[at] = c;
        }
      }
      const auto parsed = parse_request(text);
      if (const Error* error = std::get_if<Error>(&parsed)) {
        ++refused;
        ASSERT_FALSE(error->code.empty());
        ASSERT_TRUE(json::accept(error_text(*error)));
      } else {
        ++accepted;
        ASSERT_TRUE(std::holds_alternative<Request>(parse_request(to_text(std::get<Request>(parsed)))))
            << text;
      }
    }
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace weft::protocol
