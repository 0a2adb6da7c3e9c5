#pragma once
/// How a client begins TLS. For the files that compile Boost.Beast's streams.
#include <string>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/ssl/host_name_verification.hpp>

#include "net/client.h"
#include "net/resolve.h"
#include "net/tls.h"
#include "net/transport.h"

namespace weft::net {

/// Begins TLS on a stream that is connected, with whom the URL names; handler(error_code) after the
/// handshake.
inline void begin_client_tls(Transport& stream, TlsContext context, const Url& url,
                             const ClientSecurity& security, AnyHandler handler) {
  Transport::Tls& tls = stream.begin_tls(std::move(context));
  const std::string name = unbracketed(url.host);
  if (security.check_certificate) {
    tls.set_verify_callback(boost::asio::ssl::host_name_verification(name));
  } else {
    tls.set_verify_mode(boost::asio::ssl::verify_none);
  }
  SSL_set_tlsext_host_name(tls.native_handle(), name.c_str());
  stream.shake_hands(boost::asio::ssl::stream_base::client, {}, std::move(handler));
}

}  // namespace weft::net
