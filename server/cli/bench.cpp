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
  double slow = 0;         ///< %
  bool tls = false;        ///< with it and without it
  bool unchecked = false;  ///< the certificate
  net::ClientSecurity security;
};

/// What the server counts of itself; 0 where it does not tell.
struct ServerCount {
  double cpu = 0, memory = 0, dropped = 0, overruns = 0, network = 0, frames = 0;

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
    count.network = sum("weft_network_cpu_seconds_total");
    count.frames = sum("weft_sent_frames_total");
    return count;
  }
};

/// Processor time of the network threads a frame sent, us.
double network_us(const ServerCount& before, const ServerCount& after) {
  return 1e6 * (after.network - before.network) / std::max(1.0, after.frames - before.frames);
}

ordered_json summary(const net::LoadResult& result, const net::LoadPlan& plan, const ServerCount& begun,
                     const ServerCount& before, const ServerCount& after) {
  const double seconds = result.seconds;
  return {{"viewers", plan.viewers},
          {"joined", result.joined},
          {"failures", result.failures.size()},
          {"joining_seconds", result.joining},
          {"joining_network_ms", 1e3 * (before.network - begun.network) / result.joined},
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
          {"network_cores", (after.network - before.network) / seconds},
          {"network_us_per_frame", network_us(before, after)},
          {"server_megabytes", after.memory / 1e6},
          {"own_cores", result.own_cpu / seconds}};
}

/// One load: its figures, and whether all viewers stayed.
struct Measured {
  ordered_json told;
  std::vector<std::string> failures;
};

Measured measure(const net::Url& url, const BenchOptions& options) {
  const ServerCount begun = ServerCount::ask(url, options.security);
  ServerCount before;
  const net::LoadResult result = net::load(url, options.plan, options.security,
                                           [&] { before = ServerCount::ask(url, options.security); });
  return {summary(result, options.plan, begun, before, ServerCount::ask(url, options.security)),
          result.failures};
}

void print(const Measured& measured) {
  for (const auto& [name, value] : measured.told.items())
    std::printf("%-22s %.6g\n", name.c_str(), value.get<double>());
  if (!measured.failures.empty())
    std::printf("first failure          %s\n", measured.failures.front().c_str());
}

/// What the second load costs more than the first, where the two differ in TLS alone.
ordered_json tls_costs(const ordered_json& plain, const ordered_json& secure) {
  const auto more = [&](const char* name) { return secure[name].get<double>() - plain[name].get<double>(); };
  const double megabytes = std::max(1e-9, secure["megabytes_per_second"].get<double>());
  const double frames = secure["frames_per_second"].get<double>();
  const double per_frame = more("network_us_per_frame");
  return {{"tls_joining_network_ms", more("joining_network_ms")},
          {"tls_us_per_frame", per_frame},
          {"tls_us_per_kilobyte", per_frame * frames / (1e3 * megabytes)},
          {"tls_age_ms_p99", more("age_ms_p99")},
          {"tls_kilobytes_per_viewer",
           1e3 * more("server_megabytes") / std::max(1.0, secure["joined"].get<double>())}};
}

int bench(BenchOptions& options) {
  const double shares = std::accumulate(options.mix.begin(), options.mix.end(), 0.0);
  if (!(shares > 0)) throw CLI::ValidationError("--mix", "needs a share above 0");
  for (std::size_t i = 0; i < options.mix.size(); ++i) options.plan.mix[i] = options.mix[i] / shares;
  options.plan.slow = options.slow / 100;
  options.security.check_certificate = !options.unchecked;
  const std::size_t room = net::make_room_for_connections();
  if (static_cast<std::size_t>(options.plan.viewers) > room)
    throw CLI::ValidationError("--viewers", std::to_string(options.plan.viewers) + " are more than the " +
                                                std::to_string(room) +
                                                " connections that this process may have (ulimit -n)");
  net::Url url = net::Url::parse(options.url);
  if (url.target.ends_with('/')) url.target += "v1/scenes/" + options.scene;
  if (options.tls) url.secure = false;
  Measured measured = measure(url, options);
  print(measured);
  ordered_json told = measured.told;
  bool all = measured.failures.empty();
  if (options.tls) {
    url.secure = true;
    std::printf("\nWith TLS:\n");
    const Measured secure = measure(url, options);
    print(secure);
    const ordered_json costs = tls_costs(measured.told, secure.told);
    std::printf("\nTLS costs:\n");
    print({costs, {}});
    told = {{"plain", measured.told}, {"tls", secure.told}, {"costs", costs}};
    all = all && secure.failures.empty();
  }
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << told.dump(2) << '\n';
    if (!file.flush()) throw std::runtime_error(options.json + ": cannot be written");
  }
  return all ? 0 : kFailed;
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
  serve->add_flag("--tls", options->tls,
                  "Measures twice, without TLS and with it, at the same port, and prints what it costs");
  serve
      ->add_option("--ca", options->security.authorities,
                   "Certificates (PEM) to trust with TLS in place of the system's")
      ->check(CLI::ExistingFile);
  serve->add_flag("--unchecked", options->unchecked, "With TLS takes any certificate");
  serve->add_option("--token", options->security.token, "The server's, where it asks for one")
      ->envname("WEFT_TOKEN");
  serve->callback([options, &exit_code] { exit_code = bench(*options); });
}

}  // namespace weft::cli
