#pragma once
#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/client/script.h"
#include "cli/seen_bodies.h"
#include "cli/writers/scene_writer.h"
#include "cloth/core/clock.h"
#include "net/client.h"
#include "net/scene_client.h"
#include "protocol/frame.h"

namespace weft::cli {

/// For the server to take a connection, and to answer a request.
inline constexpr auto kConnectTime = std::chrono::seconds(5);
/// Below the server's path.
inline constexpr std::string_view kScenesPath = "v1/scenes/";

/// What `weft client` is asked for; what is empty or 0 is not.
struct ClientOptions {
  std::string url;
  std::string scene;
  std::optional<double> distance;  ///< m
  std::vector<double> eye, wind, ball, velocity;
  int frames = 0;
  double seconds = 0;  ///< s
  std::vector<std::string> outputs;
  std::string script;
  net::ClientSecurity security;
  bool quiet = false, health = false, reconnect = false;
};

/// The path that everything of the server at `target` is below, with a slash at its end: of a scene's there,
/// or of the page's.
std::string base_path(const std::string& target);

/// A conversation with one server, from connecting to the last frame wanted.
class Conversation {
 public:
  /// Connects, in kConnectTime; a script that is asked for is read before. `options` must outlive it.
  Conversation(const ClientOptions& options, const net::Url& url);

  /// Until the frames or the time asked for are over, or `stop` is not 0. The exit code: kFailed where
  /// the server refused something. Throws net::ConnectionError, after what has come is written.
  int run(const volatile std::sig_atomic_t& stop);

 private:
  void finish_files();
  double elapsed() const;
  bool finished() const;
  Clock::time_point next_event() const;
  void send_due();
  void take_control(const nlohmann::json& message, std::string_view text);
  void enter(const nlohmann::json& scene);
  void throw_ball(std::uint32_t ball);
  /// Frames count from the first that has the ball that was asked for: files have the bodies of their first.
  void take_frame(const net::SceneClient::Received& received);
  void write(const protocol::Frame& frame);
  std::string mesh_text(std::size_t obstacle) const;

  const ClientOptions& options_;
  const net::Url url_;
  const volatile std::sig_atomic_t* stop_ = nullptr;
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

}  // namespace weft::cli
