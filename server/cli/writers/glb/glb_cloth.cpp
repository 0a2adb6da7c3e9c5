#include "cli/writers/glb/glb_cloth.h"

namespace weft::cli {
namespace {

using nlohmann::ordered_json;

constexpr int kVectorBytes = 3 * sizeof(float);
constexpr const char* kVectors = "VEC3";

std::vector<float> texture_coordinates(int rows, int cols) {
  std::vector<float> uv;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      uv.push_back(static_cast<float>(c) / static_cast<float>(cols - 1));
      uv.push_back(static_cast<float>(r) / static_cast<float>(rows - 1));
    }
  }
  return uv;
}

}  // namespace

std::uint64_t GlbCloth::bytes_of(int frames) const {
  const auto count = static_cast<std::uint64_t>(frames);
  return 2 * block() * (count + count / kTargets);  // positions and normals; meshes of stretches
}

void GlbCloth::write(const MeshFrame& frame) {
  if (frames_ == 0) {
    rows_ = frame.rows;
    cols_ = frame.cols;
  }
  Vertices now{on_grid(frame, rows_, cols_), {}};
  now.normals = normals_of(now.frame);
  if (frames_ == 0) {
    begin_stretch(now, 0);
  } else {
    const Stretch& stretch = stretches_.back();
    if (stretch.targets() == kTargets || stretch.torn_faces != last_.frame.torn_faces)
      begin_stretch(std::move(last_), frames_ - 1);
    add_target(now);
  }
  last_ = std::move(now);
  ++frames_;
}

void GlbCloth::begin_stretch(Vertices vertices, std::size_t frame) {
  base_ = std::move(vertices);
  stretches_.push_back({vertices_.size(),
                        frame,
                        base_.frame.place,
                        base_.frame.torn_faces,
                        {Bounds::of(base_.frame.positions, 3)}});
  std::string bytes;
  append_bytes(bytes, std::span<const float>(base_.frame.positions));
  append_bytes(bytes, std::span<const float>(base_.normals));
  vertices_.write(bytes);
}

void GlbCloth::add_target(const Vertices& vertices) {
  std::vector<float> offsets(vertices.frame.positions.size());
  for (std::size_t i = 0; i < offsets.size(); ++i)
    offsets[i] = static_cast<float>(vertices.frame.coordinate(i) - base_.frame.coordinate(i));
  stretches_.back().bounds.push_back(Bounds::of(offsets, 3));
  std::string bytes;
  append_bytes(bytes, std::span<const float>(offsets));
  for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = vertices.normals[i] - base_.normals[i];
  append_bytes(bytes, std::span<const float>(offsets));
  vertices_.write(bytes);
}

void GlbCloth::describe(GlbDocument& document, std::uint64_t begin, const std::vector<float>& times,
                        int material) const {
  for (const Stretch& stretch : stretches_) {
    const bool first = &stretch == &stretches_.front(), last = &stretch == &stretches_.back();
    ordered_json node{{"name", first ? name_ : name_ + "." + std::to_string(stretch.first_frame)},
                      {"mesh", add_mesh(document, begin, stretch, material)}};
    if (stretch.place != std::array<double, 3>{}) node["translation"] = stretch.place;
    if (!first) node["scale"] = {0, 0, 0};
    const int index = document.add_node(std::move(node));
    if (stretch.targets() > 0) fade(document, index, stretch, times);
    if (stretches_.size() > 1) show_between(document, index, stretch, last, times);
  }
}

int GlbCloth::add_mesh(GlbDocument& document, std::uint64_t begin, const Stretch& stretch,
                       int material) const {
  const std::uint64_t bytes = 2 * block() * (1 + stretch.targets());
  const int view =
      document.add_view(begin + stretch.begin, bytes, GlbDocument::Target::vertices, kVectorBytes);
  ordered_json attributes, targets = ordered_json::array();
  for (std::size_t i = 0; i <= stretch.targets(); ++i) {
    const std::uint64_t at = 2 * block() * i;
    ordered_json vertices{{"POSITION", document.add_accessor(view, at, kVectors, nodes(), stretch.bounds[i])},
                          {"NORMAL", document.add_accessor(view, at + block(), kVectors, nodes())}};
    if (i > 0) {
      targets.push_back(std::move(vertices));
    } else {
      attributes = std::move(vertices);
    }
  }
  attributes["TEXCOORD_0"] =
      document.add_floats(texture_coordinates(rows_, cols_), "VEC2", GlbDocument::Target::vertices);
  const int indices = document.add_indices(triangles(stretch));
  return document.add_mesh(name_, std::move(attributes), indices, material, std::move(targets));
}

std::vector<std::uint32_t> GlbCloth::triangles(const Stretch& stretch) const {
  MeshFrame grid;
  grid.rows = rows_;
  grid.cols = cols_;
  grid.torn_faces = stretch.torn_faces;
  std::vector<std::uint32_t> triangles;
  for_each_face(grid, [&](int r, int c) {
    const auto [a, b, d, e] = corners_of(grid, r, c);
    triangles.insert(triangles.end(), {a, b, d, a, d, e});
  });
  return triangles;
}

/// At each frame's time its own target weighs 1 and all others 0; linear between.
void GlbCloth::fade(GlbDocument& document, int node, const Stretch& stretch,
                    const std::vector<float>& times) {
  const std::size_t targets = stretch.targets();
  std::vector<float> weights((targets + 1) * targets, 0.0f);
  for (std::size_t i = 0; i < targets; ++i) weights[(i + 1) * targets + i] = 1.0f;
  const auto first = times.begin() + static_cast<std::ptrdiff_t>(stretch.first_frame);
  const std::vector<float> own(first, first + static_cast<std::ptrdiff_t>(targets) + 1);
  document.animate(node, "weights", document.add_floats(own, "SCALAR", GlbDocument::Target::none, true),
                   document.add_floats(weights, "SCALAR", GlbDocument::Target::none), "LINEAR");
}

void GlbCloth::show_between(GlbDocument& document, int node, const Stretch& stretch, bool last,
                            const std::vector<float>& times) {
  std::vector<float> when, size;
  const auto from = [&](float time, float scale) {
    when.push_back(time);
    size.insert(size.end(), 3, scale);
  };
  if (stretch.first_frame > 0) from(times.front(), 0);
  from(times[stretch.first_frame], 1);
  if (!last) from(times[stretch.first_frame + stretch.targets()], 0);
  document.animate(node, "scale", document.add_floats(when, "SCALAR", GlbDocument::Target::none, true),
                   document.add_floats(size, kVectors, GlbDocument::Target::none), "STEP");
}

}  // namespace weft::cli
