#include "cli/settings.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "cli/toml.h"

namespace weft::cli {
namespace {

using Values = std::vector<std::string>;

/// Those that say how the command is run, and not what it does.
bool is_setting(const CLI::Option& option) {
  const Values& names = option.get_lnames();
  return !names.empty() && names.front() != "help" && names.front() != "config";
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::string variable_of(std::string name) {
  for (char& letter : name)
    letter = letter == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return "WEFT_" + name;
}

std::string joined(const Values& values) {
  std::string text;
  for (const std::string& value : values) text.append(text.empty() ? "" : ", ").append(value);
  return text;
}

Values separated(const std::string& text) {
  Values values;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    values.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return values;
}

BadSetting unknown(const std::filesystem::path& file, const std::string& name, const Values& known) {
  return BadSetting(file.string() + ": " + name + " is unknown; allowed: " + joined(known));
}

/// By option.
std::map<std::string, Values> read_file(const std::filesystem::path& file, const Values& known) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw BadSetting(file.string() + ": cannot be read");
  std::vector<TomlEntry> entries;
  try {
    entries = read_toml(text);
  } catch (const std::invalid_argument& error) {
    throw BadSetting(file.string() + ": " + error.what());
  }
  std::map<std::string, Values> found;
  for (TomlEntry& entry : entries) {
    if (std::find(known.begin(), known.end(), entry.name) == known.end())
      throw unknown(file, entry.name, known);
    found.emplace(std::move(entry.name), std::move(entry.values));
  }
  return found;
}

void take(CLI::Option& option, const Values& values, const std::string& source) {
  const std::string name = option.get_lnames().front();
  const std::string shown = joined(values);
  try {
    if (values.size() != 1 && option.get_items_expected_max() == 1)
      throw CLI::ValidationError("one value is allowed");
    if (is_flag(option)) {
      if (shown != "true" && shown != "false") throw CLI::ValidationError("allowed: true or false");
      if (shown == "true") option.add_result("true");
    } else {
      option.add_result(values);
    }
    if (!option.empty()) option.run_callback();
  } catch (const CLI::Error& error) {
    throw BadSetting(source + ": " + name + " is " + shown + "; " + error.what());
  }
}

std::string quoted(const std::string& value) {
  const bool number = value == "0" || (!value.empty() && value.front() != '0' && value.size() < 16 &&
                                       value.find_first_not_of("0123456789") == std::string::npos);
  return number ? value : toml_string(value);
}

}  // namespace

std::vector<Setting> complete_settings(CLI::App& command, const std::filesystem::path& file) {
  const auto options = command.get_options([](const CLI::Option* option) { return is_setting(*option); });
  Values known;
  for (const CLI::Option* option : options) known.push_back(option->get_lnames().front());
  const auto in_file = file.empty() ? std::map<std::string, Values>() : read_file(file, known);
  std::vector<Setting> settings;
  for (CLI::Option* option : options) {
    Setting setting{option->get_lnames().front(), is_flag(*option), {}, "default"};
    const std::string variable = variable_of(setting.name);
    const char* text = std::getenv(variable.c_str());
    if (option->count() > 0) {
      setting.source = "--" + setting.name;
    } else if (text != nullptr) {
      take(*option, separated(text), variable);
      setting.source = variable;
    } else if (const auto found = in_file.find(setting.name); found != in_file.end()) {
      take(*option, found->second, file.string());
      setting.source = file.string();
    }
    if (setting.flag) {
      setting.values = {option->count() > 0 ? "true" : "false"};
    } else if (option->count() > 0) {
      setting.values = option->results();
    } else if (!option->get_default_str().empty()) {
      setting.values = {option->get_default_str()};
    }
    settings.push_back(std::move(setting));
  }
  return settings;
}

std::string to_text(const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting& setting : settings) {
    if (setting.values.empty()) {
      text.append("# ").append(setting.name).append(" =\n");
      continue;
    }
    Values values = setting.values;
    if (!setting.flag) std::transform(values.begin(), values.end(), values.begin(), quoted);
    const bool several = values.size() > 1;
    text.append(setting.name).append(several ? " = [" : " = ").append(joined(values));
    text.append(several ? "]  # " : "  # ").append(setting.source).append("\n");
  }
  return text;
}

}  // namespace weft::cli
