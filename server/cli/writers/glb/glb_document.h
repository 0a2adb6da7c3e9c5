#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace weft::cli {

/// Of a list of vectors, by component.
struct Bounds {
  std::vector<float> min, max;
  /// `values`: vectors of `width` components, at least one.
  static Bounds of(std::span<const float> values, std::size_t width);
};

/// The JSON of a binary glTF, while it is put together, and what of its buffer is known last. Indices are
/// those of glTF's arrays.
class GlbDocument {
 public:
  /// What a view's bytes are for.
  enum class Target { none = 0, vertices = 34962, indices = 34963 };

  explicit GlbDocument(const std::string& scene);

  /// Bytes of the buffer that are there already, `offset` from its beginning. `stride` where several
  /// accessors of vertices share it.
  int add_view(std::uint64_t offset, std::uint64_t bytes, Target target, int stride = 0);
  /// Floats of a view: `type` SCALAR, VEC2, VEC3 or VEC4.
  int add_accessor(int view, std::uint64_t offset, const char* type, std::size_t count,
                   const std::optional<Bounds>& bounds = {});
  /// Floats that go to the end of the buffer, with a view and an accessor.
  int add_floats(const std::vector<float>& values, const char* type, Target target, bool with_bounds = false);
  int add_indices(const std::vector<std::uint32_t>& indices);
  /// One primitive of triangles; `targets` may be empty.
  int add_mesh(const std::string& name, nlohmann::ordered_json attributes, int indices, int material,
               nlohmann::ordered_json targets);
  int add_material(const std::string& name, const std::vector<double>& colour, bool double_sided);
  /// A root of the scene.
  int add_node(nlohmann::ordered_json node);
  void animate(int node, const char* path, int input, int output, const char* interpolation);

  /// Everything is added; `before`: bytes of the buffer that are not of data().
  std::string json(std::uint64_t before);
  /// The end of the buffer. Where it begins must be told before anything is added to it.
  const std::string& data() const { return data_; }
  void set_data_begin(std::uint64_t begin) { data_begin_ = begin; }

 private:
  int add(const char* array, nlohmann::ordered_json element);

  nlohmann::ordered_json document_;
  std::string data_;
  std::uint64_t data_begin_ = 0;
};

}  // namespace weft::cli
