#include "net/tls.h"

#include <stdexcept>

namespace weft::net {

namespace ssl = boost::asio::ssl;

namespace {

TlsContext context_of(ssl::context::method method) {
  auto context = std::make_shared<ssl::context>(method);
  context->set_options(ssl::context::default_workarounds | ssl::context::no_sslv2 | ssl::context::no_sslv3 |
                       ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1 | ssl::context::no_compression);
  return context;
}

void check(const boost::system::error_code& error, const char* what, const std::filesystem::path& file) {
  if (error) throw std::runtime_error(what + (" " + file.string()) + ": " + error.message());
}

}  // namespace

TlsContext server_tls(const std::filesystem::path& certificate, const std::filesystem::path& key) {
  TlsContext context = context_of(ssl::context::tls_server);
  // A key under a passphrase is an error, not a question on the terminal.
  context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); });
  boost::system::error_code error;
  context->use_certificate_chain_file(certificate.string(), error);
  check(error, "certificate", certificate);
  context->use_private_key_file(key.string(), ssl::context::pem, error);
  check(error, "private key", key);
  return context;
}

TlsContext client_tls(const std::filesystem::path& authorities) {
  TlsContext context = context_of(ssl::context::tls_client);
  boost::system::error_code error;
  if (authorities.empty()) {
    context->set_default_verify_paths(error);
    check(error, "certificates", "of the system");
  } else {
    context->load_verify_file(authorities.string(), error);
    check(error, "certificates", authorities);
  }
  context->set_verify_mode(ssl::verify_peer);
  return context;
}

}  // namespace weft::net
