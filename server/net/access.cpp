#include "net/access.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "protocol/strict_json.h"

namespace weft::net {
namespace {

using nlohmann::json;
using protocol::Role;

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20, kMaxTokens = 1024;
constexpr int kMaxDepth = 8;
constexpr const char* kRoles = "\"view\", \"control\" or \"admin\"";

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot be read");
  std::string text(kMaxFileBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kMaxFileBytes)
    throw std::runtime_error("has more than " + std::to_string(kMaxFileBytes) + " bytes");
  return text;
}

std::runtime_error unknown(const std::string& path, const std::string& member, const std::string& allowed) {
  return std::runtime_error(path + "/" + member + " is unknown; allowed: " + allowed);
}

/// `allowed`: the members that `object` may have.
void check_members(const json& object, const std::string& path,
                   const std::vector<std::string_view>& allowed) {
  std::string names;
  for (const std::string_view name : allowed) names.append(names.empty() ? "" : ", ").append(name);
  if (!object.is_object())
    throw std::runtime_error((path.empty() ? "the document" : path) + " must be an object of " + names);
  for (const auto& member : object.items()) {
    if (std::find(allowed.begin(), allowed.end(), member.key()) == allowed.end())
      throw unknown(path, member.key(), names);
  }
}

Role read_role(const json& value, const std::string& path) {
  const auto role =
      value.is_string() ? protocol::role_named(value.get_ref<const std::string&>()) : std::nullopt;
  if (!role) throw std::runtime_error(path + " is " + value.dump() + "; allowed: " + kRoles);
  return *role;
}

int digit_of(char hex) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto digit = kDigits.find(static_cast<char>(std::tolower(static_cast<unsigned char>(hex))));
  return digit == std::string_view::npos ? -1 : static_cast<int>(digit);
}

}  // namespace

bool is_token(std::string_view text) {
  return text.size() >= kMinTokenLength && text.size() <= kMaxTokenLength &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_' || c == '~';
         });
}

Access::Digest Access::digest_of(std::string_view token) {
  Digest digest{};
  unsigned size = 0;
  if (EVP_Digest(token.data(), token.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available");
  return digest;
}

Access Access::read(const std::filesystem::path& file) try {
  const protocol::StrictJson text = protocol::read_strictly(text_of(file), kMaxDepth);
  if (text.fault) throw std::runtime_error(text.fault->message);
  check_members(text.tree, "", {"tokens", "without_token"});
  Access access;
  access.without_token_.reset();
  if (const auto role = text.tree.find("without_token"); role != text.tree.end())
    access.without_token_ = read_role(*role, "/without_token");
  const json& tokens = text.tree.contains("tokens") ? text.tree.at("tokens") : json();
  if (!tokens.is_array() || tokens.empty() || tokens.size() > kMaxTokens)
    throw std::runtime_error("/tokens must be an array of 1.." + std::to_string(kMaxTokens) + " tokens");
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const std::string path = "/tokens/" + std::to_string(i);
    const json& token = tokens[i];
    check_members(token, path, {"role", "token", "sha256", "name"});
    if (!token.contains("role")) throw std::runtime_error(path + "/role is missing; allowed: " + kRoles);
    if (token.contains("token") == token.contains("sha256"))
      throw std::runtime_error(path + " must have exactly one of token and sha256");
    Entry entry{{}, read_role(token.at("role"), path + "/role")};
    // What is wrong with a secret is told without the secret: it goes to the log.
    if (token.contains("token")) {
      const json& value = token.at("token");
      if (!value.is_string() || !is_token(value.get_ref<const std::string&>()))
        throw std::runtime_error(path + "/token must be 16..128 letters, digits or any of -._~");
      entry.digest = digest_of(value.get_ref<const std::string&>());
    } else {
      const json& value = token.at("sha256");
      const std::string hex = value.is_string() ? value.get<std::string>() : "";
      const bool digits =
          std::all_of(hex.begin(), hex.end(), [](char digit) { return digit_of(digit) >= 0; });
      if (hex.size() != 2 * entry.digest.size() || !digits)
        throw std::runtime_error(path + "/sha256 must be 64 hexadecimal digits");
      for (std::size_t byte = 0; byte < entry.digest.size(); ++byte)
        entry.digest[byte] =
            static_cast<unsigned char>(16 * digit_of(hex[2 * byte]) + digit_of(hex[2 * byte + 1]));
    }
    const auto same = [&](const Entry& other) { return other.digest == entry.digest; };
    if (std::any_of(access.entries_.begin(), access.entries_.end(), same))
      throw std::runtime_error(path + " is a token that stands there already");
    access.entries_.push_back(entry);
  }
  return access;
} catch (const std::exception& error) {
  throw std::runtime_error("tokens " + file.string() + ": " + error.what());
}

std::optional<Role> Access::role_of(std::optional<std::string_view> token) const {
  if (!token || entries_.empty()) return without_token_;
  // All of them, whole: how long it takes tells nothing of how near a guess was.
  const Digest digest = digest_of(*token);
  std::optional<Role> role;
  for (const Entry& entry : entries_) {
    if (CRYPTO_memcmp(entry.digest.data(), digest.data(), digest.size()) == 0) role = entry.role;
  }
  return role;
}

}  // namespace weft::net
