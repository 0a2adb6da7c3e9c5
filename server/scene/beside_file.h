#pragma once
#include <filesystem>
#include <string>

namespace weft::scene {

/// The bytes of a file that a scene names. It is looked for in `folder`, the scene file's, and must stay in
/// it: a relative path without "..", and no link out of it. Throws std::invalid_argument, saying what is
/// wrong, also if it has more than `max_bytes`.
std::string read_beside(const std::filesystem::path& folder, const std::string& file, std::size_t max_bytes);

}  // namespace weft::scene
