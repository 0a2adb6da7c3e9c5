#include "net/network_loop.h"

#include <pthread.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "net/websocket_session.h"

namespace weft::net {

void NetworkLoop::run() {
  clockid_t clock = CLOCK_REALTIME;
  if (pthread_getcpuclockid(pthread_self(), &clock) == 0) clock_ = clock;
  io_.run();
  clock_ = CLOCK_REALTIME;
}

void NetworkLoop::wake(std::weak_ptr<WebsocketSession> viewer) {
  if (!woken_.add(std::move(viewer))) return;
  boost::asio::post(io_, [this] { woken_.go_round(send_what_waits); });
}

double NetworkLoop::cpu() const {
  const clockid_t clock = clock_;
  timespec time{};
  if (clock == CLOCK_REALTIME || clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace weft::net
