#pragma once
/// What is fuzzed: functions that take any bytes as a stranger may send them, hand them to the server's own
/// code and check what it makes of them. They end the process if that is wrong, and let no exception pass
/// that the code does not announce.
#include <cstdint>
#include <span>
#include <string>

namespace weft::fuzz {

using Input = std::span<const std::uint8_t>;
using Target = void(Input input);

Target messages;    ///< a client's control message
Target frames;      ///< a server's binary message
Target scenes;      ///< a client's scene, as it makes one
Target meshes;      ///< an OBJ file
Target motions;     ///< a BVH or a glTF file
Target starts;      ///< a file that a cloth starts from
Target requests;    ///< an HTTP request: its rules, its token and its origin
Target gate;        ///< a viewer's WebSocket frames, in pieces
Target connection;  ///< all that is sent on one connection: HTTP, WebSocket, messages
Target tokens;      ///< the file of --tokens
Target settings;    ///< the file of --config
Target recordings;  ///< a file of --record
Target fabrics;     ///< a file of `weft fabric fit`

inline std::string text_of(Input input) { return {input.begin(), input.end()}; }

/// Ends the process, saying what does not hold, unless it holds.
void require(bool holds, const char* what);

}  // namespace weft::fuzz
