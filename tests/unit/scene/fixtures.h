#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace weft::scene::test {

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The .json files of a folder beside the tests, by name.
inline std::vector<std::filesystem::path> scene_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(WEFT_SCENE_TEST_DATA) / folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// All problems, a line each; empty for a good scene.
inline std::string problems_of(const Result& result) {
  std::string text;
  if (const auto* problems = std::get_if<std::vector<Problem>>(&result)) {
    for (const Problem& problem : *problems) text += problem.text() + "\n";
  }
  return text;
}

/// The scene; a failure that lists the problems if it is not good.
inline Scene good(const Result& result) {
  EXPECT_EQ(problems_of(result), "");
  const auto* scene = std::get_if<Scene>(&result);
  return scene ? *scene : Scene{};
}

}  // namespace weft::scene::test
