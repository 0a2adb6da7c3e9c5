#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scene/object.h"

namespace weft::scene {

inline constexpr std::size_t kMaxGltfBytes = 64u << 20;     ///< of all buffers together
inline constexpr std::size_t kMaxGltfNumbers = 16'000'000;  ///< read of one file
inline constexpr std::size_t kMaxGltfElements = 1'000'000;  ///< of one list: nodes, accessors, keys' times

/// A glTF 2.0 document and the numbers in its buffers. Of what it says only what is asked for is checked, and
/// nothing outside the buffers is ever read. All throws std::invalid_argument with the JSON pointer of what
/// is wrong. There are no sparse accessors and no compressed ones.
class GltfDocument {
 public:
  /// The bytes of the file that a buffer's "uri", as it stands in the document, names.
  using ReadBuffer = std::function<std::string(const std::string& uri)>;
  /// `bytes` are a .glb file's, or a .gltf file's text.
  GltfDocument(std::string_view bytes, const ReadBuffer& read_buffer);

  /// Elements of one of the document's lists: "nodes".
  std::size_t count(const char* list) const;
  /// Calls read(object) with an element; what `read` reports as a problem is thrown.
  template <class Read>
  void read(const char* list, std::size_t index, Read read) const {
    read_part(element(list, index), element_path(std::string("/") + list, index), read);
  }
  /// The same of a part of it.
  template <class Read>
  static void read_part(const nlohmann::json& value, const std::string& path, Read read) {
    Report report({}, {});
    {
      Object object(value, path, report);
      object.ignore_rest();  // a document has much that is not asked for
      read(object);
    }
    throw_first(report);
  }
  /// The index that the object must have there, of one of the document's lists.
  std::size_t index(Object& object, const char* key, const char* list) const;

  struct Numbers {
    std::size_t count = 0;       ///< of elements
    std::size_t components = 0;  ///< of each
    std::vector<double> values;  ///< finite
    const double* at(std::size_t element) const { return values.data() + element * components; }
  };
  /// An accessor's, of this type: "SCALAR", "VEC2", "VEC3", "VEC4", "MAT4". Normalised integers are from -1
  /// or 0 to 1.
  Numbers numbers(std::size_t accessor, std::string_view type) const;

 private:
  const nlohmann::json& element(const char* list, std::size_t index) const;
  /// The bytes of a buffer view, and how far apart its elements are; 0: without gaps.
  std::string_view view(std::size_t index, std::size_t& stride) const;
  static void throw_first(Report& report);

  nlohmann::json tree_;
  mutable std::size_t read_ = 0;  ///< numbers, of all accessors: they may share bytes
  std::vector<std::string> buffers_;
};

}  // namespace weft::scene
