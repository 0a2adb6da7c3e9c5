#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "cli/writers/scene_writer.h"

namespace weft::cli::test {

/// A folder of one test's own, removed afterwards.
class OutputTest : public testing::Test {
 protected:
  OutputTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("weft-") + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~OutputTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string bytes(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Frames of one cloth, and of a body each, if there are `poses`.
  void write(const std::string& name, const std::vector<MeshFrame>& frames,
             const std::vector<BodyMesh>& bodies = {}, const std::vector<Pose>& poses = {}) const {
    const auto writer = SceneWriter::open(path(name), {"scene", {"cloth"}, bodies, 1.0 / 60});
    for (std::size_t i = 0; i < frames.size(); ++i) {
      SceneFrame frame{{frames[i]}, {}};
      if (!poses.empty()) frame.bodies = {poses[i]};
      writer->write(frame);
    }
    writer->finish();
  }

 private:
  std::filesystem::path folder_;
};

/// One cell: corners at (0, 0), (1, 0), (0, -1), (1, -1) in the x-y plane, `z` out of it.
inline MeshFrame one_cell(int frame, double time, float z) {
  return {frame,
          time,
          2,
          2,
          {0, 0, z, 1, 0, z, 0, -1, z, 1, -1, z},
          {0, 0, 1, 0, 0, 2, 0, 0, 3, 0.5f, -0.25f, 4}};
}

}  // namespace weft::cli::test
