#include <stdexcept>

#include "scene/readers.h"
#include "scene/start/start_files.h"
#include "scene/start/text_lines.h"

namespace weft::scene {

StartMesh read_csv_start(std::string_view text, const StartChoice& choice) {
  constexpr std::string_view kColumns = "frame,time,row,col,x,y,z";
  if (!take_line(text).starts_with(kColumns))
    throw std::invalid_argument("does not begin with the columns " + std::string(kColumns));
  std::vector<double> times;
  std::vector<std::string_view> frames;  // each from its first line on
  for (double last = 0; !text.empty();) {
    const std::string_view rest = text;
    std::string_view line = take_line(text);
    const auto [frame, time] = take_numbers<2>(line);
    if (times.empty() || frame != last) {
      times.push_back(time);
      frames.push_back(rest);
    }
    last = frame;
  }
  const std::size_t chosen = chosen_frame(choice, times);
  std::string_view lines = frames[chosen];
  if (chosen + 1 < frames.size()) lines.remove_suffix(frames[chosen + 1].size());
  StartMesh mesh;
  while (!lines.empty()) {
    std::string_view line = take_line(lines);
    const auto [frame, time, row, col, x, y, z] = take_numbers<7>(line);
    if (row == 0) ++mesh.cols;
    if (col == 0) ++mesh.rows;
    if (row != mesh.rows - 1 ||
        col != static_cast<double>(mesh.nodes.size() % static_cast<std::size_t>(mesh.cols)))
      throw std::invalid_argument("has a frame whose nodes are not a grid, row by row");
    mesh.nodes.emplace_back(x, y, z);
    if (mesh.nodes.size() > kMaxClothNodes)
      throw std::invalid_argument("has a frame of more than " + std::to_string(kMaxClothNodes) + " nodes");
  }
  if (mesh.nodes.size() != static_cast<std::size_t>(mesh.rows) * static_cast<std::size_t>(mesh.cols))
    throw std::invalid_argument("ends within a frame's nodes");
  return mesh;
}

}  // namespace weft::scene
