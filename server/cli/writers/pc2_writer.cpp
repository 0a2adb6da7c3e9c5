#include <string_view>

#include "cli/writers/output_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

constexpr std::string_view kSignature{"POINTCACHE2\0", 12};
constexpr int kVersion = 1;
constexpr std::streamoff kSampleCountAt = 28;

class Pc2Writer final : public MeshWriter {
 public:
  explicit Pc2Writer(const std::string& path) : file_(path) {}

  void write(const MeshFrame& frame) override {
    if (samples_ == 0) {
      rows_ = frame.rows;
      cols_ = frame.cols;
      std::string header(kSignature);
      append_bytes(header, kVersion);
      append_bytes(header, frame.rows * frame.cols);          // points
      append_bytes(header, static_cast<float>(frame.frame));  // first frame
      append_bytes(header, 1.0f);                             // frames a sample
      append_bytes(header, 0);                                // samples: known at the end
      file_.write(header);
    }
    const MeshFrame same = on_grid(frame, rows_, cols_);
    std::string bytes;
    bytes.reserve(same.positions.size() * sizeof(float));
    for (std::size_t i = 0; i < same.positions.size(); ++i) {
      append_bytes(bytes, static_cast<float>(same.coordinate(i)));
    }
    file_.write(bytes);
    ++samples_;
  }

  void finish() override {
    std::string count;
    append_bytes(count, samples_);
    if (samples_ > 0) file_.patch(kSampleCountAt, count);
    file_.close();
  }

 private:
  OutputFile file_;
  int rows_ = 0, cols_ = 0;
  int samples_ = 0;
};

}  // namespace

std::unique_ptr<MeshWriter> open_pc2(const std::string& path) { return std::make_unique<Pc2Writer>(path); }

}  // namespace weft::cli
