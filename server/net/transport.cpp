#include "net/transport.h"

#include <boost/asio/socket_base.hpp>

namespace weft::net {

Transport::Tls& Transport::begin_tls(std::shared_ptr<boost::asio::ssl::context> context) {
  layers_->context = std::move(context);
  return layers_->tls.emplace(tcp(), *layers_->context);
}

void Transport::shake_hands(boost::asio::ssl::stream_base::handshake_type side,
                            boost::asio::const_buffer received, AnyHandler handler) {
  layers_->tls->async_handshake(side, received, std::move(handler));
}

void Transport::read_some(const BufferList<boost::asio::mutable_buffer>& buffers, AnyHandler handler) {
  if (layers_->tls) return layers_->tls->async_read_some(buffers, std::move(handler));
  tcp().async_read_some(buffers, std::move(handler));
}

void Transport::write_some(const BufferList<boost::asio::const_buffer>& buffers, AnyHandler handler) {
  if (layers_->tls) return layers_->tls->async_write_some(buffers, std::move(handler));
  tcp().async_write_some(buffers, std::move(handler));
}

void Transport::async_end(AnyHandler handler) {
  const auto end = [this](error_code error, AnyHandler& then) {
    error_code ignored;
    tcp().socket().shutdown(boost::asio::socket_base::shutdown_send, ignored);
    then(error);
  };
  if (!has_tls()) return end({}, handler);
  layers_->tls->async_shutdown(
      [end, then = std::move(handler)](error_code error) mutable { end(error, then); });
}

}  // namespace weft::net
