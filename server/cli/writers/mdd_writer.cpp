#include "cli/writers/output_file.h"
#include "cli/writers/spill_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

/// Times stand before all points: these are put aside until the last time is known.
class MddWriter final : public MeshWriter {
 public:
  explicit MddWriter(const std::string& path) : file_(path), points_(path) {}

  void write(const MeshFrame& frame) override {
    const auto time = static_cast<float>(frame.time);
    // A cache's times ascend: of a scene that stands still, or begins anew, one frame is enough.
    if (!times_.empty() && !(time > times_.back())) return;
    if (times_.empty()) {
      rows_ = frame.rows;
      cols_ = frame.cols;
    }
    const MeshFrame same = on_grid(frame, rows_, cols_);
    std::string bytes;
    bytes.reserve(same.positions.size() * sizeof(float));
    for (std::size_t i = 0; i < same.positions.size(); ++i)
      append_bytes_big(bytes, static_cast<float>(same.coordinate(i)));
    points_.write(bytes);
    times_.push_back(time);
  }

  void finish() override {
    std::string header;
    append_bytes_big(header, static_cast<int>(times_.size()));
    append_bytes_big(header, rows_ * cols_);
    for (const float time : times_) append_bytes_big(header, time);
    file_.write(header);
    points_.copy_to(file_);
    file_.close();
  }

 private:
  OutputFile file_;
  SpillFile points_;
  int rows_ = 0, cols_ = 0;
  std::vector<float> times_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_mdd(const std::string& path) { return std::make_unique<MddWriter>(path); }

}  // namespace weft::cli
