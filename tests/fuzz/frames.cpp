#include <algorithm>
#include <cmath>

#include "protocol/frame.h"
#include "targets.h"

namespace weft::fuzz {

// What is accepted is whole and finite; what is not gives a reason.
void frames(Input input) {
  protocol::Frame frame;
  std::string error;
  if (!protocol::decode_frame(input, frame, error)) return require(!error.empty(), "a refusal has a reason");
  const auto stamp = protocol::read_stamp(input);
  require(stamp && stamp->frame == frame.stamp.frame && stamp->epoch == frame.stamp.epoch,
          "the stamp is that of the first header");
  for (const protocol::ClothRecord& cloth : frame.cloths) {
    const auto rows = static_cast<std::size_t>(cloth.rows), cols = static_cast<std::size_t>(cloth.cols);
    require(cloth.positions.size() == rows * cols * 3, "each node has a position");
    require(std::all_of(cloth.positions.begin(), cloth.positions.end(),
                        [](float value) { return std::isfinite(value); }),
            "positions are finite");
    require(std::all_of(cloth.torn_faces.begin(), cloth.torn_faces.end(),
                        [&](std::uint32_t face) { return face < (rows - 1) * (cols - 1); }),
            "torn faces are the mesh's");
  }
}

}  // namespace weft::fuzz
