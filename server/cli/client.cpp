#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/seen_bodies.h"
#include "cli/writers/scene_writer.h"
#include "cloth/core/clock.h"
#include "net/client.h"
#include "net/scene_client.h"
#include "protocol/frame.h"

namespace weft::cli {
namespace {

using Seconds = std::chrono::duration<double>;
using nlohmann::json;

constexpr auto kConnectTime = std::chrono::seconds(5);
/// How often the loop looks whether it was interrupted.
constexpr auto kPoll = std::chrono::milliseconds(200);
constexpr std::string_view kScenes = "v1/scenes/";  // below the server's path

struct ClientOptions {
  std::string url;
  std::string scene;
  std::optional<double> distance;
  std::vector<double> eye, wind, ball, velocity;
  int frames = 0;
  double seconds = 0;
  std::vector<std::string> outputs;
  std::string script;
  net::ClientSecurity security;
  bool quiet = false, health = false, reconnect = false;
};

volatile std::sig_atomic_t interrupted = 0;

/// The path that everything of the server at `target` is below, with a slash at its end: of a scene's there,
/// or of the page's.
std::string base_path(const std::string& target) {
  const std::string base = target.substr(0, target.find(kScenes));
  return base.ends_with('/') ? base : base + '/';
}

/// A message of the script, and when it is due after the start.
struct Timed {
  double at = 0;  ///< s
  json message;
};

std::vector<Timed> read_script(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error(path + ": cannot be read");
  std::vector<Timed> script;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    Timed timed{0, json::parse(line, nullptr, false)};
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

protocol::Vector vector_of(const std::vector<double>& values) { return {values[0], values[1], values[2]}; }

/// A conversation with one server, from connecting to the last frame wanted.
class Conversation {
 public:
  Conversation(const ClientOptions& options, const net::Url& url)
      : options_(options),
        url_(url),
        script_(options.script.empty() ? std::vector<Timed>{} : read_script(options.script)),
        client_(url, {.limit = kConnectTime,
                      .security = options.security,
                      .reconnect = options.reconnect,
                      .on_message = [this](const json& message, std::string_view text) {
                        take_control(message, text);
                      }}) {}

  int run() {
    start_ = Clock::now();
    if (options_.distance) client_.post(protocol::Camera{options_.distance, std::nullopt});
    if (!options_.eye.empty()) client_.post(protocol::Camera{std::nullopt, vector_of(options_.eye)});
    if (!options_.wind.empty()) client_.post(protocol::WindSet{vector_of(options_.wind), options_.wind[3]});
    if (!options_.ball.empty()) {
      added_ =
          client_.post(protocol::BallAdd{.position = vector_of(options_.ball), .radius = options_.ball[3]});
      awaits_ball_ = true;
    }
    try {
      while (!finished()) {
        if (client_.connected()) send_due();
        if (const auto received = client_.next_frame(next_event())) take_frame(*received);
      }
      client_.close();
    } catch (const net::ConnectionError&) {
      finish_files();  // what came before is worth keeping
      throw;
    }
    finish_files();
    return refused_ ? kFailed : 0;
  }

 private:
  void finish_files() {
    for (const auto& writer : writers_) writer->finish();
  }

  double elapsed() const { return Seconds(Clock::now() - start_).count(); }

  bool finished() const {
    return interrupted || std::ferror(stdout) || (options_.frames > 0 && frames_ >= options_.frames) ||
           (options_.seconds > 0 && elapsed() >= options_.seconds);
  }

  Clock::time_point next_event() const {
    auto until = Clock::now() + kPoll;
    const auto at = [&](double seconds) {
      return start_ + std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
    };
    if (options_.seconds > 0) until = std::min(until, at(options_.seconds));
    if (sent_ < script_.size()) until = std::min(until, at(script_[sent_].at));
    return until;
  }

  void send_due() {
    for (; sent_ < script_.size() && script_[sent_].at <= elapsed(); ++sent_) {
      // With an id it is answered, so that a refusal is noticed and an agreement printed.
      client_.post(script_[sent_].message);
    }
  }

  void take_control(const json& message, std::string_view text) {
    const std::string op = message.at("op");
    if (op == "scene") enter(message);
    if (op == "ok" && message.at("re") == added_) {
      ball_ = message.at("ball");
      if (!options_.velocity.empty()) throw_ball(*ball_);
    }
    if (op == "error") {
      if (message.contains("re") && message.at("re") == added_) awaits_ball_ = false;
      refused_ = true;
      std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data());
    } else if (op != "stats" && op != "welcome" && !options_.quiet) {
      std::printf("%.*s\n", static_cast<int>(text.size()), text.data());
    }
  }

  void enter(const json& scene) {
    exported_ = {scene.at("name"), {}, {}, scene.at("dt")};
    for (const json& cloth : scene.at("cloths")) exported_.cloths.push_back(cloth.at("name"));
    seen_.cloths.assign(exported_.cloths.size(), {});
    if (options_.velocity.empty() || added_ != 0 || thrown_) return;
    if (scene.at("balls").empty())
      throw std::runtime_error("the scene has no ball to throw: add one with --ball");
    throw_ball(scene.at("balls").at(0).at("ball"));
  }

  void throw_ball(std::uint32_t ball) {
    thrown_ = true;
    client_.post(protocol::BallThrow{ball, vector_of(options_.velocity)});
  }

  /// Frames count from the first that has the ball that was asked for: files have the bodies of their first.
  void take_frame(const net::SceneClient::Received& received) {
    const auto& balls = received.frame.balls;
    if (awaits_ball_ && ball_) {
      awaits_ball_ = std::none_of(balls.begin(), balls.end(),
                                  [&](const protocol::FrameBall& ball) { return ball.id == *ball_; });
    }
    if (awaits_ball_) return;
    write(received.frame);
    if (!options_.quiet) print(received.frame, received.bytes);
    ++frames_;
  }

  static void print(const protocol::Frame& frame, std::size_t bytes) {
    std::string levels, nodes;
    for (const protocol::ClothRecord& cloth : frame.cloths) {
      const char* comma = levels.empty() ? "" : ",";
      levels += comma + std::to_string(cloth.level);
      nodes += comma + std::to_string(cloth.rows * cloth.cols);
    }
    std::printf("frame %u  time %.4f s  level %s  nodes %s  bytes %zu\n", frame.stamp.frame, frame.stamp.time,
                levels.c_str(), nodes.c_str(), bytes);
  }

  void write(const protocol::Frame& frame) {
    if (options_.outputs.empty()) return;
    for (const protocol::ClothRecord& cloth : frame.cloths)
      seen_.cloths.at(cloth.cloth) = {0, 0, cloth.rows, cloth.cols, cloth.positions, {}, cloth.torn_faces};
    for (MeshFrame& cloth : seen_.cloths) {
      if (cloth.positions.empty()) return;  // it has not come yet
      cloth.frame = static_cast<int>(frame.stamp.frame);
      cloth.time = frame.stamp.time;
    }
    if (writers_.empty()) {
      bodies_ = SeenBodies(client_.scene(), frame, [&](std::size_t obstacle) { return mesh_text(obstacle); });
      exported_.bodies = bodies_.meshes();
      for (const std::string& path : options_.outputs) writers_.push_back(SceneWriter::open(path, exported_));
    }
    seen_.bodies = bodies_.poses(frame);
    for (const auto& writer : writers_) writer->write(seen_);
  }

  std::string mesh_text(std::size_t obstacle) const {
    net::Url url = url_;
    url.target =
        base_path(url.target) + std::string(kScenes) + exported_.name + "/meshes/" + std::to_string(obstacle);
    const net::HttpReply reply = net::http_get(url, kConnectTime, options_.security);
    if (reply.status != 200)
      throw std::runtime_error(url.target + ": the server answers " + std::to_string(reply.status));
    return reply.body;
  }

  const ClientOptions& options_;
  const net::Url url_;
  std::vector<Timed> script_;
  net::SceneClient client_;
  Clock::time_point start_;
  std::size_t sent_ = 0;               ///< of the script
  std::int64_t added_ = 0;             ///< id of the ball.add
  std::optional<std::uint32_t> ball_;  ///< that it added
  bool awaits_ball_ = false;           ///< no frame has had it so far
  bool thrown_ = false, refused_ = false;
  int frames_ = 0;
  ExportedScene exported_;                             ///< the scene joined
  SceneFrame seen_;                                    ///< the newest of each cloth and body
  SeenBodies bodies_;                                  ///< from the first frame that is written on
  std::vector<std::unique_ptr<SceneWriter>> writers_;  ///< from the first frame on
};

int check_health(net::Url url, const net::ClientSecurity& security) {
  url.target = base_path(url.target) + "healthz";
  const net::HttpReply reply = net::http_get(url, kConnectTime, security);
  std::printf("%u %s\n", reply.status, reply.body.c_str());
  return reply.status == 200 && reply.body == "ok" ? 0 : kFailed;
}

int client(const ClientOptions& options) {
  net::Url url = net::Url::parse(options.url);
  if (options.health) return check_health(url, options.security);
  if (url.target.ends_with('/')) url.target += std::string(kScenes) + options.scene;
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });
  return Conversation(options, url).run();
}

}  // namespace

