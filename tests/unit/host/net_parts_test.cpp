/// The parts of the network that need no socket.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include "net/client.h"
#include "net/connection_pool.h"
#include "net/log_limiter.h"
#include "net/message_head.h"
#include "net/origin.h"
#include "net/static_files.h"

namespace weft::net {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const MessageHead& head) { return {head.bytes().begin(), head.bytes().end()}; }

// RFC 6455, section 5.7, has the first two and the length of the third; section 5.2 the borders between the
// lengths of 7, 16 and 64 bits.
TEST(MessageHead, HasTheLengthInAsFewBytesAsItTakes) {
  using Kind = MessageHead::Kind;
  EXPECT_EQ(bytes_of({Kind::text, 5}), "\x81\x05");
  EXPECT_EQ(bytes_of({Kind::binary, 256}), std::string("\x82\x7E\x01\x00", 4));
  EXPECT_EQ(bytes_of({Kind::binary, 65536}), std::string("\x82\x7F\0\0\0\0\0\x01\0\0", 10));
  EXPECT_EQ(bytes_of({Kind::text, 0}), std::string("\x81\0", 2));
  EXPECT_EQ(bytes_of({Kind::text, 125}), "\x81\x7D");
  EXPECT_EQ(bytes_of({Kind::text, 126}), std::string("\x81\x7E\0\x7E", 4));
  EXPECT_EQ(bytes_of({Kind::text, 65535}), "\x81\x7E\xFF\xFF");
  EXPECT_EQ(bytes_of({Kind::text, 0x0102030405060708}), "\x81\x7F\x01\x02\x03\x04\x05\x06\x07\x08");
}

TEST(LogLimiter, LeavesOutWhatIsTooMuchAndCountsIt) {
  const LogLimiter::TimePoint start{std::chrono::hours(1)};
  const auto after = [&](int ms) { return start + std::chrono::milliseconds(ms); };
  LogLimiter limiter(3, 1);
  int admitted = 0;
  for (int ms = 0; ms < 500; ++ms) admitted += limiter.admit(after(ms)).has_value();
  EXPECT_EQ(admitted, 3);
  EXPECT_EQ(limiter.admit(after(1000)), " (497 more like it were not logged)");
  EXPECT_EQ(limiter.admit(after(2000)), "");
  admitted = 0;
  for (int ms = 2001; ms < 60001; ms += 10) admitted += limiter.admit(after(ms)).has_value();
  EXPECT_NEAR(admitted, 58, 1);  // one a second
}

TEST(HostName, AddressesAndLocalhostAreAlwaysRight) {
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:8080", "192.168.0.7:80", "[::1]", "[fe80::1]:8080", "localhost",
        "localhost:3000", "LocalHost", "localhost.", "cloth.localhost:8080"}) {
    EXPECT_TRUE(host_allowed(host, {})) << host;
  }
}

TEST(HostName, OthersMustBeNamed) {
  for (const char* host :
       {"", "evil.example", "evil.example:8080", "localhost.evil.example", "evillocalhost",
        "127.0.0.1.evil.example", "1.2.3", "[::1].evil.example", "[evil.example]", ":8080"}) {
    EXPECT_FALSE(host_allowed(host, {})) << host;
    EXPECT_FALSE(host_allowed(host, {"weft.example"})) << host;
    EXPECT_TRUE(host_allowed(host, {"*"})) << host;
  }
  for (const char* host : {"weft.example", "weft.example:8080", "WEFT.example", "weft.example."}) {
    EXPECT_TRUE(host_allowed(host, {"other.example", "weft.example"})) << host;
    EXPECT_FALSE(host_allowed(host, {"other.example"})) << host;
  }
}

TEST(ConnectionPool, HasSoManyPlacesAndSoManyForAnAddress) {
  ConnectionPool pool(3, 2);
  std::optional<ConnectionPool::Place> first = pool.take("a");
  const auto second = pool.take("a");
  EXPECT_EQ(second.refusal(), NoPlace::none);
  EXPECT_EQ(pool.take("a").refusal(), NoPlace::taken_by_address);
  const auto third = pool.take("b");
  EXPECT_EQ(third.refusal(), NoPlace::none);
  EXPECT_EQ(pool.take("b").refusal(), NoPlace::all_taken);
  // Moved, as when an HTTP connection becomes a WebSocket, a place is still one.
  std::optional<ConnectionPool::Place> moved = std::move(*first);
  first.reset();
  EXPECT_EQ(pool.take("c").refusal(), NoPlace::all_taken);
  moved.reset();
  EXPECT_EQ(pool.take("c").refusal(), NoPlace::none);
}

TEST(ConnectionPool, WithoutALimitAnAddressMayHaveAll) {
  ConnectionPool pool(2, 0);
  const auto first = pool.take("a"), second = pool.take("a");
  EXPECT_EQ(second.refusal(), NoPlace::none);
  EXPECT_EQ(pool.take("a").refusal(), NoPlace::all_taken);
}

