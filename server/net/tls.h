#pragma once
/// TLS's settings at both ends: version 1.2 or newer.
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/ssl/context.hpp>

namespace weft::net {

using TlsContext = std::shared_ptr<boost::asio::ssl::context>;

/// A server's, with its certificate chain and private key (PEM). Throws std::runtime_error, naming the file,
/// if one cannot be used or they do not belong together.
TlsContext server_tls(const std::filesystem::path& certificate, const std::filesystem::path& key);

/// A client's, who trusts the certificates in `authorities` (PEM), or where that is empty, the system's.
/// Throws as server_tls.
TlsContext client_tls(const std::filesystem::path& authorities);

}  // namespace weft::net
