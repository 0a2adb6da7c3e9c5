#include "cli/settings.h"

#include "memory_file.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

/// The settings of a command with an option of every kind, from a file.
std::vector<cli::Setting> read(const std::string& file) {
  std::string name;
  int number = 8080;
  double share = 0.5;
  std::vector<std::string> names;
  bool flag = false;
  CLI::App command;
  command.add_option("--fuzz-name", name)->capture_default_str();
  command.add_option("--fuzz-number", number)->check(CLI::Range(0, 100'000))->capture_default_str();
  command.add_option("--fuzz-share", share)->capture_default_str();
  command.add_option("--fuzz-names", names)->allow_extra_args(false);
  command.add_flag("--fuzz-flag", flag);
  return cli::complete_settings(command, file);
}

}  // namespace

// A file gives settings or is refused by its name; written, settings can be read, and are the same.
void settings(Input input) {
  const MemoryFile file(input);
  std::vector<cli::Setting> given;
  try {
    given = read(file.path());
  } catch (const cli::BadSetting& error) {
    return require(std::string(error.what()).find(file.path()) != std::string::npos,
                   "a refusal names the file");
  }
  const std::string text = cli::to_text(given);
  const MemoryFile written({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const std::vector<cli::Setting> again = read(written.path());
  require(again.size() == given.size(), "all settings are written");
  for (std::size_t i = 0; i < given.size(); ++i)
    require(again[i].values == given[i].values, "a written setting is the same setting");
}

}  // namespace weft::fuzz
