#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/problems.h"
#include "fabric/fit.h"
#include "fabric/report.h"
#include "fabric/specimen.h"
#include "scene/document.h"
#include "scene/scene.h"

namespace weft::cli {
namespace {

using nlohmann::json;

struct TestOptions {
  std::vector<std::string> fabrics;
  std::string scene;
  std::vector<std::string> overrides;
  int cells = 64;
  bool json = false;
};

struct FitOptions {
  std::string file;
  json numbers = json::object();
  int cells = 64;
};

struct Tested {
  std::string name, fabric;
  Material material;
};

/// The cloths of a scene, or the named fabrics; none, and what is wrong has been said.
std::vector<Tested> tested_of(const TestOptions& options) {
  std::vector<Tested> all;
  if (options.scene.empty()) {
    for (const std::string& name : options.fabrics) all.push_back({name, name, find_fabric(name)->material});
    if (!all.empty()) return all;
    for (const Fabric& each : fabrics())
      all.push_back({std::string(each.name), std::string(each.name), each.material});
    return all;
  }
  const scene::Result result = scene::load(options.scene, options.overrides);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
    print_problems(options.scene, *problems);
    return {};
  }
  for (const ClothDescription& cloth : std::get<scene::Scene>(result).simulation.cloths)
    all.push_back({cloth.name, "", cloth.material});
  return all;
}

int test(const TestOptions& options) {
  const std::vector<Tested> all = tested_of(options);
  if (all.empty()) return kBadUsage;
  json document = json::object();
  for (const Tested& each : all) {
    const std::vector<fabric::Reading> readings = fabric::test(each.material, each.fabric, options.cells);
    if (options.json) {
      document[each.name] = fabric::json_of(readings);
    } else {
      std::printf("%s\n%s\n", each.name.c_str(), fabric::table(readings).c_str());
      std::fflush(stdout);
    }
  }
  if (options.json) std::printf("%s\n", document.dump(2).c_str());
  return 0;
}

/// The file's numbers; null, and what is wrong has been said.
json numbers_in(const std::string& path) {
  const auto text = scene::read_text_file(path);
  if (!text) {
    std::fprintf(stderr, "weft: %s: cannot be read: %s\n", path.c_str(), std::strerror(errno));
    return nullptr;
  }
  scene::Document document = scene::read_document(*text);
  for (const auto& [where, literal] : document.overflows)
    document.problems.push_back({where, "is " + literal + "; allowed: finite numbers"});
  if (document.problems.empty() && !document.tree.is_object())
    document.problems.push_back({"", "is not a JSON object of numbers"});
  if (document.problems.empty()) return std::move(document.tree);
  print_problems(path, document.problems);
  return nullptr;
}

/// The file's numbers and those of the command line, which count where both have one; null, and what is wrong
/// has been said.
json numbers_of(const FitOptions& options) {
  json numbers = options.file.empty() ? json::object() : numbers_in(options.file);
  if (!numbers.is_null()) numbers.update(options.numbers);
  return numbers;
}

int fit(const FitOptions& options) {
  const json given = numbers_of(options);
  if (given.is_null()) return kBadUsage;
  const auto read = fabric::read_numbers(given);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&read)) {
    print_problems("the numbers", *problems);
    return kBadUsage;
  }
  const auto& numbers = std::get<fabric::Numbers>(read);
  try {
    const fabric::Fit found = fabric::fit(numbers, options.cells);
    std::printf("%s\n", fabric::block_of(numbers, found.material).dump(2).c_str());
    if (found.drape)
      std::fprintf(stderr, "weft: it drapes at %.3f, asked for %.3f\n", *found.drape, *numbers.drape);
  } catch (const fabric::NoFit& none) {
    std::fprintf(stderr, "weft: %s\n", none.what());
    return kBadUsage;
  } catch (const fabric::NoRest& none) {
    std::fprintf(stderr, "weft: %s\n", none.what());
    return kBadState;
  }
  return 0;
}

void add_cells(CLI::App& command, int& cells) {
  command.add_option("--cells", cells, "Of the drape's specimen along its diameter, even")
      ->check(CLI::Range(16, 256))
      ->check([](const std::string& text) {
        return text.empty() || (text.back() - '0') % 2 == 0 ? std::string() : "must be even, is " + text;
      })
      ->capture_default_str();
}

void add_test(CLI::App& fabric, int& exit_code) {
  auto options = std::make_shared<TestOptions>();
  CLI::App* command = fabric.add_subcommand(
      "test", "Puts fabrics into simulated testing instruments, and tells what others have measured");
  std::vector<std::string> names;
  for (const Fabric& each : fabrics()) names.emplace_back(each.name);
  auto* named = command->add_option("FABRIC", options->fabrics, "Named fabrics (default: all)")
                    ->check(CLI::IsMember(names));
  auto* scene =
      command->add_option("--scene", options->scene, "The materials of this scene's cloths")->excludes(named);
  command
      ->add_option("--set", options->overrides,
                   "POINTER=VALUE changes a value of the scene, as /cloths/0/material/shear=50")
      ->allow_extra_args(false)
      ->needs(scene);
  command->add_flag("--json", options->json, "As JSON");
  add_cells(*command, options->cells);
  command->callback([options, &exit_code] { exit_code = test(*options); });
}

void add_fit(CLI::App& fabric, int& exit_code) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command =
      fabric.add_subcommand("fit", "Finds a scene's material from what instruments have measured of a cloth");
  command->add_option("FILE", options->file, "A JSON object of the numbers below, as {\"density\": 0.12}");
  struct Number {
    const char *option, *member, *text;
  };
  static constexpr Number kNumbers[] = {
      {"--density", "density", "Areal density, kg/m2; needed"},
      {"--emt-warp", "emt_warp", "KES-FB1's EMT: elongation at 490 N/m, as 0.05"},
      {"--emt-weft", "emt_weft", "The same of the weft (default: the warp's)"},
      {"--bending-length-warp", "bending_length_warp", "ASTM D1388's bending length c, half the overhang, m"},
      {"--bending-length-weft", "bending_length_weft", "The same of the weft (default: the warp's)"},
      {"--shear-stiffness", "shear_stiffness", "KES-FB1's G, N/m per radian; 1 gf/(cm deg) is 56.19"},
      {"--drape", "drape", "Cusick's drape coefficient, 30 cm on 18 cm, as 0.55; found by simulation"},
  };
  for (const Number& each : kNumbers) {
    command->add_option_function<double>(
        each.option, [options, &each](double value) { options->numbers[each.member] = value; }, each.text);
  }
  add_cells(*command, options->cells);
  command->callback([options, &exit_code] { exit_code = fit(*options); });
}

}  // namespace

void add_fabric(CLI::App& app, int& exit_code) {
  CLI::App* fabric =
      app.add_subcommand("fabric", "Fabrics in testing instruments, and materials from their numbers");
  fabric->require_subcommand(1);
  add_test(*fabric, exit_code);
  add_fit(*fabric, exit_code);
}

}  // namespace weft::cli
