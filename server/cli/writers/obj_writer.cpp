#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>

#include "cli/writers/output_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

class ObjWriter final : public SceneWriter {
 public:
  ObjWriter(const std::string& path, const ExportedScene& scene) : path_(path), scene_(scene) {
    const auto folder = path_.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder)) {
      throw std::runtime_error(path + ": cannot be written: " + folder.string() + " is not a directory");
    }
  }

  void write(const SceneFrame& frame) override {
    std::string text;
    std::uint32_t before = 0;  // vertices of the objects before
    for (std::size_t i = 0; i < frame.cloths.size(); ++i) {
      append_object(text, scene_.cloths[i]);
      append_cloth(text, frame.cloths[i], before);
      before += static_cast<std::uint32_t>(frame.cloths[i].positions.size() / 3);
    }
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
      append_object(text, scene_.bodies[i].name);
      append_body(text, scene_.bodies[i], frame.bodies[i], before);
      before += static_cast<std::uint32_t>(scene_.bodies[i].positions.size() / 3);
    }
    OutputFile file(path_of(frame.cloths.front().frame));
    file.write(text);
    file.close();
  }
  void finish() override {}  // each frame's file is complete
  std::vector<std::string> files() const override { return {numbered("_%04d")}; }

 private:
  static void append_object(std::string& text, const std::string& name) {
    text.append("o ").append(name).append("\n");
  }

  template <class Coordinate>
  static void append_line(std::string& text, const char* keyword, std::initializer_list<Coordinate> values) {
    text += keyword;
    for (const Coordinate value : values) {
      text += ' ';
      append_coordinate(text, static_cast<double>(value));
    }
    text += '\n';
  }

  static void append_cloth(std::string& text, const MeshFrame& frame, std::uint32_t before) {
    for (std::size_t i = 0; i < frame.positions.size(); i += 3)
      append_line(text, "v", {frame.coordinate(i), frame.coordinate(i + 1), frame.coordinate(i + 2)});
    for (int r = 0; r < frame.rows; ++r) {
      for (int c = 0; c < frame.cols; ++c) {
        append_line(text, "vt",
                    {static_cast<float>(c) / static_cast<float>(frame.cols - 1),
                     1 - static_cast<float>(r) / static_cast<float>(frame.rows - 1)});
      }
    }
    const std::vector<float> normals = normals_of(frame);
    for (std::size_t i = 0; i < normals.size(); i += 3)
      append_line(text, "vn", {normals[i], normals[i + 1], normals[i + 2]});
    for_each_face(frame, [&](int r, int c) {
      text += 'f';
      for (const std::uint32_t corner : corners_of(frame, r, c)) {
        const std::string number = std::to_string(before + corner + 1);  // counted from 1
        text.append(" ").append(number).append("/").append(number).append("/").append(number);
      }
      text += '\n';
    });
  }

  static void append_body(std::string& text, const BodyMesh& body, const Pose& pose, std::uint32_t before) {
    for (std::size_t i = 0; i < body.positions.size(); i += 3) {
      const Vec3 own(body.positions[i], body.positions[i + 1], body.positions[i + 2]);
      const Vec3 at = pose.position + pose.orientation * own;
      append_line(text, "v",
                  {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
    }
    for (std::size_t i = 0; i < body.normals.size(); i += 3) {
      const Vec3 own(body.normals[i], body.normals[i + 1], body.normals[i + 2]);
      const Eigen::Vector3f normal = (pose.orientation * own).cast<float>();
      append_line(text, "vn", {normal.x(), normal.y(), normal.z()});
    }
    for (std::size_t i = 0; i < body.triangles.size(); i += 3) {
      text += 'f';
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::string number = std::to_string(before + body.triangles[i + corner] + 1);
        text.append(" ").append(number).append("//").append(number);
      }
      text += '\n';
    }
  }

  std::string path_of(int frame) const {
    char number[16];
    std::snprintf(number, sizeof number, "_%04d", frame);
    return numbered(number);
  }
  std::string numbered(const std::string& number) const {
    std::filesystem::path path = path_;
    path.replace_filename(path.stem().string() + number + path.extension().string());
    return path.string();
  }

  std::filesystem::path path_;
  const ExportedScene scene_;
};

}  // namespace

std::unique_ptr<SceneWriter> open_obj(const std::string& path, const ExportedScene& scene) {
  return std::make_unique<ObjWriter>(path, scene);
}

}  // namespace weft::cli
