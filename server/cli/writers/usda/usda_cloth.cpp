#include "cli/writers/usda/usda_cloth.h"

#include <utility>

#include "cli/writers/usda/usda_text.h"

namespace weft::cli {
namespace {

std::string texture_coordinates_of(const MeshFrame& grid) {
  std::vector<float> st;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      st.push_back(static_cast<float>(c) / static_cast<float>(grid.cols - 1));
      st.push_back(1 - static_cast<float>(r) / static_cast<float>(grid.rows - 1));
    }
  }
  return usda_vectors(st, 2);
}

void write_attribute(OutputFile& file, const std::string& attribute, const std::string& value,
                     const char* metadata = "") {
  std::string line("        ");
  line.append(attribute).append(" = ").append(value).append(metadata).append("\n");
  file.write(line);
}

void write_samples(OutputFile& file, const std::string& attribute, SpillFile& samples) {
  std::string line("        ");
  line.append(attribute).append(".timeSamples = {\n");
  file.write(line);
  samples.copy_to(file);
  file.write("        }\n");
}

}  // namespace

UsdaCloth::UsdaCloth(const std::string& path, std::string name)
    : name_(std::move(name)), points_(path), normals_(path), extents_(path), counts_(path), indices_(path) {}

std::string UsdaCloth::sample(int frame, const std::string& value) {
  std::string line("            ");
  line.append(std::to_string(frame)).append(": ").append(value).append(",\n");
  return line;
}

void UsdaCloth::write(const MeshFrame& frame) {
  const bool first = first_.positions.empty();
  if (first) first_ = frame;
  MeshFrame same = on_grid(frame, first_.rows, first_.cols);
  // Where a cloth is that goes far is its node's translation, which does not move.
  for (std::size_t i = 0; i < same.positions.size(); ++i)
    same.positions[i] = static_cast<float>(same.coordinate(i) - first_.place[i % 3]);
  same.place = first_.place;
  points_.write(sample(frame.frame, usda_vectors(same.positions, 3)));
  normals_.write(sample(frame.frame, usda_vectors(normals_of(same), 3)));
  extents_.write(sample(frame.frame, usda_extent(same.positions)));
  if (first || same.torn_faces != last_.torn_faces) add_faces(same);
  last_ = std::move(same);
}

void UsdaCloth::add_faces(const MeshFrame& frame) {
  std::vector<std::uint32_t> corners, counts;
  for_each_face(frame, [&](int r, int c) {
    const auto face = corners_of(frame, r, c);
    corners.insert(corners.end(), face.begin(), face.end());
    counts.push_back(static_cast<std::uint32_t>(face.size()));
  });
  const std::string counts_text = usda_integers(counts), indices_text = usda_integers(corners);
  counts_.write(sample(frame.frame, counts_text));
  indices_.write(sample(frame.frame, indices_text));
  tears_ = !first_counts_.empty();
  if (tears_) return;
  first_counts_ = counts_text;
  first_indices_ = indices_text;
}

void UsdaCloth::finish(OutputFile& file, const std::string& prim) {
  if (first_.positions.empty()) return;
  file.write("\n    def Mesh \"" + prim + "\"\n    {\n");
  write_attribute(file, "uniform bool doubleSided", "1");
  write_attribute(file, "float3[] extent", usda_extent(first_.positions));
  write_samples(file, "float3[] extent", extents_);
  write_attribute(file, "int[] faceVertexCounts", first_counts_);
  write_attribute(file, "int[] faceVertexIndices", first_indices_);
  if (tears_) {
    write_samples(file, "int[] faceVertexCounts", counts_);
    write_samples(file, "int[] faceVertexIndices", indices_);
  }
  write_attribute(file, "normal3f[] normals", usda_vectors(normals_of(first_), 3),
                  " (\n            interpolation = \"vertex\"\n        )");
  write_samples(file, "normal3f[] normals", normals_);
  write_attribute(file, "point3f[] points", usda_vectors(first_.positions, 3));
  write_samples(file, "point3f[] points", points_);
  write_attribute(file, "texCoord2f[] primvars:st", texture_coordinates_of(first_),
                  " (\n            interpolation = \"vertex\"\n        )");
  write_attribute(file, "uniform token subdivisionScheme", "\"none\"");
  write_attribute(file, "double3 xformOp:translate",
                  usda_vector(Vec3(first_.place[0], first_.place[1], first_.place[2])));
  write_attribute(file, "uniform token[] xformOpOrder", "[\"xformOp:translate\"]");
  file.write("    }\n");
}

}  // namespace weft::cli
