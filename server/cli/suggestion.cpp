#include "cli/suggestion.h"

#include <vector>

#include "scene/nearest_name.h"

namespace weft::cli {
namespace {

/// What may stand on the command line: commands, or the options of the command that was given.
std::vector<std::string> names_known(const CLI::App& app) {
  const auto given = app.get_subcommands();
  if (!given.empty()) return names_known(*given.front());
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

}  // namespace

std::string suggestion(const CLI::App& app) {
  const std::vector<std::string> names = names_known(app);
  for (const std::string& word : app.remaining(true)) {
    const std::string given = word.substr(0, word.find('='));
    const std::string meant = scene::did_you_mean(given, {names.begin(), names.end()});
    if (!meant.empty())
      return std::string("weft: ").append(given).append(" is unknown").append(meant).append("\n");
  }
  return {};
}

}  // namespace weft::cli
