#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "cli/writers/output_file.h"
#include "cli/writers/spill_file.h"
#include "cli/writers/usda/usda_cloth.h"
#include "cli/writers/usda/usda_text.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

/// The way of a body: one sample for each pose that differs from the one before, and the one before it. They
/// are put aside from the second on: of what stands still nothing is kept but where.
class UsdaWay {
 public:
  /// `path`: of the .usda.
  explicit UsdaWay(std::string path) : path_(std::move(path)) {}

  void add(int frame, const std::string& value) {
    if (first_.empty()) {
      first_ = value;
      written_ = frame;
      first_sample_ = sample(frame, value);
    } else if (value != last_) {
      if (last_frame_ != written_) append(last_frame_, last_);
      append(frame, value);
    }
    last_ = value;
    last_frame_ = frame;
  }
  /// `attribute` with its value, if it is only one, or else its samples.
  void write(OutputFile& file, const std::string& attribute) {
    std::string text("        ");
    text += attribute;
    if (!samples_) return file.write(text.append(" = ").append(first_).append("\n"));
    file.write(text.append(".timeSamples = {\n").append(first_sample_));
    samples_->copy_to(file);
    file.write("        }\n");
  }

 private:
  static std::string sample(int frame, const std::string& value) {
    std::string line("            ");
    return line.append(std::to_string(frame)).append(": ").append(value).append(",\n");
  }
  void append(int frame, const std::string& value) {
    if (!samples_) samples_ = std::make_unique<SpillFile>(path_);
    samples_->write(sample(frame, value));
    written_ = frame;
  }

  std::string path_, first_, first_sample_, last_;
  std::unique_ptr<SpillFile> samples_;
  int last_frame_ = 0, written_ = 0;
};

struct BodyWay {
  explicit BodyWay(const std::string& path) : translation(path), turn(path) {}
  UsdaWay translation, turn;
};

class UsdaWriter final : public SceneWriter {
 public:
  UsdaWriter(const std::string& path, const ExportedScene& scene) : path_(path), scene_(scene), file_(path) {
    for (const std::string& cloth : scene.cloths) cloths_.emplace_back(path, cloth);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) ways_.emplace_back(path);
  }

  void write(const SceneFrame& frame) override {
    const int number = frame.cloths.front().frame;
    if (frames_ > 0 && number <= last_frame_) return;  // time codes ascend, and a reset begins anew
    if (frames_++ == 0) first_frame_ = number;
    last_frame_ = number;
    for (std::size_t i = 0; i < cloths_.size(); ++i) cloths_[i].write(frame.cloths[i]);
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      ways_[i].translation.add(number, usda_vector(frame.bodies[i].position));
      ways_[i].turn.add(number, usda_quaternion(frame.bodies[i].orientation));
    }
  }

  void finish() override {
    std::string start("#usda 1.0\n(\n    defaultPrim = \"");
    start.append(usda_name(scene_.name)).append("\"\n    doc = \"Weft ").append(WEFT_VERSION).append("\"\n");
    const auto number = [&](const char* name, double value) {
      start.append("    ").append(name).append(" = ");
      append_number(start, value);
      start += '\n';
    };
    number("endTimeCode", last_frame_);
    number("framesPerSecond", frame_rate());
    number("metersPerUnit", 1);
    number("startTimeCode", first_frame_);
    number("timeCodesPerSecond", frame_rate());
    start.append("    upAxis = \"Y\"\n)\n\ndef Xform \"").append(usda_name(scene_.name)).append("\"\n{");
    file_.write(start);
    for (UsdaCloth& cloth : cloths_) cloth.finish(file_, prim_name(cloth.name()));
    if (frames_ > 0) {
      for (std::size_t i = 0; i < ways_.size(); ++i) write_body(scene_.bodies[i], ways_[i]);
    }
    file_.write("}\n");
    file_.close();
  }
  std::vector<std::string> files() const override { return {path_}; }

 private:
  /// A frame's number is its time code. What is meant by 1/60 is 60.
  double frame_rate() const {
    const double rate = 1 / scene_.time_step, whole = std::round(rate);
    constexpr double kRounding = 1e-9;
    return std::abs(rate - whole) < kRounding * rate ? whole : rate;
  }

  /// Each name once: "a-b" and "a_b" are the same to USD.
  std::string prim_name(const std::string& name) {
    std::string prim = usda_name(name);
    while (std::find(prims_.begin(), prims_.end(), prim) != prims_.end()) prim += '_';
    prims_.push_back(prim);
    return prim;
  }

  void write_body(const BodyMesh& body, BodyWay& way) {
    const std::vector<std::uint32_t> counts(body.triangles.size() / 3, 3);
    std::string text("\n    def Mesh \"");
    text.append(prim_name(body.name)).append("\"\n    {\n");
    const auto attribute = [&](const char* name, const std::string& value) {
      text.append("        ").append(name).append(" = ").append(value).append("\n");
    };
    attribute("float3[] extent", usda_extent(body.positions));
    attribute("int[] faceVertexCounts", usda_integers(counts));
    attribute("int[] faceVertexIndices", usda_integers(body.triangles));
    attribute("normal3f[] normals",
              usda_vectors(body.normals, 3) + " (\n            interpolation = \"vertex\"\n        )");
    attribute("point3f[] points", usda_vectors(body.positions, 3));
    attribute("uniform token subdivisionScheme", "\"none\"");
    file_.write(text);
    text.clear();
    way.turn.write(file_, "quatf xformOp:orient");
    way.translation.write(file_, "double3 xformOp:translate");
    attribute("uniform token[] xformOpOrder", "[\"xformOp:translate\", \"xformOp:orient\"]");
    text += "    }\n";
    file_.write(text);
  }

  std::string path_;
  const ExportedScene scene_;
  OutputFile file_;
  std::vector<UsdaCloth> cloths_;
  std::vector<BodyWay> ways_;
  std::vector<std::string> prims_;
  int frames_ = 0, first_frame_ = 0, last_frame_ = 0;
};

}  // namespace

std::unique_ptr<SceneWriter> open_usda(const std::string& path, const ExportedScene& scene) {
  return std::make_unique<UsdaWriter>(path, scene);
}

}  // namespace weft::cli