void add_client(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ClientOptions>();
  CLI::App* command =
      app.add_subcommand("client", "Views and commands a scene of a running server, from a script");
  command
      ->add_option("URL", options->url,
                   "ws://HOST:PORT/v1/scenes/NAME, or http://HOST:PORT/ with --scene; behind a proxy, "
                   "http://HOST/PATH/; with TLS wss: and https:")
      ->required();
  command->add_option("--scene", options->scene, "Scene to join if the URL names none")->default_val("flag");
  auto* camera =
      command->add_option("--camera", options->distance, "The viewer's distance from every cloth, m");
  command->add_option("--eye", options->eye, "Where the viewer's eye is: X,Y,Z, m")
      ->delimiter(',')
      ->expected(3)
      ->excludes(camera);
  command->add_option("--wind", options->wind, "DX,DY,DZ,SPEED sets the wind, m/s")
      ->delimiter(',')
      ->expected(4);
  command->add_option("--ball", options->ball, "X,Y,Z,RADIUS adds a ball, m")->delimiter(',')->expected(4);
  command
      ->add_option("--throw", options->velocity, "VX,VY,VZ throws that ball, or else the scene's first, m/s")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--frames", options->frames, "Ends after so many frames (default: when interrupted)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seconds", options->seconds, "Ends after this time, s")->check(CLI::PositiveNumber);
  command
      ->add_option("--out", options->outputs,
                   "The scene as it comes, by extension: .glb, .usda, .obj (one file a frame) with its balls "
                   "and obstacles, or .pc2, .mdd and .csv, one a cloth; may be given several times")
      ->allow_extra_args(false);
  command->add_option("--script", options->script,
                      "Messages to send, one a line: a message of the protocol with \"at\", its time in s");
  command->add_option("--token", options->security.token, "The server's, where it asks for one")
      ->envname("WEFT_TOKEN");
  command
      ->add_option("--ca", options->security.authorities,
                   "Certificates (PEM) to trust with wss: and https: (default: the system's)")
      ->check(CLI::ExistingFile);
  command->add_flag("--reconnect", options->reconnect,
                    "Comes back when the connection breaks, to what it held as well");
  command->add_flag("--quiet", options->quiet, "Prints errors only");
  command->add_flag("--health", options->health, "Only asks whether the server is well (exit code 0: yes)");
  command->callback([options, &exit_code] { exit_code = client(*options); });
}

}  // namespace weft::cli
