#include "net/routes.h"

#include <spdlog/spdlog.h>

#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "net/credentials.h"
#include "net/origin.h"
#include "net/websocket_session.h"

namespace weft::net {

namespace http = boost::beast::http;

namespace {

constexpr std::string_view kHealth = "/healthz", kReady = "/readyz", kMetrics = "/metrics",
                           kScenes = "/v1/scenes", kScene = "/v1/scenes/", kMeshes = "/meshes/";

/// One request on its way to its outcome.
class Route {
 public:
  Route(Context& context, const HttpRequest& request, const Caller& caller)
      : context_(context), request_(request), caller_(caller) {}

  Outcome find() {
    if (const std::string fault = header_fault(request_); !fault.empty())
      return last(plain(http::status::bad_request, fault + "\n"));
    if (request_.count(http::field::host) > 0 &&
        !host_allowed(view(request_[http::field::host]), context_.options.names))
      return plain(http::status::misdirected_request,
                   "this server does not know the name in Host as its own (--host-name)\n");
    const std::string_view target = view(request_.target());
    const std::string_view path = target.substr(0, target.find('?'));
    const http::verb method = request_.method();
    const bool of_scenes = path == kScenes || path.starts_with(kScene);
    // A browser asks so whether a page from elsewhere may show a token.
    if (of_scenes && method == http::verb::options) return plain(http::status::no_content, "");
    const bool changes = method == http::verb::put || method == http::verb::delete_;
    if (changes && path.starts_with(kScene)) return change_scenes(std::string(path.substr(kScene.size())));
    if (method != http::verb::get && method != http::verb::head)
      return plain(http::status::method_not_allowed, "only GET and HEAD, and PUT and DELETE of scenes\n");
    if (path == kHealth) return health(context_);
    if (path == kReady) return readiness(context_);
    if (auto refusal = find_place()) return *std::move(refusal);
    if (path == kMetrics) return metrics_if_allowed();
    return of_scenes ? scenes(path) : file(target, path);
  }

 private:
  /// The connection ends with it.
  static Answer last(Answer answer) {
    answer.last = true;
    return answer;
  }

  /// Why the client is not served on this connection, if it is not.
  std::optional<Answer> find_place() const {
    if (caller_.no_place != NoPlace::none) return no_place(context_, caller_.no_place);
    if (caller_.must_be_secure) return secure_address();
    return std::nullopt;
  }

  Answer secure_address() const {
    Answer answer = plain(http::status::permanent_redirect, "this server speaks TLS: https: and wss:\n");
    answer.location =
        "https://" + std::string(view(request_[http::field::host])) + std::string(view(request_.target()));
    return answer;
  }

  /// What the client may do; an answer if it may do nothing.
  std::optional<Answer> find_role() {
    const Credentials credentials = credentials_of(request_);
    if (!credentials.fault.empty()) return plain(http::status::bad_request, credentials.fault + "\n");
    const auto role = context_.secrets.get()->access.role_of(credentials.token);
    if (role) {
      role_ = *role;
      return std::nullopt;
    }
    return plain(http::status::unauthorized, credentials.token
                                                 ? "the token is not one of this server's\n"
                                                 : "a token is needed: Authorization: Bearer TOKEN\n");
  }

  /// A page from elsewhere, which uses what the browser knows, may not.
  std::optional<Answer> find_origin() const {
    if (origin_allowed(view(request_[http::field::origin]), view(request_[http::field::host]),
                       context_.options.allowed_origins))
      return std::nullopt;
    return plain(http::status::forbidden, "this page's origin is not allowed (--allow-origin)\n");
  }

  /// For those who run the server.
  Answer metrics_if_allowed() {
    if (auto refusal = find_role()) return *std::move(refusal);
    if (role_ < protocol::Role::admin) return plain(http::status::forbidden, "only for the role admin\n");
    return metrics(context_);
  }

