#include <chrono>
#include <deque>
#include <utility>

#include "host/viewer.h"

#include <gtest/gtest.h>

namespace weft::host {
namespace {

std::shared_ptr<const FrameMessage> frame(std::uint32_t number) {
  auto message = std::make_shared<FrameMessage>();
  message->frame = number;
  return message;
}

Text text(const std::string& words) { return make_text(words); }

/// The number of the next frame to be sent, -1 if nothing may be.
int next_frame(Viewer& viewer) {
  const auto next = viewer.take();
  return next && next->frame ? static_cast<int>(next->frame->frame) : -1;
}

TEST(Viewer, KeepsTheNewestFrameOnly) {
  Viewer viewer;
  const auto visit = viewer.enter();
  for (std::uint32_t f = 1; f <= 5; ++f) viewer.publish(visit, frame(f));
  EXPECT_EQ(next_frame(viewer), 5);
  EXPECT_EQ(next_frame(viewer), -1);
  EXPECT_EQ(viewer.dropped(), 4U);
}

/// What is to be sent next: the text, or the frame's number.
std::string next(Viewer& viewer) {
  const auto taken = viewer.take();
  if (!taken) return "nothing";
  return taken->text ? *taken->text : std::to_string(taken->frame->frame);
}

TEST(Viewer, AFrameComesAfterTheControlMessagesBeforeIt) {
  Viewer viewer;
  const auto visit = viewer.enter();
  viewer.send(text("a"));
  viewer.send(visit, text("event"), "wind");
  viewer.send(text("b"));
  viewer.publish(visit, frame(1));
  viewer.send(text("c"));
  EXPECT_EQ(next(viewer), "a");
  EXPECT_EQ(next(viewer), "event");
  EXPECT_EQ(next(viewer), "b");
  EXPECT_EQ(next(viewer), "1");
  EXPECT_EQ(next(viewer), "c");
  EXPECT_EQ(next(viewer), "nothing");
}

TEST(Viewer, OfOneKeyTheNewestTakesTheOthersPlace) {
  Viewer viewer;
  const auto visit = viewer.enter();
  for (int i = 0; i < 1000; ++i) viewer.send(visit, text(std::to_string(i)), i % 2 ? "odd" : "even");
  viewer.send(text("reply"));
  EXPECT_FALSE(viewer.overflowed());  // however many: a viewer is not to blame for what others do
  EXPECT_EQ(next(viewer), "998");
  EXPECT_EQ(next(viewer), "999");
  EXPECT_EQ(next(viewer), "reply");
  EXPECT_EQ(next(viewer), "nothing");
}

TEST(Viewer, FramesAndEventsTakeTurns) {
  Viewer viewer;
  const auto visit = viewer.enter();
  std::string order;
  for (const char* key : {"a", "b", "c"}) viewer.send(visit, text(key), key);
  for (std::uint32_t f = 0; f < 4; ++f) {
    viewer.publish(visit, frame(f));
    order += next(viewer);
    order += next(viewer);
  }
  EXPECT_EQ(order, "0a1b2c3nothing");
}

TEST(Viewer, WindowBoundsTheUnacknowledged) {
  Viewer viewer;
  const auto visit = viewer.enter();
  viewer.enable_acks(2);
  for (std::uint32_t f = 1; f <= 2; ++f) {
    viewer.publish(visit, frame(f));
    EXPECT_EQ(next_frame(viewer), static_cast<int>(f));
  }
  viewer.publish(visit, frame(3));
  EXPECT_EQ(next_frame(viewer), -1);
  viewer.publish(visit, frame(4));
  EXPECT_TRUE(viewer.acknowledge(1));
  EXPECT_EQ(next_frame(viewer), 4);    // 3 was replaced while it waited
  EXPECT_TRUE(viewer.acknowledge(4));  // and with it 2
  for (std::uint32_t f = 5; f <= 6; ++f) {
    viewer.publish(visit, frame(f));
    EXPECT_EQ(next_frame(viewer), static_cast<int>(f));
  }
}

/// Frames a second that are taken from a scene of 60 a second, by a viewer that acknowledges each so long
/// after it was sent as the way there and back and itself take.
double rate_by(double way, double viewer_takes, double window_at_end) {
  using Seconds = Viewer::Seconds;
  Viewer viewer;
  const auto visit = viewer.enter();
  viewer.enable_acks(2);
  const auto at = [](double seconds) {
    return Viewer::TimePoint(std::chrono::duration_cast<Viewer::TimePoint::duration>(Seconds(seconds + 100)));
  };
  viewer.ping(at(-way));
  viewer.pong(at(0));
  std::deque<std::pair<double, std::uint32_t>> acks;  // when the server has it
  int taken = 0;
  double free_at = 0;  // when the viewer has done with what came before
  for (std::uint32_t step = 0; step < 600; ++step) {
    const double now = step / 60.0;
    while (!acks.empty() && acks.front().first <= now) {
      viewer.acknowledge(acks.front().second, at(acks.front().first));
      acks.pop_front();
    }
    viewer.publish(visit, frame(step + 1));
    if (const auto next = viewer.take(at(now))) {
      ++taken;
      free_at = std::max(free_at, now + way / 2) + viewer_takes;
      acks.emplace_back(free_at + way / 2, next->frame->frame);
    }
  }
  EXPECT_EQ(viewer.window(), window_at_end) << way << " " << viewer_takes;
  return taken / 10.0;
}

TEST(Viewer, ALongWayHasRoomForMoreFrames) {
  EXPECT_GT(rate_by(0, 0, 2), 59);
  EXPECT_GT(rate_by(0.05, 0, 5), 55);
  EXPECT_GT(rate_by(0.2, 0, 14), 50);  // 9.8 with two on the way
}

TEST(Viewer, ASlowViewerGetsNoMoreThanItTakes) {
  // It takes 5 a second, so that each waits for it.
  EXPECT_LT(rate_by(0, 0.2, 2), 6);
  EXPECT_LT(rate_by(0.1, 0.2, 2), 6);
}

/// Whether frames are found to wait at the client: sent at 60 a second for a second, acknowledged `taken`
/// later each, while a ping takes `ping`.
bool waits_at_client(double taken, double ping) {
  const auto at = [](double seconds) {
    return Viewer::TimePoint(
        std::chrono::duration_cast<Viewer::TimePoint::duration>(Viewer::Seconds(seconds + 100)));
  };
  Viewer viewer;
  const auto visit = viewer.enter();
  viewer.enable_acks(8);
  EXPECT_TRUE(viewer.ping(at(0)));
  EXPECT_FALSE(viewer.ping(at(ping / 2)));
  viewer.pong(at(ping));
  for (std::uint32_t step = 1; step <= 60; ++step) {
    viewer.publish(visit, frame(step));
    EXPECT_EQ(static_cast<std::uint32_t>(viewer.take(at(step / 60.0))->frame->frame), step);
    viewer.acknowledge(step, at(step / 60.0 + taken));
  }
  const Viewer::Flow flow = viewer.flow(at(1 + taken));
  EXPECT_EQ(flow.published, 60);
  EXPECT_EQ(flow.dropped, 0);
  EXPECT_EQ(viewer.flow().published, 0);
  return flow.at_client;
}

TEST(Viewer, WhereFramesWaitIsToldByPings) {
  EXPECT_FALSE(waits_at_client(0.01, 0.001));
  EXPECT_FALSE(waits_at_client(0.5, 0.3));  // what waits for the link delays pings, too
  EXPECT_TRUE(waits_at_client(0.5, 0.001));
}

TEST(Viewer, FramesThatAreNeverAcknowledgedWaitAtTheClient) {
  Viewer viewer;
  const auto visit = viewer.enter();
  viewer.enable_acks(1);
  const Viewer::TimePoint start{};
  viewer.ping(start);
  viewer.pong(start + std::chrono::milliseconds(1));
  viewer.publish(visit, frame(1));
  viewer.take(start);
  viewer.publish(visit, frame(2));
  viewer.publish(visit, frame(3));
  const Viewer::Flow flow = viewer.flow(start + std::chrono::seconds(1));
  EXPECT_EQ(flow.published, 3);
  EXPECT_EQ(flow.dropped, 1);
  EXPECT_TRUE(flow.at_client);
}

TEST(Viewer, AcknowledgingWhatWasNotSentChangesNothing) {
  Viewer viewer;
  const auto visit = viewer.enter();
  viewer.enable_acks(1);
  viewer.publish(visit, frame(7));
  ASSERT_EQ(next_frame(viewer), 7);
  viewer.publish(visit, frame(8));
  EXPECT_FALSE(viewer.acknowledge(6));
  EXPECT_FALSE(viewer.acknowledge(8));
  EXPECT_EQ(next_frame(viewer), -1);
  EXPECT_TRUE(viewer.acknowledge(7));
  EXPECT_EQ(next_frame(viewer), 8);
}

TEST(Viewer, ASceneLeftBehindSendsNothingMore) {
  Viewer viewer;
  const auto before = viewer.enter();
  viewer.enable_acks(1);
  viewer.publish(before, frame(100));
  ASSERT_EQ(next_frame(viewer), 100);
  viewer.publish(before, frame(101));
  const auto now = viewer.enter();
  viewer.publish(before, frame(102));
  viewer.send(before, text("of the scene before"));
  EXPECT_FALSE(viewer.take());
  viewer.publish(now, frame(1));
  EXPECT_EQ(next_frame(viewer), 1);  // although 100 was never acknowledged
}

TEST(Viewer, WakesOnceThereIsSomethingToSend) {
  Viewer viewer;
  int wakes = 0;
  viewer.on_wake([&] { ++wakes; });
  const auto visit = viewer.enter();
  viewer.publish(visit, frame(1));
  EXPECT_EQ(wakes, 0);  // nobody has asked yet
  ASSERT_EQ(next_frame(viewer), 1);
  EXPECT_FALSE(viewer.take());
  viewer.publish(visit, frame(2));
  viewer.publish(visit, frame(3));
  viewer.send(text("a"));
  EXPECT_EQ(wakes, 1);  // until it is asked again
}

TEST(Viewer, WakesNobodyWhoHasGone) {
  Viewer viewer;
  int wakes = 0;
  viewer.on_wake([&] { ++wakes; });
  EXPECT_FALSE(viewer.take());
  viewer.on_wake(nullptr);
  viewer.publish(viewer.enter(), frame(1));
  EXPECT_EQ(wakes, 0);
}

TEST(Viewer, AFrameBeyondTheWindowWakesWhenItIsAcknowledged) {
  Viewer viewer;
  int wakes = 0;
  viewer.on_wake([&] { ++wakes; });
  const auto visit = viewer.enter();
  viewer.enable_acks(1);
  viewer.publish(visit, frame(1));
  ASSERT_EQ(next_frame(viewer), 1);
  EXPECT_FALSE(viewer.take());
  viewer.publish(visit, frame(2));
  EXPECT_EQ(wakes, 0);
  viewer.acknowledge(1);
  EXPECT_EQ(wakes, 1);
  EXPECT_EQ(next_frame(viewer), 2);
}

TEST(Viewer, OverflowsWhenMoreThan256ControlMessagesWait) {
  Viewer viewer;
  int wakes = 0;
  viewer.on_wake([&] { ++wakes; });
  for (int i = 0; i < 256; ++i) viewer.send(text("x"));
  EXPECT_FALSE(viewer.overflowed());  // PROTOCOL.md section 6: more than 256
  EXPECT_EQ(wakes, 0);
  viewer.send(text("x"));
  EXPECT_TRUE(viewer.overflowed());
  EXPECT_EQ(wakes, 1);  // although nobody found the outbox empty before
  viewer.send(text("x"));
  EXPECT_EQ(wakes, 1);
}

}  // namespace
}  // namespace weft::host
