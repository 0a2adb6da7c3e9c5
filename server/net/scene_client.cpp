#include "net/scene_client.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "protocol/message.h"

namespace weft::net {

using nlohmann::json;

namespace {

constexpr std::size_t kShownBytes = 60;  // of what cannot be read

}  // namespace

SceneClient::SceneClient(const Url& url, SceneClientOptions options)
    : options_(std::move(options)), client_(url, options_.limit, options_.security) {
  post(protocol::Hello{options_.name, {"flow.ack"}, options_.window});
}

json SceneClient::ask(const protocol::Command& command) {
  answer_ = nullptr;
  asked_ = post(command);
  const TimePoint until = std::chrono::steady_clock::now() + options_.limit;
  while (answer_.is_null()) {
    auto message = client_.receive(until);
    if (!message) throw ConnectionError("no answer within " + std::to_string(options_.limit.count()) + " ms");
    take(std::move(*message));
  }
  asked_ = 0;
  if (answer_.at("op") == "error") {
    // A server that does not keep to the protocol may leave any of them out.
    const auto text = [&](const char* name) {
      const auto member = answer_.find(name);
      return member != answer_.end() && member->is_string() ? member->get<std::string>() : std::string();
    };
    throw RefusedError(text("message"), text("code"), text("path"));
  }
  return std::move(answer_);
}

std::int64_t SceneClient::post(const protocol::Command& command) {
  client_.send(protocol::to_text({++last_id_, command}));
  return last_id_;
}

void SceneClient::post(json message) {
  if (!message.contains("id")) message["id"] = ++last_id_;
  client_.send(message.dump());
}

std::optional<SceneClient::Received> SceneClient::next_frame(TimePoint until) {
  while (newest_.empty()) {
    auto message = client_.receive(until);
    if (!message) return std::nullopt;
    take(std::move(*message));
  }
  const std::vector<std::uint8_t> bytes = std::exchange(newest_, {});
  Received received{{}, bytes.size()};
  std::string error;
  if (!protocol::decode_frame(bytes, received.frame, error))
    throw std::runtime_error("a malformed frame: " + error);
  client_.send(protocol::to_text({std::nullopt, protocol::Ack{received.frame.stamp.frame}}));
  return received;
}

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
  if (message.at("op") == "scene") scene_ = message;
  if (asked_ != 0 && message.value("re", json()) == asked_) answer_ = message;
  if (options_.on_message) options_.on_message(message, text);
}

}  // namespace weft::net
