#include "cli/client/script.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace weft::cli {

std::vector<Timed> read_script(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error(path + ": cannot be read");
  std::vector<Timed> script;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    Timed timed{0, nlohmann::json::parse(line, nullptr, false)};
    const auto at = timed.message.is_object() ? timed.message.find("at") : timed.message.end();
    if (at == timed.message.end() || !at->is_number() || !timed.message.contains("op")) {
      throw std::runtime_error(path + ":" + std::to_string(number) +
                               ": not a message like {\"at\": 0.5, \"op\": \"camera\", \"distance\": 2}");
    }
    timed.at = at->get<double>();
    timed.message.erase("at");
    script.push_back(std::move(timed));
  }
  std::stable_sort(script.begin(), script.end(), [](const Timed& a, const Timed& b) { return a.at < b.at; });
  return script;
}

}  // namespace weft::cli
