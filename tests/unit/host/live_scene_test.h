#pragma once
/// A live scene on the test's thread, with two viewers in it.
#include <functional>

#include "cloth/world/state_hash.h"
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
    live.tell_events();
    drain();
    return reader.reply(id);
  }
  void drain() {
    reader.drain();
    other.drain();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) live.step();
  }
  /// What a viewer who comes now is told.
  json scene_now() {
    Reader late;
    live.add_viewer(late.viewer, late.viewer->enter());
    late.drain();
    return late.last("scene");
  }
  /// Steps on as one that begins with `scene` does, to the bit, whatever is said before its steps.
  void expect_steps_as(
      const scene::Scene& scene, const std::function<void()>& before_step = [] {}) {
    LiveScene fresh(scene, protocol::Limits{});
    Reader alone;
    fresh.add_viewer(alone.viewer, alone.viewer->enter());
    for (int i = 0; i < 30; ++i) {
      before_step();
      live.step();
      fresh.step();
      ASSERT_EQ(state_hash(live.simulation()), state_hash(fresh.simulation())) << "after step " << i;
    }
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
    live.tell_events();
    live.publish(0);
    drain();
  }
};

}  // namespace weft::host::test
