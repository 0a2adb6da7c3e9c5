#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "cli/writers/output_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

class ObjWriter final : public MeshWriter {
 public:
  explicit ObjWriter(const std::string& path) : path_(path) {
    const auto folder = path_.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder)) {
      throw std::runtime_error(path + ": cannot be written: " + folder.string() + " is not a directory");
    }
  }

  void write(const MeshFrame& frame) override {
    std::string text;
    for (std::size_t i = 0; i < frame.positions.size(); i += 3) {
      text += 'v';
      for (std::size_t axis = 0; axis < 3; ++axis) {
        text += ' ';
        append_coordinate(text, frame.coordinate(i + axis));
      }
      text += '\n';
    }
    for (int r = 0; r < frame.rows; ++r) {
      for (int c = 0; c < frame.cols; ++c) {
        text += "vt ";
        append_number(text, static_cast<float>(c) / static_cast<float>(frame.cols - 1));
        text += ' ';
        append_number(text, 1 - static_cast<float>(r) / static_cast<float>(frame.rows - 1));
        text += '\n';
      }
    }
    auto torn = frame.torn_faces.begin();
    std::uint32_t face = 0;
    for (int r = 0; r + 1 < frame.rows; ++r) {
      for (int c = 0; c + 1 < frame.cols; ++c, ++face) {
        if (torn != frame.torn_faces.end() && *torn == face) {
          ++torn;
          continue;
        }
        const int corner = r * frame.cols + c + 1;  // counted from 1
        text += 'f';
        // Counter-clockwise seen from the side the face normal points to.
        for (const int node : {corner, corner + frame.cols, corner + frame.cols + 1, corner + 1}) {
          text += ' ';
          append_number(text, node);
          text += '/';
          append_number(text, node);
        }
        text += '\n';
      }
    }
    OutputFile file(path_of(frame.frame));
    file.write(text);
    file.close();
  }
  void finish() override {}  // each frame's file is complete

 private:
  std::string path_of(int frame) const {
    char number[16];
    std::snprintf(number, sizeof number, "_%04d", frame);
    std::filesystem::path path = path_;
    path.replace_filename(path.stem().string() + number + path.extension().string());
    return path.string();
  }

  std::filesystem::path path_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_obj(const std::string& path) { return std::make_unique<ObjWriter>(path); }

}  // namespace weft::cli
