#include "record/log_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

namespace weft::record {
namespace {

namespace fs = std::filesystem;

class LogWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "weft-log-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<LogWriter> writer(std::size_t kept = 0) {
    return std::make_unique<LogWriter>(
        LogWriter::Reports{[this](const std::string& fault) { faults_.push_back(fault); },
                           [this] { ++working_again_; }, [this] { ++begun_; }},
        kept);
  }
  std::string text_of(const fs::path& file) const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  fs::path folder_;
  // Of the writer's thread; looked at when it has ended.
  std::vector<std::string> faults_;
  int working_again_ = 0, begun_ = 0;
};

TEST_F(LogWriterTest, WritesEachFileInItsTurn) {
  auto log = writer();
  log->begin(folder_ / "deep" / "1.weftrec");
  log->append("one ");
  log->append("two");
  log->begin(folder_ / "deep" / "2.weftrec");
  log->append("three");
  log.reset();
  EXPECT_EQ(text_of(folder_ / "deep" / "1.weftrec"), "one two");
  EXPECT_EQ(text_of(folder_ / "deep" / "2.weftrec"), "three");
  EXPECT_EQ(begun_, 2);
  EXPECT_TRUE(faults_.empty());
}

TEST_F(LogWriterTest, KeepsTheNewest) {
  auto log = writer(3);
  for (int i = 1; i <= 7; ++i) {
    log->begin(folder_ / (std::to_string(i) + ".weftrec"));
    log->append("x");
  }
  std::ofstream(folder_ / "0.other") << "not its own";
  log.reset();
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder_)) left.push_back(entry.path().filename());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<std::string>{"0.other", "5.weftrec", "6.weftrec", "7.weftrec"}));
}

TEST_F(LogWriterTest, GivesUpAFileThatCannotBeWrittenAndTriesTheNext) {
  auto log = writer();
  std::ofstream(folder_ / "file") << "no folder";
  log->begin(folder_ / "file" / "1.weftrec");
  log->append("lost");
  log->append("lost, too");
  log->begin(folder_ / "file" / "2.weftrec");
  log->append("lost");
  log->begin(folder_ / "3.weftrec");
  log->append("kept");
  log.reset();
  ASSERT_EQ(faults_.size(), 1u);  // once, however often it fails
  EXPECT_NE(faults_[0].find("file"), std::string::npos) << faults_[0];
  EXPECT_EQ(working_again_, 1);
  EXPECT_EQ(text_of(folder_ / "3.weftrec"), "kept");
}

// Nothing waits without limit where the disk takes nothing: /dev/full is one.
TEST_F(LogWriterTest, ADiskThatIsFullIsToldOnce) {
  auto log = writer();
  fs::create_symlink("/dev/full", folder_ / "1.weftrec.new");
  log->begin(folder_ / "1.weftrec");
  for (int i = 0; i < 100; ++i) log->append("x");
  log.reset();
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_NE(faults_[0].find("No space left on device"), std::string::npos) << faults_[0];
}

// A pipe that nobody reads is a disk that takes nothing for a while.
TEST_F(LogWriterTest, WhatIsTooMuchToWaitGivesTheFileUp) {
  const std::string pipe = (folder_ / "1.weftrec.new").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto log = writer();
  log->begin(folder_ / "1.weftrec");
  log->append("first");
  for (int i = 0; i < 3; ++i) log->append(std::string(LogWriter::kMostWaiting / 2, 'x'));
  log->begin(folder_ / "2.weftrec");
  log->append("kept");
  EXPECT_EQ(text_of(pipe), "first");
  log.reset();
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_NE(faults_[0].find("too slow"), std::string::npos) << faults_[0];
  EXPECT_EQ(text_of(folder_ / "2.weftrec"), "kept");
}

}  // namespace
}  // namespace weft::record
