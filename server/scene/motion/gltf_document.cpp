#include "scene/motion/gltf_document.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "scene/document.h"
#include "scene/motion/data_uri.h"

namespace weft::scene {
namespace {

using nlohmann::json;

[[noreturn]] void refuse_gltf(const std::string& what) { throw std::invalid_argument(what); }

template <class Number>
Number little_endian(std::string_view bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// The chunks of a .glb file; a .gltf file has the text alone.
struct GltfChunks {
  std::string_view text, binary;
};

GltfChunks chunks_of(std::string_view bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;  // "JSON", "BIN"
  if (!bytes.starts_with("glTF")) return {bytes, {}};
  if (bytes.size() < kHeader) refuse_gltf("ends within the header of a .glb file");
  const auto version = little_endian<std::uint32_t>(bytes, 4);
  if (version != 2) refuse_gltf("is of glTF's version " + std::to_string(version) + "; must be 2");
  GltfChunks chunks;
  for (std::size_t at = kHeader; at < bytes.size();) {
    if (bytes.size() - at < kChunkHeader)
      refuse_gltf("ends within a chunk's header, at byte " + std::to_string(at));
    const std::size_t length = little_endian<std::uint32_t>(bytes, at);
    const auto type = little_endian<std::uint32_t>(bytes, at + 4);
    at += kChunkHeader;
    if (length > bytes.size() - at)
      refuse_gltf("has at byte " + std::to_string(at) + " a chunk of " + std::to_string(length) +
                  " bytes, of which " + std::to_string(bytes.size() - at) + " are there");
    if (type == kJson && chunks.text.empty()) chunks.text = bytes.substr(at, length);
    if (type == kBinary && chunks.binary.empty()) chunks.binary = bytes.substr(at, length);
    at += length;
  }
  return chunks;
}

/// What one component of an accessor is in the buffer.
struct ComponentType {
  std::uint64_t code;
  std::size_t size;
  double (*read)(std::string_view bytes, std::size_t at);
  double most;  ///< what becomes 1 if the accessor is normalised
};

template <class Number>
double read_as(std::string_view bytes, std::size_t at) {
  return static_cast<double>(little_endian<Number>(bytes, at));
}

const ComponentType& component_type(std::uint64_t code) {
  static constexpr std::array<ComponentType, 6> kTypes = {{{5120, 1, read_as<std::int8_t>, 127},
                                                           {5121, 1, read_as<std::uint8_t>, 255},
                                                           {5122, 2, read_as<std::int16_t>, 32767},
                                                           {5123, 2, read_as<std::uint16_t>, 65535},
                                                           {5125, 4, read_as<std::uint32_t>, 4294967295.0},
                                                           {5126, 4, read_as<float>, 1}}};
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const ComponentType& type) { return type.code == code; });
  if (found == kTypes.end())
    refuse_gltf("has components of type " + std::to_string(code) + ", which glTF does not know");
  return *found;
}

std::size_t components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  return type == "VEC4" ? 4 : 16;
}

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, const ReadBuffer& read_buffer) {
  const GltfChunks chunks = chunks_of(bytes);
  Document document = read_document(chunks.text);
  if (!document.problems.empty()) refuse_gltf("is no glTF document: " + document.problems.front().text());
  tree_ = std::move(document.tree);
  std::string version;
  read_part(tree_, "", [&](Object& object) {
    if (object.require("asset", "an object")) {
      read_part(*object.find("asset"), "/asset", [&](Object& asset) {
        if (asset.require("version", "\"2.0\"")) asset.string("version", version, 16);
      });
    }
  });
  if (!version.starts_with("2."))
    refuse_gltf("is of glTF's version \"" + version.substr(0, 16) + "\"; must be 2.0");
  std::size_t left = kMaxGltfBytes;
  for (std::size_t i = 0; i < count("buffers"); ++i) {
    std::string uri;
    std::uint64_t length = 0;
    read("buffers", i, [&](Object& buffer) {
      if (buffer.require("byteLength", "an integer"))
        buffer.integer("byteLength", length, {1, static_cast<double>(left)});
      if (buffer.has("uri")) buffer.string("uri", uri, kMaxTextBytes);
    });
    std::string held;
    if (!uri.empty()) held = is_data_uri(uri) ? data_of_uri(uri) : read_buffer(uri);
    const std::string_view data = uri.empty() ? std::string_view(chunks.binary) : held;
    if (data.size() < length)
      refuse_gltf("has at " + element_path("/buffers", i) + " a buffer of " + std::to_string(length) +
                  " bytes, of which " + std::to_string(data.size()) + " are there");
    buffers_.emplace_back(data.substr(0, length));  // no more is kept of what many may share
    left -= length;
  }
}

