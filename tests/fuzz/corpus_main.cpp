// Runs each target once over every file of its corpus, without libFuzzer: fuzz_corpus FOLDER.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "targets.h"

namespace {

namespace fs = std::filesystem;
namespace fuzz = weft::fuzz;

struct Named {
  const char* name;
  fuzz::Target* run;
};

constexpr std::array kTargets{
    Named{"messages", fuzz::messages},
    Named{"frames", fuzz::frames},
    Named{"scenes", fuzz::scenes},
    Named{"meshes", fuzz::meshes},
    Named{"motions", fuzz::motions},
    Named{"requests", fuzz::requests},
    Named{"gate", fuzz::gate},
    Named{"tokens", fuzz::tokens},
    Named{"settings", fuzz::settings},
    Named{"recordings", fuzz::recordings},
    Named{"fabrics", fuzz::fabrics},
    Named{"starts", fuzz::starts},
    Named{"connection", fuzz::connection},
};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files{fs::directory_iterator(folder), {}};
  std::sort(files.begin(), files.end());
  return files;
}

int run(const fs::path& corpus) {
  for (const Named& target : kTargets) {
    const std::vector<fs::path> files = files_in(corpus / target.name);
    for (const fs::path& file : files) {
      // Printed before: if the input ends the process, this is the last line.
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);
      std::ifstream stream(file, std::ios::binary);
      const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
      const std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
      target.run(input);
    }
    fuzz::require(!files.empty(), "every target has a corpus");
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) try {
  if (count == 2) return run(arguments[1]);
  std::fputs("usage: fuzz_corpus FOLDER\n", stderr);
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "fuzz_corpus: %s\n", error.what());
  return 1;
}
