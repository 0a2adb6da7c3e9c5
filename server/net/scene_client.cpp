#include "net/scene_client.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <variant>

#include "protocol/message.h"

namespace weft::net {

using nlohmann::json;

namespace {

constexpr std::size_t kShownBytes = 60;  // of what cannot be read
/// Before the first attempt to come back, and at most (PROTOCOL.md section 5); jittered down to half.
constexpr double kFirstWait = 0.25, kLongestWait = 10;  // s
/// How long a newer frame is waited for in place of one that is late: a round trip and a step.
constexpr std::chrono::milliseconds kNewer{200};
/// What is held waits 5 s; in these there are fewer attempts.
constexpr std::size_t kMostSeats = 8;

/// A server that does not keep to the protocol may leave any of them out.
std::string member_text(const json& message, const char* name) {
  const auto member = message.find(name);
  return member != message.end() && member->is_string() ? member->get<std::string>() : std::string();
}

RefusedError refusal(const json& error) {
  return {member_text(error, "message"), member_text(error, "code"), member_text(error, "path")};
}

/// The URL of another scene of the same server: its target ends with the scene's name.
Url beside(Url url, const std::string& scene) {
  const std::size_t end = std::min(url.target.find('?'), url.target.size());
  const std::size_t begin = url.target.rfind('/', end) + 1;
  url.target.replace(begin, end - begin, scene);
  return url;
}

}  // namespace

SceneClient::SceneClient(const Url& url, SceneClientOptions options)
    : url_(url), options_(std::move(options)) {
  connect();
}

json SceneClient::ask(const protocol::Command& command) {
  if (!client_ && !come_back(std::chrono::steady_clock::now() + options_.limit))
    throw ConnectionError("the connection has not been made again within " +
                          std::to_string(options_.limit.count()) + " ms");
  return await(post(command));
}

json SceneClient::await(std::int64_t id) {
  answer_ = nullptr;
  asked_ = id;
  const TimePoint until = std::chrono::steady_clock::now() + options_.limit;
  while (answer_.is_null()) {
    auto message = receive(until);
    if (!message) throw ConnectionError("no answer within " + std::to_string(options_.limit.count()) + " ms");
    take(std::move(*message));
  }
  asked_ = 0;
  if (answer_.at("op") == "error") throw refusal(answer_);
  return std::move(answer_);
}

std::int64_t SceneClient::post(const protocol::Command& command) {
  const std::int64_t id = ++last_id_;
  remember(command);
  send(protocol::to_text({id, command}));
  return id;
}

void SceneClient::post(json message) {
  if (!message.contains("id")) message["id"] = ++last_id_;
  send(message.dump());
}

std::optional<Client::Message> SceneClient::receive(TimePoint until) {
  try {
    return client_->receive(until);
  } catch (const ConnectionError& error) {
    lose(error.what());
    throw;
  }
}

void SceneClient::send(const std::string& text) {
  if (!client_) throw ConnectionError(ended_);
  try {
    client_->send(text);
  } catch (const ConnectionError& error) {
    lose(error.what());
    throw;
  }
}

void SceneClient::remember(const protocol::Command& command) {
  if (const auto* camera = std::get_if<protocol::Camera>(&command)) camera_ = *camera;
  if (const auto* release = std::get_if<protocol::GrabRelease>(&command)) held_.erase(release->grab);
  if (const auto* join = std::get_if<protocol::SceneJoin>(&command)) joining_ = {last_id_, join->scene};
}

std::optional<SceneClient::Received> SceneClient::next_frame(TimePoint until) {
  while (newest_.empty()) {
    if (!client_ && !come_back(until)) return std::nullopt;
    try {
      if (!read_frame(until)) return std::nullopt;
    } catch (const ConnectionError&) {
      if (newest_.empty() && !comes_back()) throw;
    }
  }
  Received received = take_newest();
  const TimePoint end = std::min(until, std::chrono::steady_clock::now() + kNewer);
  try {
    while (client_ && arrivals_.late(received.frame.stamp.server_ms) &&
           std::chrono::steady_clock::now() < end && read_frame(end))
      received = take_newest();
  } catch (const ConnectionError&) {  // this is the last one
  }
  if (client_) arrivals_.taken(received.frame.stamp.server_ms);
  return received;
}

bool SceneClient::read_frame(TimePoint until) {
  // What has come already is read without waiting.
  while (auto message = receive(newest_.empty() ? until : std::chrono::steady_clock::now()))
    take(std::move(*message));
  return !newest_.empty();
}

SceneClient::Received SceneClient::take_newest() {
  const std::vector<std::uint8_t> bytes = std::exchange(newest_, {});
  Received received{{}, bytes.size()};
  std::string error;
  if (!protocol::decode_frame(bytes, received.frame, error))
    throw std::runtime_error("a malformed frame: " + error);
  if (!acks_ || !client_) return received;
  try {
    send(protocol::to_text({std::nullopt, protocol::Ack{received.frame.stamp.frame}}));
  } catch (const ConnectionError&) {
    if (!comes_back()) throw;
  }
  return received;
}

void SceneClient::close() {
  closed_ = true;
  if (client_) client_->close();
  client_.reset();
}

// --- Connections ---

void SceneClient::connect() {
  scene_ = nullptr;
  client_ = std::make_unique<Client>(url_, options_.limit, options_.security);
  newest_.clear();
  arrivals_ = {};
  capabilities_.clear();
  acks_ = false;
  joining_.reset();
  std::vector<std::string> wanted{"flow.ack"};
  if (options_.compact) wanted.emplace_back("grid.rice");
  if (options_.coarser) wanted.emplace_back("flow.level");
  hello_ = post(protocol::Hello{options_.name, std::move(wanted), options_.window});
}

bool SceneClient::come_back(TimePoint until) {
  if (!comes_back()) throw ConnectionError(ended_);
  while (!client_) {
    std::this_thread::sleep_until(std::min(next_attempt_, until));
    if (next_attempt_ > until) return false;
    try {
      connect();
      restore();
      attempts_ = 0;
    } catch (const ConnectionError& error) {
      if (client_) {
        lose(error.what());
      } else {
        plan_attempt();
      }
    }
  }
  return true;
}

void SceneClient::restore() {
  await(hello_);  // the scene has come before
  if (camera_) {
    try {
      await(post(*camera_));
    } catch (const RefusedError&) {  // refused then, it is refused now
    }
  }
  std::vector<std::uint32_t> grabs;
  for (const Seat& seat : seats_) {
    if (seat.scene != member_text(scene_, "name")) continue;
    try {
      grabs = await(post(protocol::SeatResume{seat.token})).at("grabs").get<std::vector<std::uint32_t>>();
    } catch (const RefusedError&) {  // too late: all is released
    }
  }
  seats_.clear();
  // What it let go of meanwhile, and what it does not hold any more.
  for (const std::uint32_t grab : grabs) {
    if (held_.count(grab) == 0) post(protocol::GrabRelease{grab});
  }
  std::erase_if(
      held_, [&](std::uint32_t grab) { return std::find(grabs.begin(), grabs.end(), grab) == grabs.end(); });
}

void SceneClient::lose(const char* why) {
  ended_ = why;
  // One that breaks before it has taken over what an older one held is only the next to be asked for.
  const std::string token = member_text(scene_, "seat");
  if (held_.empty()) {
    seats_.clear();
  } else if (!token.empty()) {
    seats_.push_back({member_text(scene_, "name"), token});
    if (seats_.size() > kMostSeats) seats_.erase(seats_.begin());
  }
  client_.reset();
  asked_ = hello_ = 0;
  plan_attempt();
}

void SceneClient::plan_attempt() {
  const double wait = std::min(kLongestWait, kFirstWait * (1 << std::min(attempts_++, 10)));
  const std::chrono::duration<double> jittered(wait *
                                               std::uniform_real_distribution<double>(0.5, 1)(random_));
  next_attempt_ = std::chrono::steady_clock::now() +
                  std::chrono::duration_cast<std::chrono::steady_clock::duration>(jittered);
}

// --- What comes ---

void SceneClient::take(Client::Message message) {
  if (message.binary) {
    newest_ = std::move(message.bytes);
  } else {
    take_control(message.text());
  }
}

void SceneClient::take_control(std::string_view text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object() || !message.contains("op")) {
    throw std::runtime_error("not a message of the protocol: " + std::string(text.substr(0, kShownBytes)));
  }
  const std::string op = member_text(message, "op");
  if (op == "scene") scene_ = message;
  if (op == "event" && member_text(message, "kind") == "reset") held_.clear();
  if (op == "ok" || op == "error" || op == "pong") take_answer(message);
  if (options_.on_message) options_.on_message(message, text);
}

void SceneClient::take_answer(const json& message) {
  const json re = message.value("re", json());
  if (asked_ != 0 && re == asked_) answer_ = message;
  const bool ok = message.at("op") == "ok";
  if (hello_ != 0 && re == hello_) {
    hello_ = 0;
    if (!ok) throw refusal(message);
    if (const auto caps = message.find("caps"); caps != message.end() && caps->is_array())
      capabilities_ = caps->get<std::vector<std::string>>();
    acks_ = std::find(capabilities_.begin(), capabilities_.end(), "flow.ack") != capabilities_.end();
  }
  if (joining_ && re == joining_->first) {
    if (ok) {
      url_ = beside(url_, joining_->second);
      held_.clear();
    }
    joining_.reset();
  }
  if (const auto grab = message.find("grab"); ok && grab != message.end() && grab->is_number_unsigned())
    held_.insert(grab->get<std::uint32_t>());
}

}  // namespace weft::net