  Outcome scenes(std::string_view path) {
    if (auto refusal = find_role()) return *std::move(refusal);
    if (path == kScenes || path == kScene) {
      const nlohmann::json list = {{"scenes", context_.host.list()}};
      return json_answer(http::status::ok, list.dump());
    }
    const std::string_view name = path.substr(kScene.size());
    const std::size_t meshes = name.find(kMeshes);
    if (meshes == name.npos) return open_scene(name);
    const auto text = find_mesh(name.substr(0, meshes), name.substr(meshes + kMeshes.size()));
    if (!text) return plain(http::status::not_found, "there is no such mesh\n");
    return Answer{http::status::ok, text, "application/json", ""};
  }

  /// The mesh that GET /v1/scenes/NAME/meshes/OBSTACLE asks for; nullptr if there is none.
  std::shared_ptr<const std::string> find_mesh(std::string_view name, std::string_view number) const {
    const auto scene = context_.host.find(name);
    std::size_t obstacle = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), obstacle);
    if (!scene || error != std::errc() || end != number.data() + number.size()) return nullptr;
    return scene->mesh(obstacle);
  }

  /// PUT and DELETE of /v1/scenes/NAME.
  Outcome change_scenes(std::string name) {
    if (auto refusal = find_place()) return *std::move(refusal);
    if (auto refusal = find_role()) return *std::move(refusal);
    if (auto refusal = find_origin()) return *std::move(refusal);
    if (role_ < protocol::Role::admin)
      return plain(http::status::forbidden, "scenes are made and ended by the role admin alone\n");
    if (request_.method() == http::verb::delete_) return end_scene(name);
    return SceneToMake{std::move(name)};
  }

  Answer end_scene(const std::string& name) {
    const auto scene = context_.host.find(name);
    switch (context_.host.end(name)) {
      case host::Host::Ending::unknown:
        return plain(http::status::not_found, "there is no such scene\n");
      case host::Host::Ending::own:
        return plain(http::status::conflict, "this scene is the server's own\n");
      case host::Host::Ending::ended:
        break;
    }
    end_websocket_sessions_in(context_, scene);
    spdlog::info("scene {}: ended by a client", name);
    return plain(http::status::no_content, "");
  }

  /// The upgrade of GET /v1/scenes/NAME, or why not.
  Outcome open_scene(std::string_view name) {
    if (auto refusal = find_origin()) return *std::move(refusal);
    auto scene = context_.host.find(name);
    if (!scene) return plain(http::status::not_found, "there is no such scene\n");
    if (!boost::beast::websocket::is_upgrade(request_))
      return plain(http::status::upgrade_required, "a scene is a WebSocket\n");
    if (request_[http::field::sec_websocket_version] != kWebsocketVersion)
      return plain(http::status::upgrade_required, "Sec-WebSocket-Version must be 13\n");
    if (const std::string fault = upgrade_fault(request_); !fault.empty())
      return plain(http::status::bad_request, fault + "\n");
    if (caller_.sent_more)
      return last(plain(http::status::bad_request, "nothing may be sent before the upgrade is answered\n"));
    if (context_.stopping || !scene->reserve())
      return plain(http::status::service_unavailable, "the scene has no place for another viewer\n");
    return SceneToOpen{std::move(scene), role_};
  }

  Answer file(std::string_view target, std::string_view path) const {
    if (const auto found = context_.files.find(target)) {
      if (view(request_[http::field::if_none_match]) == found->etag)
        return {http::status::not_modified, nullptr, found->media_type, found->etag};
      return {http::status::ok, found->content, found->media_type, found->etag};
    }
    const bool page_missing = path == "/" && context_.options.web.empty();
    return plain(http::status::not_found,
                 page_missing ? "this server was started without a page\n" : "not found\n");
  }

  Context& context_;
  const HttpRequest& request_;
  const Caller& caller_;
  protocol::Role role_ = protocol::Role::view;
};

}  // namespace

Outcome outcome_of(Context& context, const HttpRequest& request, const Caller& caller) {
  return Route(context, request, caller).find();
}

}  // namespace weft::net
