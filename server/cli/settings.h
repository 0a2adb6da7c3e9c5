#pragma once
/// Where the options of a command come from: first its flags, then the environment, then a file, then the
/// defaults.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace weft::cli {

/// What the environment or the file says cannot be used; what() names the variable or the file, the option
/// and the value.
class BadSetting : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option as it is used.
struct Setting {
  std::string name;                 ///< without dashes
  bool flag = false;                ///< on or off
  std::vector<std::string> values;  ///< several where it may be given several times; empty: it has none
  std::string source;               ///< "--port", "WEFT_PORT", the file, "default"
};

/// Gives each of the command's options that has not been given the value of its variable, WEFT_HOST_NAME for
/// --host-name (several values are separated by ";"), or else that of `file` (TOML: `host-name = ["a",
/// "b"]`), unless that is empty. All in the order of the options. To be called from the command's callback.
/// Throws BadSetting.
std::vector<Setting> complete_settings(CLI::App& command, const std::filesystem::path& file);

/// As a file that complete_settings reads, a line an option, with the source of each as a comment.
std::string to_text(const std::vector<Setting>& settings);

}  // namespace weft::cli
