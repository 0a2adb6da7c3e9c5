#include "cloth/sheet/tear/torn_links.h"

namespace weft {

bool TornLinks::torn(int r, int c, int rows, int cols) const {
  if (rows == 0) return u(r, c) != 0 || (cols == 2 && u(r, c + 1) != 0);
  if (cols == 0) return v(r, c) != 0 || (rows == 2 && v(r + 1, c) != 0);
  const int left = cols > 0 ? c : c - 1;  // of the cell's two columns
  const bool sideways_first = u(r, left) != 0 || v(r, c + cols) != 0;
  const bool down_first = v(r, c) != 0 || u(r + 1, left) != 0;
  return sideways_first && down_first;
}

std::vector<FaceRun> TornLinks::whole_faces() const {
  std::vector<FaceRun> runs;
  for (int r = 0; r + 1 < grid_.rows; ++r) {
    int begin = 0;
    for (int c = 0; c + 1 <= grid_.cols; ++c) {
      if (c + 1 < grid_.cols && !face_torn(r, c)) continue;
      if (begin < c) runs.push_back({r, begin, c});
      begin = c + 1;
    }
  }
  return runs;
}

std::vector<std::uint32_t> TornLinks::torn_faces() const {
  std::vector<std::uint32_t> faces;
  for (int r = 0; r + 1 < grid_.rows; ++r) {
    for (int c = 0; c + 1 < grid_.cols; ++c) {
      if (face_torn(r, c)) faces.push_back(static_cast<std::uint32_t>(r * (grid_.cols - 1) + c));
    }
  }
  return faces;
}

}  // namespace weft
