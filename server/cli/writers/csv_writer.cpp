#include "cli/writers/output_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

class CsvWriter final : public MeshWriter {
 public:
  explicit CsvWriter(const std::string& path) : file_(path) {
    file_.write("frame,time,row,col,x,y,z,vx,vy,vz\n");
  }

  void write(const MeshFrame& frame) override {
    std::string start;
    append_number(start, frame.frame);
    start += ',';
    append_number(start, frame.time);
    start += ',';
    std::string text;
    for (int r = 0; r < frame.rows; ++r) {
      for (int c = 0; c < frame.cols; ++c) {
        text += start;
        append_number(text, r);
        text += ',';
        append_number(text, c);
        const auto node = static_cast<std::size_t>(r * frame.cols + c) * 3;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          text += ',';
          append_coordinate(text, frame.coordinate(node + axis));
        }
        append_vector(text, frame.velocities.empty() ? nullptr : &frame.velocities[node]);
        text += '\n';
      }
    }
    file_.write(text);
  }
  void finish() override { file_.close(); }

 private:
  /// ",x,y,z"; fields stay empty where the vector is unknown.
  static void append_vector(std::string& text, const float* vector) {
    for (int axis = 0; axis < 3; ++axis) {
      text += ',';
      if (vector) append_number(text, vector[axis]);
    }
  }

  OutputFile file_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_csv(const std::string& path) { return std::make_unique<CsvWriter>(path); }

}  // namespace weft::cli
