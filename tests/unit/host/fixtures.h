#pragma once
/// What the host's tests share: a small scene, and a reader of what a viewer is sent.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/viewer.h"
#include "protocol/frame.h"
#include "protocol/message.h"
#include "scene/scene.h"

namespace weft::host::test {

using nlohmann::json;

/// A 2 m cloth hung by its two upper corners in wind; levels 6, 5, 4 within 1 m, 10 m and beyond (Table 1).
inline scene::Scene hung_cloth(const std::string& name = "hung") {
  scene::Scene scene;
  scene.name = name;
  scene.title = "A cloth";
  scene.camera_distance = 5.0;
  ClothDescription cloth;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  cloth.material = {0.1, 200, 20, 0.01, 0.1};
  scene.simulation.cloths = {cloth};
  scene.simulation.effects = {GravityEffect{}, DampingEffect{}, PaperWindEffect{}};
  scene.simulation.wind = {{0, 0, -1}, 1.0};
  return scene;
}

/// All the bytes of a frame message, as they are sent.
inline std::vector<std::uint8_t> bytes_of(const FrameMessage& message) {
  std::vector<std::uint8_t> bytes;
  for (const Record& record : message.records) bytes.insert(bytes.end(), record->begin(), record->end());
  return bytes;
}

inline protocol::Frame decoded(const FrameMessage& message) {
  protocol::Frame frame;
  std::string error;
  EXPECT_TRUE(protocol::decode_frame(bytes_of(message), frame, error)) << error;
  return frame;
}

/// Takes what waits for a viewer, and keeps it.
class Reader {
 public:
  Reader() : Reader(std::make_shared<Viewer>()) {}
  /// Reads an outbox that is there already.
  explicit Reader(std::shared_ptr<Viewer> of) : viewer(std::move(of)) {
    viewer->on_wake([bell = bell_] {
      const std::lock_guard lock(bell->mutex);
      bell->rung = true;
      bell->changed.notify_one();
    });
  }

  /// Takes all there is now.
  void drain() {
    while (auto next = viewer->take()) {
      if (next->text) {
        texts.push_back(json::parse(*next->text));
      } else {
        frames.push_back(decoded(*next->frame));
      }
    }
  }

  /// Drains, as more comes, until `done`; false if that takes longer than a generous time.
  bool wait_until(const std::function<bool()>& done,
                  std::chrono::seconds patience = std::chrono::seconds(60)) {
    const auto limit = std::chrono::steady_clock::now() + patience;
    for (;;) {
      drain();
      if (done()) return true;
      std::unique_lock lock(bell_->mutex);
      if (!bell_->changed.wait_until(lock, limit, [this] { return bell_->rung; })) return false;
      bell_->rung = false;
    }
  }

  /// The newest text with that op (and kind or code), or null.
  json last(const std::string& op, const std::string& kind = "") const {
    for (auto text = texts.rbegin(); text != texts.rend(); ++text) {
      if (text->at("op") != op) continue;
      if (kind.empty() || text->value("kind", "") == kind || text->value("code", "") == kind) return *text;
    }
    return nullptr;
  }
  /// The reply to request `id`, or null.
  json reply(std::int64_t id) const {
    for (const json& text : texts) {
      if (text.value("re", std::int64_t{0}) == id) return text;
    }
    return nullptr;
  }

  std::shared_ptr<Viewer> viewer;
  std::vector<json> texts;
  std::vector<protocol::Frame> frames;

 private:
  /// Outlives the reader: a scene may still ring it.
  struct Bell {
    std::mutex mutex;
    std::condition_variable changed;
    bool rung = false;
  };
  std::shared_ptr<Bell> bell_ = std::make_shared<Bell>();
};

}  // namespace weft::host::test
