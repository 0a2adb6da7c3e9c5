#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "net/load.h"

namespace weft::cli {
namespace {

using nlohmann::ordered_json;

constexpr auto kAnswerTime = std::chrono::seconds(5);

struct BenchOptions {
  std::string url = "http://127.0.0.1:8080/", scene = "flag", json;
  net::LoadPlan plan;
  std::vector<double> mix{10, 30, 60};
  double slow = 0;  ///< %
  net::ClientSecurity security;
};

/// What the server counts of itself; 0 where it does not tell.
struct ServerCount {
  double cpu = 0, memory = 0, dropped = 0, overruns = 0;

  static ServerCount ask(net::Url url, const net::ClientSecurity& security) {
    url.target = "/metrics";
    ServerCount count;
    const net::HttpReply reply = net::http_get(url, kAnswerTime, security);
    if (reply.status != 200) return count;
    // Over all labels.
    const auto sum = [&](const std::string& name) {
      double total = 0;
      std::istringstream lines(reply.body);
      for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(name)) total += std::stod(line.substr(line.rfind(' ') + 1));
      }
      return total;
    };
    count.cpu = sum("process_cpu_seconds_total");
    count.memory = sum("process_resident_memory_bytes");
    count.dropped = sum("weft_dropped_frames_total");
    count.overruns = sum("weft_step_overruns_total");
    return count;
  }
};

ordered_json summary(const net::LoadResult& result, const net::LoadPlan& plan, const ServerCount& before,
                     const ServerCount& after) {
  const double seconds = result.seconds;
  return {{"viewers", plan.viewers},
          {"joined", result.joined},
          {"failures", result.failures.size()},
          {"seconds", seconds},
          {"frames_per_second", static_cast<double>(result.frames) / seconds},
          {"fewest_per_second", result.fewest},
          {"most_per_second", result.most},
          {"megabytes_per_second", static_cast<double>(result.bytes) / seconds / 1e6},
          {"age_ms_p50", result.age(50)},
          {"age_ms_p95", result.age(95)},
          {"age_ms_p99", result.age(99)},
          {"age_ms_max", result.age(100)},
          {"dropped_per_second", (after.dropped - before.dropped) / seconds},
          {"overruns", after.overruns - before.overruns},
          {"server_cores", (after.cpu - before.cpu) / seconds},
          {"server_megabytes", after.memory / 1e6},
          {"own_cores", result.own_cpu / seconds}};
}

int bench(BenchOptions& options) {
  const double shares = std::accumulate(options.mix.begin(), options.mix.end(), 0.0);
  if (!(shares > 0)) throw CLI::ValidationError("--mix", "needs a share above 0");
  for (std::size_t i = 0; i < options.mix.size(); ++i) options.plan.mix[i] = options.mix[i] / shares;
  options.plan.slow = options.slow / 100;
  net::Url url = net::Url::parse(options.url);
  if (url.target.ends_with('/')) url.target += "v1/scenes/" + options.scene;
  ServerCount before;
  const net::LoadResult result = net::load(url, options.plan, options.security,
                                           [&] { before = ServerCount::ask(url, options.security); });
  const ordered_json told = summary(result, options.plan, before, ServerCount::ask(url, options.security));
  for (const auto& [name, value] : told.items())
    std::printf("%-22s %.6g\n", name.c_str(), value.get<double>());
  if (!result.failures.empty()) std::printf("first failure          %s\n", result.failures.front().c_str());
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << told.dump(2) << '\n';
    if (!file.flush()) throw std::runtime_error(options.json + ": cannot be written");
  }
  return result.failures.empty() ? 0 : kFailed;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("bench", "Measures a running server");
  command->require_subcommand(1);
  auto options = std::make_shared<BenchOptions>();
  CLI::App* serve = command->add_subcommand(
      "serve", "Many viewers of one scene: how old the frames are that they see, and what they cost");
  net::LoadPlan& plan = options->plan;
  constexpr int kMostViewers = 100'000;
  serve->add_option("URL", options->url, "http://HOST:PORT/ or ws://HOST:PORT/v1/scenes/NAME")
      ->capture_default_str();
  serve->add_option("--scene", options->scene, "Scene to join if the URL names none")->capture_default_str();
  serve->add_option("--viewers", plan.viewers, "Viewers")
      ->check(CLI::Range(1, kMostViewers))
      ->capture_default_str();
  serve->add_option("--rate", plan.rate, "Frames a second that each takes at most")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  serve->add_option("--mix", options->mix, "Shares of viewers at 0.8, 5 and 12 m, as 10,30,60")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::NonNegativeNumber);
  serve->add_option("--slow", options->slow, "Share of viewers that take one frame a second, %")
      ->check(CLI::Range(0, 100));
  serve->add_option("--seconds", plan.seconds, "Time of measuring, s")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  serve->add_option("--json", options->json, "File for the same as JSON");
  serve->add_option("--token", options->security.token, "The server's, where it asks for one")
      ->envname("WEFT_TOKEN");
  serve->callback([options, &exit_code] { exit_code = bench(*options); });
}

}  // namespace weft::cli
