#include <algorithm>
#include <limits>
#include <stdexcept>

#include "cli/writers/glb/glb_body.h"
#include "cli/writers/glb/glb_cloth.h"
#include "cli/writers/glb/glb_document.h"
#include "cli/writers/output_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

/// Its length, which its header has in 32 bits.
constexpr std::uint64_t kMostBytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kMagic = 0x46546C67, kGlbVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

/// The length of the file stands at its beginning, and the JSON before the buffer: vertices and the ways of
/// bodies are put aside until the end.
class GlbWriter final : public SceneWriter {
 public:
  GlbWriter(const std::string& path, const ExportedScene& scene) : path_(path), scene_(scene), file_(path) {
    for (const std::string& cloth : scene.cloths) cloths_.emplace_back(path, cloth);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) bodies_.emplace_back(path);
  }

  void write(const SceneFrame& frame) override {
    const double time = frame.cloths.front().time;
    if (times_.empty()) begin_ = time;
    const auto since = static_cast<float>(time - begin_);
    // An animation's times ascend: of a scene that stands still, or begins anew, one frame is enough.
    if (!times_.empty() && !(since > times_.back())) return;
    times_.push_back(since);
    for (std::size_t i = 0; i < cloths_.size(); ++i) cloths_[i].write(frame.cloths[i]);
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].write(frame.bodies[i]);
    std::uint64_t bytes = bytes_of_bodies(), in_all = 0;
    for (const GlbCloth& cloth : cloths_) {
      bytes += cloth.bytes();
      in_all += cloth.bytes_of(scene_.frames);
    }
    expect_room(std::max(bytes, in_all));
  }

  void finish() override {
    GlbDocument document(scene_.name);
    std::uint64_t before = 0;
    for (const GlbCloth& cloth : cloths_) before += cloth.bytes();
    before += bytes_of_bodies();
    if (!times_.empty()) describe(document, before);
    std::string json = document.json(before);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::uint64_t buffer = before + document.data().size();
    const std::uint64_t all = kHeaderBytes + (buffer > 0 ? 2 : 1) * kChunkHeaderBytes + json.size() + buffer;
    expect_room(all);

    std::string start;
    for (const std::uint64_t word : {std::uint64_t{kMagic}, std::uint64_t{kGlbVersion}, all,
                                     std::uint64_t{json.size()}, std::uint64_t{kJson}})
      append_bytes(start, static_cast<std::uint32_t>(word));
    start += json;
    if (buffer > 0) {
      append_bytes(start, static_cast<std::uint32_t>(buffer));
      append_bytes(start, kBinary);
    }
    file_.write(start);
    for (GlbCloth& cloth : cloths_) cloth.copy_to(file_);
    for (GlbBody& body : bodies_) body.copy_to(file_);
    file_.write(document.data());
    file_.close();
  }
  std::vector<std::string> files() const override { return {path_}; }

 private:
  void describe(GlbDocument& document, std::uint64_t before) const {
    document.set_data_begin(before);
    const int cloth = document.add_material("cloth", {0.75, 0.25, 0.2, 1}, true);
    std::uint64_t begin = 0;
    for (const GlbCloth& each : cloths_) {
      each.describe(document, begin, times_, cloth);
      begin += each.bytes();
    }
    if (bodies_.empty()) return;
    const int body = document.add_material("body", {0.5, 0.5, 0.5, 1}, false);
    const int times = document.add_floats(times_, "SCALAR", GlbDocument::Target::none, true);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      bodies_[i].describe(document, begin, scene_.bodies[i], times, body);
      begin += bodies_[i].bytes();
    }
  }

  std::uint64_t bytes_of_bodies() const {
    std::uint64_t bytes = 0;
    for (const GlbBody& body : bodies_) bytes += body.bytes();
    return bytes;
  }

  void expect_room(std::uint64_t bytes) const {
    if (bytes <= kMostBytes) return;
    throw std::runtime_error(
        path_ + ": a .glb holds at most 4 GiB (32 bits have its length), and this one would have " +
        std::to_string(bytes >> 20) +
        " MiB: write fewer frames, a coarser level, or .pc2, .mdd, .usda or .obj");
  }

  std::string path_;
  const ExportedScene scene_;
  OutputFile file_;
  std::vector<GlbCloth> cloths_;
  std::vector<GlbBody> bodies_;
  std::vector<float> times_;  ///< of frames, since the first, s
  double begin_ = 0;          ///< its own time, s
};

}  // namespace

std::unique_ptr<SceneWriter> open_glb(const std::string& path, const ExportedScene& scene) {
  return std::make_unique<GlbWriter>(path, scene);
}

}  // namespace weft::cli
