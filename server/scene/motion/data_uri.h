#pragma once
#include <string>
#include <string_view>

namespace weft::scene {

/// "data:...": the bytes stand in the address itself (RFC 2397).
bool is_data_uri(std::string_view uri);
/// Those bytes, written as base64 (RFC 4648). Throws std::invalid_argument if they are not.
std::string data_of_uri(std::string_view uri);
/// A file's name as it stands in an address: %20 is a blank (RFC 3986).
std::string percent_decoded(std::string_view uri);

}  // namespace weft::scene
