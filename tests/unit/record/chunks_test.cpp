#include "record/chunks.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace weft::record {
namespace {

std::string three_chunks() {
  std::string text(kMark);
  append_chunk(text, {ChunkKind::scene, "{}"});
  append_chunk(text, {ChunkKind::commands, ""});
  append_chunk(text, {ChunkKind::state, std::string_view("a\0b", 3)});
  return text;
}

std::size_t count(ChunkReader& reader) {
  std::size_t chunks = 0;
  while (reader.next()) ++chunks;
  return chunks;
}

TEST(Chunks, AreReadAsTheyWereWritten) {
  const std::string text = three_chunks();
  ChunkReader reader(text);
  const auto scene = reader.next(), commands = reader.next(), state = reader.next();
  ASSERT_TRUE(scene && commands && state);
  EXPECT_EQ(scene->kind, ChunkKind::scene);
  EXPECT_EQ(scene->bytes, "{}");
  EXPECT_EQ(commands->bytes, "");
  EXPECT_EQ(state->bytes, std::string_view("a\0b", 3));
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.damage(), "");
}

// Byte by byte the layout of the file, so that other programs may read it: CRC-32 is that of zlib and PNG.
TEST(Chunks, HaveThisLayout) {
  std::string text;
  append_chunk(text, {ChunkKind::state, "abc"});
  // Python: zlib.crc32(b"\x02\x03\0\0\0abc") == 0xdc8a5a59
  EXPECT_EQ(text, std::string("\x02\x03\0\0\0", 5) +
                      "\x59\x5a\x8a\xdc"
                      "abc");
}

TEST(Chunks, AnyByteThatIsChangedIsFound) {
  const std::string text = three_chunks();
  for (std::size_t i = kMark.size(); i < text.size(); ++i) {
    for (const int bit : {0, 3, 7}) {
      std::string damaged = text;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      ChunkReader reader(damaged);
      EXPECT_LT(count(reader), 3u) << "byte " << i << " bit " << bit;
      EXPECT_NE(reader.damage(), "");
    }
  }
}

TEST(Chunks, ATextThatIsCutIsReadUpToThere) {
  const std::string text = three_chunks();
  for (std::size_t size = kMark.size(); size < text.size(); ++size) {
    const std::string cut = text.substr(0, size);
    ChunkReader reader(cut);
    const std::size_t chunks = count(reader);
    EXPECT_LT(chunks, 3u) << size;
    const bool between = size == kMark.size() || size == kMark.size() + 11 || size == kMark.size() + 20;
    EXPECT_EQ(reader.damage().empty(), between) << size << ": " << reader.damage();
  }
}

TEST(Chunks, OfSomethingElseAreRefused) {
  for (const std::string text : {"", "weftrec", "weftrec\x02 and more", "{\"title\": 1}"})
    EXPECT_THROW(ChunkReader{text}, std::invalid_argument);
}

}  // namespace
}  // namespace weft::record
