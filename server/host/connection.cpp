#include "host/connection.h"

#include <algorithm>
#include <utility>

#include "host/server_clock.h"
#include "protocol/plain_ack.h"

namespace weft::host {

using nlohmann::json;
using protocol::Request;

Connection::Connection(Host& host, std::shared_ptr<SceneRunner> scene, protocol::Role role,
                       std::string_view server_version)
    : host_(host),
      scene_(std::move(scene)),
      role_(role),
      rate_(host.limits().messages_per_second, std::chrono::steady_clock::now()),
      excess_(host.limits().messages_per_second / 2, std::chrono::steady_clock::now()) {
  send(protocol::welcome_text(server_version, host.instance(), role, host.limits()));
  visit_ = viewer_->enter();
  scene_->join(viewer_, visit_);
}

Connection::~Connection() {
  scene_->leave(viewer_, visit_, !parted_);
  scene_->give_back();
}

bool Connection::take_plain_ack(std::string_view text) {
  const auto frame = protocol::read_plain_ack(text);
  return frame && viewer_->acknowledge(*frame);
}

Connection::Pace Connection::receive(std::string_view text, TimePoint now) {
  auto parsed = protocol::parse_request(text, host_.limits());
  const Request* request = std::get_if<Request>(&parsed);
  // An acknowledgement of a frame that was sent is as frequent as the frames are; losing it would stop them.
  if (const auto* ack = request ? std::get_if<protocol::Ack>(&request->command) : nullptr) {
    if (viewer_->acknowledge(ack->f)) {
      ok(*request, json::object());
      return Pace::go_on;
    }
  }
  if (!rate_.allow(now)) {
    if (!excess_.allow(now)) return Pace::end;
    protocol::Error error{std::nullopt, "rate", "",
                          "more than " + std::to_string(host_.limits().messages_per_second) +
                              " messages in a second; this one was dropped"};
    error.re = request ? request->id : std::get<protocol::Error>(parsed).re;
    refuse(error);
    return Pace::slow_down;
  }
  if (request) {
    if (may_give(*request))
      std::visit([&](const auto& command) { answer(*request, command); }, request->command);
  } else {
    refuse(std::get<protocol::Error>(parsed));
  }
  return Pace::go_on;
}

bool Connection::may_give(const Request& request) {
  const protocol::Role needed = protocol::role_for(request.command);
  if (role_ >= needed) return true;
  refuse(request, "forbidden", "/op",
         "this connection's role is " + std::string(name_of(role_)) +
             "; allowed: " + std::string(name_of(needed)) + " and above");
  return false;
}

void Connection::answer(const Request& request, const protocol::Hello& hello) {
  json common = json::array();
  for (const std::string_view known : protocol::kCapabilities) {
    if (std::find(hello.caps.begin(), hello.caps.end(), known) == hello.caps.end()) continue;
    common.push_back(known);
    if (known == "flow.ack") viewer_->enable_acks(hello.window);
    if (known == "flow.level") viewer_->enable_levels();
    if (known == "grid.rice") viewer_->enable_rice();
  }
  ok(request, {{"caps", common}});
}

void Connection::answer(const Request& request, const protocol::SceneList&) {
  ok(request, {{"scenes", host_.list()}});
}

void Connection::answer(const Request& request, const protocol::SceneJoin& join) {
  std::shared_ptr<SceneRunner> next = host_.find(join.scene);
  if (!next) {
    return refuse(request, "not_found", "/scene", "there is no scene named \"" + join.scene + "\"");
  }
  // Its own scene again: it keeps its place.
  if (next != scene_ && !next->reserve()) {
    return refuse(request, "limit", "/scene",
                  "scene \"" + join.scene + "\" has " + std::to_string(host_.limits().viewers) +
                      " viewers, the most allowed");
  }
  scene_->leave(viewer_, visit_);
  if (next != scene_) scene_->give_back();
  scene_ = std::move(next);
  visit_ = viewer_->enter();
  ok(request, json::object());
  scene_->join(viewer_, visit_);
}

/// One that acknowledges nothing: harmless, for example of the scene before.
void Connection::answer(const Request& request, const protocol::Ack&) { ok(request, json::object()); }

/// After the replies to all commands before it: at once if there are none to come, so that it measures the
/// way and not the step in hand.
void Connection::answer(const Request& request, const protocol::Ping& ping) {
  const auto pong = [id = request.id, t = ping.t](const SceneRunner& scene) {
    return make_text(protocol::pong_text(id, t, scene.frame(), scene.time(), server_ms()));
  };
  if (viewer_->all_answered()) return viewer_->send(pong(*scene_));
  const auto later = [pong, scene = scene_.get(), viewer = viewer_] { viewer->send(pong(*scene)); };
  if (!scene_->submit(viewer_, visit_, later)) too_many_wait(request);
}

template <class Command>
void Connection::answer(const Request& request, const Command& command) {
  if (!scene_->submit(viewer_, visit_, SceneRequest{request.id, SceneCommand(command)}))
    too_many_wait(request);
}

void Connection::too_many_wait(const Request& request) {
  refuse(request, "limit", "",
         std::to_string(SceneRunner::kMaxWaiting) + " commands wait for the scene's next step already");
}

void Connection::ok(const Request& request, const json& extra) {
  if (request.id) send(protocol::ok_text(*request.id, scene_->frame(), extra));
}

void Connection::refuse(const Request& request, const char* code, const char* path, std::string message) {
  refuse({request.id, code, path, std::move(message)});
}

void Connection::refuse(const protocol::Error& error) {
  host_.metrics().refused_command(error.code);
  send(protocol::error_text(error));
}

void Connection::send(std::string text) { viewer_->send(make_text(std::move(text))); }

}  // namespace weft::host
