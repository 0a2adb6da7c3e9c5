#pragma once
#include <string>
#include <utility>

#include "cloth/core/vec3.h"
#include "protocol/message.h"

namespace weft::host {

inline Vec3 to_vec3(const protocol::Vector& v) { return {v[0], v[1], v[2]}; }

/// A command's error, but for the request that it answers.
inline protocol::Error refused(const char* code, const char* path, std::string message) {
  return {std::nullopt, code, path, std::move(message)};
}

}  // namespace weft::host
