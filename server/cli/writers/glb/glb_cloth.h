#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cli/writers/glb/glb_document.h"
#include "cli/writers/mesh_frame.h"
#include "cli/writers/spill_file.h"

namespace weft::cli {

/// A cloth of a .glb as its frames come. They are cut into stretches of at most kTargets frames, each a mesh
/// of its own whose morph targets are its frames, and a node that has the size 0 before and after
/// (glTF 2.0, 3.5.2: such nodes are not drawn). Where the cloth tears a stretch ends: its triangles are those
/// that are whole. Each stretch begins with the frame that the one before ends with, so that none is missed
/// between them.
class GlbCloth {
 public:
  static constexpr std::size_t kTargets = 60;

  GlbCloth(const std::string& path, std::string name) : name_(std::move(name)), vertices_(path) {}

  void write(const MeshFrame& frame);
  /// Of the buffer, so far.
  std::uint64_t bytes() const { return vertices_.size(); }
  /// Of the buffer for so many frames of a cloth like this one, about.
  std::uint64_t bytes_of(int frames) const;

  /// Adds all; its bytes begin at `begin` of the buffer. `times` of all frames, s.
  void describe(GlbDocument& document, std::uint64_t begin, const std::vector<float>& times,
                int material) const;
  void copy_to(OutputFile& file) { vertices_.copy_to(file); }

 private:
  struct Vertices {
    MeshFrame frame;
    std::vector<float> normals;
  };
  struct Stretch {
    std::uint64_t begin = 0;      ///< of its vertices
    std::size_t first_frame = 0;  ///< that is its mesh
    std::array<double, 3> place{};
    std::vector<std::uint32_t> torn_faces;
    std::vector<Bounds> bounds;  ///< of the positions of the mesh and of each target
    std::size_t targets() const { return bounds.size() - 1; }
  };
  void begin_stretch(Vertices vertices, std::size_t frame);
  void add_target(const Vertices& vertices);
  int add_mesh(GlbDocument& document, std::uint64_t begin, const Stretch& stretch, int material) const;
  std::vector<std::uint32_t> triangles(const Stretch& stretch) const;
  static void fade(GlbDocument& document, int node, const Stretch& stretch, const std::vector<float>& times);
  /// By its size, between its first frame and its last.
  static void show_between(GlbDocument& document, int node, const Stretch& stretch, bool last,
                           const std::vector<float>& times);
  std::uint64_t block() const { return std::uint64_t{3} * sizeof(float) * nodes(); }
  std::size_t nodes() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_); }

  std::string name_;
  SpillFile vertices_;
  int rows_ = 0, cols_ = 0;
  std::size_t frames_ = 0;
  Vertices base_, last_;  ///< of the stretch in hand; the newest frame
  std::vector<Stretch> stretches_;
};

}  // namespace weft::cli
