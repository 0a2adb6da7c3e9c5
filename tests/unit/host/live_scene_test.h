#pragma once
/// A live scene on the test's thread, with two viewers in it.
#include "fixtures.h"
#include "host/live_scene.h"

namespace weft::host::test {

class LiveSceneTest : public ::testing::Test {
 protected:
  explicit LiveSceneTest(const scene::Scene& scene) : live(scene, protocol::Limits{}) {
    visit = reader.viewer->enter();
    live.add_viewer(reader.viewer, visit);
    other_visit = other.viewer->enter();
    live.add_viewer(other.viewer, other_visit);
  }

  /// Gives a command and returns its reply.
  json command(SceneCommand command) {
    live.apply(reader.viewer, visit, {++id, std::move(command)});
    drain();
    return reader.reply(id);
  }
  void drain() {
    reader.drain();
    other.drain();
  }

  LiveScene live;
  Reader reader, other;
  std::uint64_t visit = 0, other_visit = 0;
  std::int64_t id = 0;
};

/// Frames are sent after each command and step, if anything has changed.
class Commands : public LiveSceneTest {
 protected:
  explicit Commands(const scene::Scene& scene = hung_cloth()) : LiveSceneTest(scene) { publish(); }

  json command(SceneCommand command) {
    live.apply(reader.viewer, visit, {++id, std::move(command)});
    publish();
    return reader.reply(id);
  }
  void steps(int count) {
    for (int i = 0; i < count && live.wants_step(); ++i) {
      live.step();
      publish();
    }
  }

 private:
  void publish() {
    live.publish(0);
    drain();
  }
};

}  // namespace weft::host::test
