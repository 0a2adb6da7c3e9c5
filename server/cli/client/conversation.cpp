#include "cli/client/conversation.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "cli/exit_codes.h"

namespace weft::cli {
namespace {

using Seconds = std::chrono::duration<double>;
using nlohmann::json;

/// How often the loop looks whether it was interrupted.
constexpr auto kPoll = std::chrono::milliseconds(200);

protocol::Vector vector_of(const std::vector<double>& values) { return {values[0], values[1], values[2]}; }

void print(const protocol::Frame& frame, std::size_t bytes) {
  std::string levels, nodes;
  for (const protocol::ClothRecord& cloth : frame.cloths) {
    const char* comma = levels.empty() ? "" : ",";
    levels += comma + std::to_string(cloth.level);
    nodes += comma + std::to_string(cloth.rows * cloth.cols);
  }
  std::printf("frame %u  time %.4f s  level %s  nodes %s  bytes %zu\n", frame.stamp.frame, frame.stamp.time,
              levels.c_str(), nodes.c_str(), bytes);
}

}  // namespace

std::string base_path(const std::string& target) {
  const std::string base = target.substr(0, target.find(kScenesPath));
  return base.ends_with('/') ? base : base + '/';
}

Conversation::Conversation(const ClientOptions& options, const net::Url& url)
    : options_(options),
      url_(url),
      script_(options.script.empty() ? std::vector<Timed>{} : read_script(options.script)),
      client_(url, {.limit = kConnectTime,
                    .security = options.security,
                    .reconnect = options.reconnect,
                    .on_message = [this](const json& message, std::string_view text) {
                      take_control(message, text);
                    }}) {}

int Conversation::run(const volatile std::sig_atomic_t& stop) {
  stop_ = &stop;
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

void Conversation::finish_files() {
  for (const auto& writer : writers_) writer->finish();
}

double Conversation::elapsed() const { return Seconds(Clock::now() - start_).count(); }

bool Conversation::finished() const {
  return *stop_ != 0 || std::ferror(stdout) || (options_.frames > 0 && frames_ >= options_.frames) ||
         (options_.seconds > 0 && elapsed() >= options_.seconds);
}

Clock::time_point Conversation::next_event() const {
  auto until = Clock::now() + kPoll;
  const auto at = [&](double seconds) {
    return start_ + std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
  };
  if (options_.seconds > 0) until = std::min(until, at(options_.seconds));
  if (sent_ < script_.size()) until = std::min(until, at(script_[sent_].at));
  return until;
}

void Conversation::send_due() {
  for (; sent_ < script_.size() && script_[sent_].at <= elapsed(); ++sent_) {
    // With an id it is answered, so that a refusal is noticed and an agreement printed.
    client_.post(script_[sent_].message);
  }
}

void Conversation::take_control(const json& message, std::string_view text) {
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

void Conversation::enter(const json& scene) {
  exported_ = {scene.at("name"), {}, {}, scene.at("dt")};
  for (const json& cloth : scene.at("cloths")) exported_.cloths.push_back(cloth.at("name"));
  seen_.cloths.assign(exported_.cloths.size(), {});
  if (options_.velocity.empty() || added_ != 0 || thrown_) return;
  if (scene.at("balls").empty())
    throw std::runtime_error("the scene has no ball to throw: add one with --ball");
  throw_ball(scene.at("balls").at(0).at("ball"));
}

void Conversation::throw_ball(std::uint32_t ball) {
  thrown_ = true;
  client_.post(protocol::BallThrow{ball, vector_of(options_.velocity)});
}

void Conversation::take_frame(const net::SceneClient::Received& received) {
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

void Conversation::write(const protocol::Frame& frame) {
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

std::string Conversation::mesh_text(std::size_t obstacle) const {
  net::Url url = url_;
  url.target = base_path(url.target) + std::string(kScenesPath) + exported_.name + "/meshes/" +
               std::to_string(obstacle);
  const net::HttpReply reply = net::http_get(url, kConnectTime, options_.security);
  if (reply.status != 200)
    throw std::runtime_error(url.target + ": the server answers " + std::to_string(reply.status));
  return reply.body;
}

}  // namespace weft::cli