std::size_t GltfDocument::count(const char* list) const {
  const auto found = tree_.find(list);
  if (found == tree_.end()) return 0;
  if (!found->is_array() || found->size() > kMaxGltfElements)
    refuse_gltf("has at /" + std::string(list) + " no array of at most " + std::to_string(kMaxGltfElements) +
                " elements");
  return found->size();
}

const json& GltfDocument::element(const char* list, std::size_t index) const {
  if (index >= count(list))
    refuse_gltf("has no element " + std::to_string(index) + " of /" + list + ", which has " +
                std::to_string(count(list)));
  return tree_[list][index];
}

std::size_t GltfDocument::index(Object& object, const char* key, const char* list) const {
  const std::size_t all = count(list);
  std::uint64_t read = 0;
  if (all == 0) {
    object.problem(key, "needs an element of /" + std::string(list) + ", which has none");
  } else if (object.require(key, "an index of /" + std::string(list))) {
    object.integer(key, read, {0, static_cast<double>(all - 1)});
  }
  throw_first(object.report());
  return read;
}

std::string_view GltfDocument::view(std::size_t index, std::size_t& stride) const {
  std::uint64_t offset = 0, length = 0, step = 0;
  std::size_t buffer = 0;
  constexpr Range kBytes{0, static_cast<double>(kMaxGltfBytes), "bytes"};
  read("bufferViews", index, [&](Object& object) {
    buffer = this->index(object, "buffer", "buffers");
    object.integer("byteOffset", offset, kBytes);
    object.require("byteLength", kBytes);
    object.integer("byteLength", length, kBytes);
    object.integer("byteStride", step, {4, 252, "bytes"});
  });
  const std::string_view bytes = buffers_[buffer];
  if (offset > bytes.size() || length > bytes.size() - offset)
    refuse_gltf("has at " + element_path("/bufferViews", index) + " a view beyond the " +
                std::to_string(bytes.size()) + " bytes of its buffer");
  stride = step;
  return bytes.substr(offset, length);
}

GltfDocument::Numbers GltfDocument::numbers(std::size_t accessor, std::string_view type) const {
  const std::string path = element_path("/accessors", accessor);
  Numbers numbers;
  numbers.components = components_of(type);
  std::uint64_t offset = 0, elements = 0, code = 0;
  std::size_t view_index = 0;
  bool normalized = false;
  read("accessors", accessor, [&](Object& object) {
    std::string found;
    object.require("type", "a type");
    if (object.string("type", found, 16) && found != type)
      object.report().refuse(json(found), object.path("type"),
                             quoted_list({type}) + " for what it is read as");
    if (object.has("sparse")) object.problem("sparse", "is given; sparse accessors are not read");
    view_index = index(object, "bufferView", "bufferViews");
    object.integer("byteOffset", offset, {0, static_cast<double>(kMaxGltfBytes), "bytes"});
    object.require("componentType", "an integer");
    object.integer("componentType", code, {0, 1e6});
    object.require("count", "an integer");
    const std::size_t most = kMaxGltfNumbers / numbers.components;
    object.integer("count", elements, {1, static_cast<double>(most), "elements"});
    object.boolean("normalized", normalized);
  });
  const ComponentType& component = component_type(code);
  std::size_t stride = 0;
  const std::string_view bytes = view(view_index, stride);
  const std::size_t size = component.size * numbers.components;
  if (stride == 0) stride = size;
  if (offset > bytes.size() || (elements - 1) * stride + size > bytes.size() - offset)
    refuse_gltf("has at " + path + " elements beyond the " + std::to_string(bytes.size()) +
                " bytes of its view");
  read_ += elements * numbers.components;
  if (read_ > kMaxGltfNumbers)
    refuse_gltf("has at " + path + " more numbers than the " + std::to_string(kMaxGltfNumbers) +
                " that are read of a file");
  numbers.count = elements;
  numbers.values.reserve(elements * numbers.components);
  for (std::size_t i = 0; i < elements; ++i) {
    for (std::size_t c = 0; c < numbers.components; ++c) {
      double value = component.read(bytes, offset + i * stride + c * component.size);
      if (!std::isfinite(value)) refuse_gltf("has at " + path + " a number that is not finite");
      if (normalized) value = std::max(value / component.most, -1.0);
      numbers.values.push_back(value);
    }
  }
  return numbers;
}

void GltfDocument::throw_first(Report& report) {
  if (report.count() > 0) refuse_gltf("has at " + report.take().front().text());
}

}  // namespace weft::scene
