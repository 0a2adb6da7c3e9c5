#include "net/answers.h"

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace weft::net {

namespace http = boost::beast::http;

namespace {

/// A scene that has been at one step for so long is reported.
constexpr std::chrono::duration<double> kStuckTime{5.0};

}  // namespace

Answer plain(http::status status, std::string text) {
  return {status, std::make_shared<const std::string>(std::move(text))};
}

Answer json_answer(http::status status, std::string text) {
  Answer answer = plain(status, std::move(text));
  answer.media_type = "application/json";
  return answer;
}

Answer health(const Context& context) {
  std::string late;
  for (const auto& scene : context.host.scenes()) {
    const std::chrono::duration<double> busy = scene->busy_for();
    if (busy < kStuckTime) continue;
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1f", busy.count());
    late += "scene " + scene->name() + ": no step for " + seconds + " s\n";
  }
  return late.empty() ? plain(http::status::ok, "ok")
                      : plain(http::status::service_unavailable, std::move(late));
}

Answer readiness(const Context& context) {
  if (context.stopping) return plain(http::status::service_unavailable, "the server stops\n");
  if (context.connections.taken() >= context.options.max_connections)
    return plain(http::status::service_unavailable, "all connections are taken\n");
  return health(context);
}

Answer metrics(const Context& context) {
  host::Metrics& counts = context.host.metrics();
  counts.connections(context.connections.taken());
  counts.viewers(context.viewers);
  for (std::size_t i = 0; i < context.loops.size(); ++i) counts.network_thread(i, context.loops[i]->cpu());
  Answer answer = plain(http::status::ok, counts.text());
  answer.media_type = "text/plain; version=0.0.4; charset=utf-8";
  return answer;
}

Answer no_place(const Context& context, NoPlace why) {
  if (why == NoPlace::all_taken)
    return plain(http::status::service_unavailable,
                 std::to_string(context.options.max_connections) +
                     " connections are open, the most allowed (--connections)\n");
  return plain(http::status::too_many_requests, std::to_string(context.options.max_connections_per_address) +
                                                    " connections from your address are open, the most "
                                                    "allowed (--connections-per-address)\n");
}

Answer not_made(const host::NotMade& no) {
  using Why = host::NotMade::Why;
  nlohmann::json problems = nlohmann::json::array();
  for (const scene::Problem& problem : no.problems)
    problems.push_back({{"path", problem.path}, {"message", problem.message}});
  const auto status = no.why == Why::exists      ? http::status::conflict
                      : no.why == Why::full      ? http::status::service_unavailable
                      : no.why == Why::too_large ? http::status::payload_too_large
                                                 : http::status::unprocessable_entity;
  const nlohmann::json body{{"message", no.text}, {"problems", problems}};
  return json_answer(status, body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace weft::net
