#pragma once
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/motion/gltf_document.h"

namespace weft::scene::test {

/// A glTF document that is put together from lists of numbers.
class GltfText {
 public:
  GltfText() { tree["asset"]["version"] = "2.0"; }

  /// Another accessor, of floats; its index.
  int floats(const std::string& type, const std::vector<float>& values) {
    return add(type, 5126, values.data(), values.size() * sizeof(float), values.size());
  }
  int bytes(const std::string& type, const std::vector<std::uint8_t>& values) {
    return add(type, 5121, values.data(), values.size(), values.size());
  }
  /// An animation's sampler, which moves `path` of the node.
  void animate(int node, const char* path, int input, int output, const char* interpolation = "LINEAR") {
    nlohmann::json& animation = tree["animations"][0];
    const std::size_t sampler = animation["samplers"].size();
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
  }
  std::string glb() {
    tree["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = tree.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string all = "glTF";
    const auto put = [&](std::size_t number) {
      const auto word = static_cast<std::uint32_t>(number);
      all.append(reinterpret_cast<const char*>(&word), sizeof word);
    };
    put(2);
    put(12 + 8 + text.size() + 8 + binary_.size());
    put(text.size());
    all += "JSON" + text;
    put(binary_.size());
    all += std::string("BIN\0", 4) + binary_;
    return all;
  }
  GltfDocument document() {
    const auto none = [](const std::string&) -> std::string { throw std::invalid_argument("no files here"); };
    return {glb(), none};
  }
  nlohmann::json tree;

 private:
  int add(const std::string& type, int component, const void* data, std::size_t size, std::size_t count) {
    const std::size_t components = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
    tree["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}});
    tree["accessors"].push_back({{"bufferView", tree["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", count / components},
                                 {"type", type}});
    binary_.append(static_cast<const char*>(data), size);
    binary_.resize((binary_.size() + 3) / 4 * 4);
    return static_cast<int>(tree["accessors"].size()) - 1;
  }
  std::string binary_;
};

}  // namespace weft::scene::test
