#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace weft::cli {

/// All problems of a scene on standard error, a line each.
inline void print_problems(const std::string& scene, const std::vector<scene::Problem>& problems) {
  std::fprintf(stderr, "weft: %s: %zu problem%s\n", scene.c_str(), problems.size(),
               problems.size() == 1 ? "" : "s");
  for (const scene::Problem& problem : problems) std::fprintf(stderr, "  %s\n", problem.text().c_str());
}

}  // namespace weft::cli