TEST(Origin, OwnPagesThisMachineAndScriptsMay) {
  EXPECT_TRUE(origin_allowed("", "weft.example:8080", {}));
  EXPECT_TRUE(origin_allowed("http://weft.example:8080", "weft.example:8080", {}));
  EXPECT_TRUE(origin_allowed("https://WEFT.example", "weft.example", {}));
  EXPECT_TRUE(origin_allowed("http://localhost:3000", "weft.example", {}));
  EXPECT_TRUE(origin_allowed("http://127.0.0.1", "weft.example", {}));
  EXPECT_TRUE(origin_allowed("http://[::1]:8080", "weft.example", {}));
}

TEST(Origin, OthersMayNot) {
  for (const char* origin :
       {"http://evil.example", "http://weft.example.evil.example:8080", "http://evil.example/localhost",
        "http://localhost.evil.example", "http://localhost@evil.example", "http://127.0.0.1.evil.example",
        "null", "file://", "http://", "localhost", "http://weft.example:8081", "ftp://weft.example:8080",
        "http:///"}) {
    EXPECT_FALSE(origin_allowed(origin, "weft.example:8080", {})) << origin;
  }
}

TEST(Origin, ThoseListedMay) {
  const std::vector<std::string> listed{"https://show.example"};
  EXPECT_TRUE(origin_allowed("https://show.example", "weft.example", listed));
  EXPECT_FALSE(origin_allowed("http://show.example", "weft.example", listed));
  EXPECT_FALSE(origin_allowed("https://show.example:444", "weft.example", listed));
  EXPECT_TRUE(origin_allowed("null", "weft.example", {"*"}));
}

TEST(PathOfTarget, NamesFilesBelowTheRoot) {
  EXPECT_EQ(path_of_target("/"), "index.html");
  EXPECT_EQ(path_of_target("/?server=x"), "index.html");
  EXPECT_EQ(path_of_target("/main.js?v=1"), "main.js");
  EXPECT_EQ(path_of_target("/three/build/three.module.js"), "three/build/three.module.js");
  EXPECT_EQ(path_of_target("/a%20b.js"), "a b.js");
  EXPECT_EQ(path_of_target("/sub/"), "sub/index.html");
}

TEST(PathOfTarget, NeverLeadsOutOfIt) {
  for (const char* target :
       {"/../etc/passwd", "/..", "/a/../../b", "/%2e%2e/etc/passwd", "/%2E%2e%2fetc/passwd", "/..%2f..",
        "/.git/config", "/./a", "/a//b", "//etc/passwd", "/a%00.js", "/a%", "/a%2", "/a%zz", "/..\\..\\a",
        "index.html", "", "http://host/", "*"}) {
    EXPECT_FALSE(path_of_target(target).has_value()) << target;
  }
}

TEST(StaticFiles, AreReadAgainWhenTheyChange) {
  const fs::path root = fs::path(::testing::TempDir()) / "weft_static_files";
  fs::create_directories(root);
  const auto write = [&](const std::string& content) {
    std::ofstream(root / "page.js", std::ios::trunc) << content;
  };
  write("one");
  StaticFiles files(root);
  const auto first = files.find("/page.js");
  ASSERT_TRUE(first);
  EXPECT_EQ(*first->content, "one");
  EXPECT_EQ(first->media_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(files.find("/page.js")->content.get(), first->content.get());  // from memory
  write("three");
  fs::last_write_time(root / "page.js", fs::last_write_time(root / "page.js") + std::chrono::seconds(1));
  const auto second = files.find("/page.js");
  EXPECT_EQ(*second->content, "three");
  EXPECT_NE(second->etag, first->etag);
  EXPECT_FALSE(files.find("/none.js"));
  EXPECT_FALSE(files.find("/"));  // no index.html
  fs::remove_all(root);
}

TEST(MediaType, IsWhatBrowsersNeed) {
  // Modules and WebAssembly are refused by browsers under any other type (HTML and WebAssembly standards).
  EXPECT_EQ(media_type("a.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(media_type("a.wasm"), "application/wasm");
  EXPECT_EQ(media_type("a.json"), "application/json");
  EXPECT_EQ(media_type("a.unknown"), "application/octet-stream");
}

TEST(Url, IsTakenApart) {
  const Url full = Url::parse("ws://127.0.0.1:8080/v1/scenes/flag");
  EXPECT_EQ(full.host, "127.0.0.1");
  EXPECT_EQ(full.port, "8080");
  EXPECT_EQ(full.target, "/v1/scenes/flag");
  const Url bare = Url::parse("http://weft.example");
  EXPECT_EQ(bare.port, "80");
  EXPECT_EQ(bare.target, "/");
  EXPECT_EQ(Url::parse("http://[::1]:81/").host, "[::1]");
  EXPECT_EQ(Url::parse("http://[::1]").port, "80");
  EXPECT_FALSE(full.secure);
  for (const char* text : {"wss://weft.example/v1/scenes/flag", "https://weft.example/v1/scenes/flag"}) {
    const Url secure = Url::parse(text);
    EXPECT_TRUE(secure.secure);
    EXPECT_EQ(secure.port, "443");
    EXPECT_EQ(secure.target, full.target);
  }
}

TEST(Url, OthersAreRefused) {
  for (const char* text : {"", "flag", "ftp://a/", "://a/", "http://", "http://:80/", "ws://a:b/", "ws://a:/",
                           "ws://a:123456/"}) {
    EXPECT_THROW(Url::parse(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace weft::net
