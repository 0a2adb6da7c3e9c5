/// Scenes on their own threads, spoken to through connections as the network does. Run with the tsan preset
/// as well.
#include "host/host.h"

#include <atomic>
#include <random>
#include <thread>
#include <vector>

#include "cloth/world/simulation.h"
#include "fixtures.h"
#include "host/connection.h"
#include "host/wake_list.h"

namespace weft::host::test {
namespace {

/// A connection to a scene, and what it is sent.
struct Guest {
  Guest(Host& host, const std::string& scene)
      : connection(connect(host, scene)), reader(connection->shared_viewer()) {}
  static std::unique_ptr<Connection> connect(Host& host, const std::string& scene) {
    EXPECT_TRUE(host.find(scene)->reserve());
    return std::make_unique<Connection>(host, host.find(scene), protocol::Role::admin, "test");
  }
  void say(const std::string& text) { connection->receive(text, std::chrono::steady_clock::now()); }
  /// Says it and waits for the reply to request `id`.
  json ask(const std::string& text, std::int64_t id) {
    say(text);
    EXPECT_TRUE(reader.wait_until([&] { return !reader.reply(id).is_null(); })) << text;
    return reader.reply(id);
  }
  bool wait_for_frame(const std::function<bool(const protocol::Frame&)>& wanted) {
    return reader.wait_until([&] { return std::any_of(reader.frames.begin(), reader.frames.end(), wanted); });
  }

  std::unique_ptr<Connection> connection;
  Reader reader;
};

TEST(HostOfScenes, WelcomesThenDescribesTheSceneThenSendsFrames) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  ASSERT_TRUE(guest.wait_for_frame([](const auto&) { return true; }));
  ASSERT_GE(guest.reader.texts.size(), 2U);
  EXPECT_EQ(guest.reader.texts[0].at("op"), "welcome");
  EXPECT_EQ(guest.reader.texts[1].at("op"), "scene");
  EXPECT_EQ(guest.reader.texts[1].at("name"), "hung");
}

/// Somebody who is woken: his rounds are counted by one thread alone.
struct Sleeper {
  int wakened = 0;
};

TEST(WakeList, WhoWakesTheFirstHasTheRoundToMake) {
  WakeList<Sleeper> list;
  const auto one = std::make_shared<Sleeper>(), other = std::make_shared<Sleeper>();
  EXPECT_TRUE(list.add(one));
  EXPECT_FALSE(list.add(other));
  {
    const auto gone = std::make_shared<Sleeper>();
    EXPECT_FALSE(list.add(gone));
  }
  const auto wake = [&](Sleeper& sleeper) {
    ++sleeper.wakened;
    if (&sleeper != one.get()) return;
    EXPECT_TRUE(list.add(other)) << "the list is free while the round is made";
  };
  list.go_round(wake);
  EXPECT_EQ(one->wakened, 1);
  EXPECT_EQ(other->wakened, 1) << "the second time it is the next round's";
  list.go_round(wake);
  EXPECT_EQ(other->wakened, 2);
}

// Many threads wake, one goes round: nobody who was woken sleeps on.
TEST(WakeList, NobodyWhoIsWokenIsForgotten) {
  constexpr int kSleepers = 50, kWakers = 3, kTimes = 2000;
  WakeList<Sleeper> list;
  std::vector<std::shared_ptr<Sleeper>> sleepers;
  for (int i = 0; i < kSleepers; ++i) sleepers.push_back(std::make_shared<Sleeper>());
  std::atomic<int> rounds = 0, done = 0;
  std::vector<std::jthread> wakers;
  for (int waker = 0; waker < kWakers; ++waker) {
    wakers.emplace_back([&, waker] {
      for (int i = 0; i < kTimes; ++i) {
        if (list.add(sleepers[static_cast<std::size_t>((i + waker) % kSleepers)])) ++rounds;
      }
      ++done;
    });
  }
  int made = 0;
  while (done < kWakers || made < rounds) {
    if (made == rounds) continue;
    list.go_round([](Sleeper& sleeper) { ++sleeper.wakened; });
    ++made;
  }
  int wakened = 0;
  for (const auto& sleeper : sleepers) wakened += sleeper->wakened;
  EXPECT_EQ(wakened, kWakers * kTimes);
}

TEST(HostOfScenes, ASceneWithoutViewersSleeps) {
  Host host;
  host.add(hung_cloth("alone"));
  host.add(hung_cloth("seen"));
  {
    Guest guest(host, "seen");
    ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.frame >= 20; }));
    EXPECT_EQ(host.find("alone")->frame(), 0U);
  }
  // A viewer wakes it. Which of its first frames arrives is not said: a newer one takes an unsent one's
  // place.
  Guest guest(host, "alone");
  ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.frame >= 1; }));
}

TEST(HostOfScenes, GoesOnWhereItSlept) {
  Host host;
  host.add(hung_cloth("sleeper"));
  host.add(hung_cloth("clock"));
  Guest watch(host, "clock");
  {
    Guest guest(host, "sleeper");
    ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.frame >= 5; }));
  }
  const auto at = host.find("clock")->frame();
  ASSERT_TRUE(watch.wait_for_frame([&](const auto& frame) { return frame.stamp.frame >= at + 30; }));
  const auto slept_at = host.find("sleeper")->frame();
  ASSERT_TRUE(watch.wait_for_frame([&](const auto& frame) { return frame.stamp.frame >= at + 60; }));
  EXPECT_EQ(host.find("sleeper")->frame(), slept_at);
  // Awake again it makes up for nothing: one step at once, the others at their times. (Its first frame need
  // not be the first sent: a newer one takes an unsent one's place.)
  const auto woken = std::chrono::steady_clock::now();
  Guest guest(host, "sleeper");
  ASSERT_TRUE(guest.wait_for_frame([](const auto&) { return true; }));
  const std::chrono::duration<double> awake = std::chrono::steady_clock::now() - woken;
  const auto first = guest.reader.frames.front().stamp.frame;
  EXPECT_GE(first, slept_at);
  EXPECT_LE(first - slept_at, 1.0 + awake.count() / hung_cloth().simulation.time_step);
}

/// A study may take 60 s of processor time (study_thread.cpp), which last longer where other tests share the
/// processor.
constexpr std::chrono::seconds kStudyEnds{300};

TEST(HostOfScenes, StudiesASceneBesideItsSteps) {
  scene::Scene small = hung_cloth();
  ClothDescription& cloth = small.simulation.cloths[0];
  cloth.min_level = cloth.max_level = cloth.initial_level = 3;
  Host host;
  host.add(small);
  Guest guest(host, "hung"), other(host, "hung");
  EXPECT_EQ(guest.ask(R"({"op":"cost","id":1})", 1).at("op"), "ok");
  ASSERT_TRUE(guest.reader.wait_until([&] { return !guest.reader.last("curve").is_null(); }, kStudyEnds));
  const json curve = guest.reader.last("curve");
  ASSERT_EQ(curve.at("levels").size(), 1U) << curve;
  EXPECT_EQ(curve.at("levels")[0].at("level"), 3);
  EXPECT_EQ(curve.at("frames"), 120);  // 2 s
  // Asked for and known: the next is told at once.
  EXPECT_EQ(other.ask(R"({"op":"cost","id":1})", 1).at("op"), "ok");
  ASSERT_TRUE(other.reader.wait_until([&] { return !other.reader.last("curve").is_null(); }, kStudyEnds));
  EXPECT_EQ(other.reader.last("curve"), curve);
}

TEST(HostOfScenes, CommandsTakeEffectAtTheStepTheReplyNames) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.frame >= 10; }));
  const json wind = guest.ask(R"({"op":"wind.set","id":1,"direction":[1,0,0],"speed":8})", 1);
  ASSERT_TRUE(guest.wait_for_frame([&](const auto& frame) { return frame.stamp.frame >= 40; }));
  const json pause = guest.ask(R"({"op":"pause","id":2})", 2);
  const auto end = pause.at("f").get<std::uint32_t>();
  ASSERT_TRUE(guest.wait_for_frame([&](const auto& frame) {
    return frame.stamp.frame == end && (frame.stamp.flags & protocol::kFlagPaused) != 0;
  }));

  // The same scene alone, the wind set before the very step that was named.
  Simulation<float> alone(hung_cloth().simulation);
  alone.request_level(0, 5);
  while (alone.step_count() < end) {
    if (alone.step_count() + 1 == wind.at("f").get<std::uint64_t>()) alone.set_wind({{1, 0, 0}, 8});
    alone.step();
  }
  const protocol::ClothRecord& shown = guest.reader.frames.back().cloths[0];
  ASSERT_EQ(shown.level, 5);
  for (int r = 0; r < shown.rows; ++r) {
    for (int c = 0; c < shown.cols; ++c) {
      const Vec3 p = alone.cloths()[0].particles().position_at(r, c);
      for (int axis = 0; axis < 3; ++axis) {
        const double value =
            double(shown.positions[static_cast<std::size_t>(3 * (r * shown.cols + c) + axis)]);
        // Half a quantum of the frame; the decoder's rounding.
        ASSERT_NEAR(value, p[axis], 0.5 * double(shown.quantisation.quantum) + 1e-6);
      }
    }
  }
}

TEST(HostOfScenes, StepsOfAPausedSceneArriveAsFrames) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  const auto paused = guest.ask(R"({"op":"pause","id":1})", 1).at("f").get<std::uint32_t>();
  const json ok = guest.ask(R"({"op":"step","id":2,"count":3})", 2);
  EXPECT_EQ(ok.at("f"), paused + 3);
  ASSERT_TRUE(guest.wait_for_frame([&](const auto& frame) { return frame.stamp.frame == paused + 3; }));
  EXPECT_EQ(guest.ask(R"({"op":"ping","id":3,"t":1.5})", 3).at("f"), paused + 3);
  const json reset = guest.ask(R"({"op":"reset","id":4})", 4);
  EXPECT_EQ(reset.at("f"), 0);
  EXPECT_EQ(reset.at("epoch"), 2);
  ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.epoch == 2; }));
  EXPECT_EQ(guest.reader.frames.back().stamp.frame, 0U);
}

TEST(HostOfScenes, TakesAViewerFromSceneToScene) {
  Host host;
  host.add(hung_cloth("first"));
  host.add(hung_cloth("second"));
  Guest guest(host, "first");
  ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.frame >= 3; }));
  const json list = guest.ask(R"({"op":"scene.list","id":1})", 1).at("scenes");
  EXPECT_EQ(list, json({{{"name", "first"}, {"title", "A cloth"}, {"viewers", 1}, {"cloths", 1}},
                        {{"name", "second"}, {"title", "A cloth"}, {"viewers", 0}, {"cloths", 1}}}));
  EXPECT_EQ(guest.ask(R"({"op":"scene.join","id":2,"scene":"third"})", 2).at("path"), "/scene");
  EXPECT_EQ(guest.ask(R"({"op":"scene.join","id":3,"scene":"second"})", 3).at("op"), "ok");
  ASSERT_TRUE(guest.reader.wait_until([&] { return guest.reader.last("scene").at("name") == "second"; }));
  EXPECT_EQ(host.find("first")->viewers(), 0);
  EXPECT_EQ(host.find("second")->viewers(), 1);
  // `ok` stands before `scene`.
  std::vector<std::string> order;
  for (const json& text : guest.reader.texts) {
    if (text.value("re", 0) == 3 || text.value("name", "") == "second") order.push_back(text.at("op"));
  }
  EXPECT_EQ(order, (std::vector<std::string>{"ok", "scene"}));
  EXPECT_EQ(guest.ask(R"({"op":"scene.join","id":4,"scene":"second"})", 4).at("op"), "ok");
  EXPECT_EQ(host.find("second")->viewers(), 1);  // its own scene again: one place
}

TEST(HostOfScenes, AFullSceneHasNoPlace) {
  protocol::Limits limits;
  limits.viewers = 2;
  Host host(limits);
  host.add(hung_cloth("small"));
  host.add(hung_cloth("other"));
  Guest first(host, "small"), second(host, "small"), third(host, "other");
  EXPECT_FALSE(host.find("small")->reserve());
  EXPECT_EQ(third.ask(R"({"op":"scene.join","id":1,"scene":"small"})", 1).at("code"), "limit");
  first.connection.reset();
  EXPECT_EQ(third.ask(R"({"op":"scene.join","id":2,"scene":"small"})", 2).at("op"), "ok");
}

TEST(HostOfScenes, TooManyMessagesAreDroppedButAcknowledgementsCount) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  EXPECT_EQ(guest.ask(R"({"op":"hello","id":1,"caps":["flow.ack","else"],"window":1})", 1).at("caps"),
            json({"flow.ack"}));
  const auto now = std::chrono::steady_clock::now();
  int dropped = 0;
  for (int i = 2; i <= 160; ++i) {
    const auto pace =
        guest.connection->receive(R"({"op":"ping","id":)" + std::to_string(i) + R"(,"t":0})", now);
    EXPECT_NE(pace, Connection::Pace::end);
    dropped += pace == Connection::Pace::slow_down;
    guest.reader.drain();
  }
  EXPECT_GE(dropped, 159 - 121);  // 120 a second; one more may have been regained since the start
  guest.reader.drain();
  EXPECT_EQ(guest.reader.reply(160).at("code"), "rate");
  // In spite of that the frames go on as long as each is acknowledged.
  ASSERT_TRUE(guest.wait_for_frame([](const auto&) { return true; }));
  for (int i = 0; i < 5; ++i) {
    const auto frames = guest.reader.frames.size();
    const auto f = guest.reader.frames.back().stamp.frame;
    // The first may have been sent before `hello`, and then need none.
    const auto pace = guest.connection->receive(R"({"op":"ack","f":)" + std::to_string(f) + "}", now);
    EXPECT_TRUE(pace == Connection::Pace::go_on || i == 0);
    ASSERT_TRUE(guest.reader.wait_until([&] { return guest.reader.frames.size() > frames; }));
  }
}

TEST(HostOfScenes, WhoGoesOnSendingTooMuchIsCutOff) {
  Host host;
  host.add(hung_cloth());
  // 240 is what the server reads of a flood: as many are dropped as are taken.
  const auto sent_until_cut_off = [&](int a_second) {
    Guest sender(host, "hung");
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20 * a_second; ++i) {
      const auto now = start + std::chrono::microseconds(i * 1000000LL / a_second);
      if (sender.connection->receive(R"({"op":"ping","t":0})", now) == Connection::Pace::end) return i;
      sender.reader.drain();
    }
    return -1;
  };
  EXPECT_EQ(sent_until_cut_off(110), -1);
  EXPECT_EQ(sent_until_cut_off(170), -1);         // a hand on a fast screen: some are dropped, no more
  EXPECT_NEAR(sent_until_cut_off(240), 480, 40);  // a second until some are dropped, and one more
}

// It comes after the replies to what was sent before it, although nothing but the scene can answer those.
TEST(HostOfScenes, APongIsABarrier) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  ASSERT_TRUE(guest.wait_for_frame([](const auto&) { return true; }));
  for (int i = 0; i < 10; ++i) {
    const int id = 10 * i + 1;
    for (int k = 0; k < 5; ++k)
      guest.say(R"({"op":"wind.set","id":)" + std::to_string(id + k) + R"(,"direction":[1,0,0],"speed":1})");
    guest.ask(R"({"op":"ping","id":)" + std::to_string(id + 5) + R"(,"t":0})", id + 5);
  }
  std::vector<std::int64_t> order;
  for (const json& text : guest.reader.texts) {
    if (text.contains("re")) order.push_back(text.at("re"));
  }
  EXPECT_EQ(order.size(), 60U);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(HostOfScenes, APongTellsTheClockOfFrames) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  ASSERT_TRUE(guest.wait_for_frame([](const auto& frame) { return frame.stamp.frame >= 2; }));
  const json pong = guest.ask(R"({"op":"ping","id":1,"t":0})", 1);
  const std::uint32_t age =
      pong.at("server_ms").get<std::uint32_t>() - guest.reader.frames.front().stamp.server_ms;
  EXPECT_LT(age, 60000U);
}

TEST(HostOfScenes, StepsOfAPausedSceneAreNotPaced) {
  scene::Scene slow = hung_cloth();
  ClothDescription& cloth = slow.simulation.cloths[0];
  cloth.min_level = cloth.max_level = cloth.initial_level = 3;
  slow.simulation.time_step = 1.0 / 15;
  Host host;
  host.add(slow);
  Guest guest(host, "hung");
  const auto paused = guest.ask(R"({"op":"pause","id":1})", 1).at("f").get<std::uint32_t>();
  const auto begin = std::chrono::steady_clock::now();
  guest.ask(R"({"op":"step","id":2,"count":600})", 2);  // 40 s of the scene: a fraction of a second
  ASSERT_TRUE(guest.wait_for_frame([&](const auto& frame) { return frame.stamp.frame == paused + 600; }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  EXPECT_LT(guest.reader.frames.size(), 600U);  // shown are some of them, and the last
}

// A step of half a minute: nobody waits for its end.
TEST(HostOfScenes, AStopInterruptsTheStepInHand) {
  scene::Scene heavy = hung_cloth();
  ClothDescription& cloth = heavy.simulation.cloths[0];
  cloth.min_level = cloth.max_level = cloth.initial_level = 8;
  heavy.simulation.integrator = XpbdDescription{.substeps = 100000};
  auto host = std::make_unique<Host>();
  host->add(heavy);
  auto guest = std::make_unique<Guest>(*host, "hung");
  ASSERT_TRUE(guest->reader.wait_until([&] { return !guest->reader.last("scene").is_null(); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  guest.reset();
  const auto begin = std::chrono::steady_clock::now();
  host.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(HostOfScenes, MalformedMessagesAreAnsweredAndHarmless) {
  Host host;
  host.add(hung_cloth());
  Guest guest(host, "hung");
  const json error = guest.ask(R"({"op":"wind.set","id":7,"direction":[1,0,0],"speed":1000})", 7);
  EXPECT_EQ(error.at("code"), "range");
  EXPECT_EQ(error.at("path"), "/speed");
  EXPECT_EQ(guest.ask(R"({"op":"ping","id":8,"t":1})", 8).at("op"), "pong");
}

TEST(HostOfScenes, SlowsTheClockWhenStepsTakeTooLong) {
  scene::Scene heavy = hung_cloth("heavy");
  heavy.camera_distance = 0.5;  // level 6
  heavy.simulation.time_step = 1.0 / 240.0;
  heavy.simulation.integrator = SymplecticEulerDescription{600, 0.9};  // more than 10 ms a step, of 4.2 ms
  Host host;
  host.add(heavy);
  Guest guest(host, "heavy");
  ASSERT_TRUE(guest.reader.wait_until([&] { return !guest.reader.last("notice", "slow").is_null(); }));
  ASSERT_TRUE(
      guest.wait_for_frame([](const auto& frame) { return (frame.stamp.flags & protocol::kFlagSlow) != 0; }));
  ASSERT_TRUE(guest.reader.wait_until([&] {
    const json stats = guest.reader.last("stats");
    return !stats.is_null() && stats.at("rate") < 0.9;
  }));
}

TEST(HostOfScenes, TwoScenesOfOneNameAreRefused) {
  Host host;
  host.add(hung_cloth());
  EXPECT_THROW(host.add(hung_cloth()), std::invalid_argument);
}

/// Many clients at once, each on a thread of its own, coming, commanding and going. What is checked is that
/// every frame can be decoded and every request is answered; the thread sanitizer checks the rest.
TEST(HostOfScenes, StandsACrowd) {
  constexpr int kClients = 6, kRounds = 4, kRequests = 40;
  Host host;
  host.add(hung_cloth("a"));
  host.add(hung_cloth("b"));
  std::vector<std::jthread> clients;
  std::atomic<int> unanswered = 0;
  for (int client = 0; client < kClients; ++client) {
    clients.emplace_back([&, client] {
      std::mt19937 random(static_cast<unsigned>(client));
      const std::vector<std::string> requests{
          R"("op":"camera","distance":0.5)",
          R"("op":"camera","eye":[0,0,20])",
          R"("op":"ball.add","position":[0,0,1],"radius":0.1,"velocity":[0,0,-2])",
          R"("op":"ball.throw","ball":1,"velocity":[0,1,-1])",
          R"("op":"ball.remove","ball":2)",
          R"("op":"wind.set","direction":[0,1,-1],"speed":4)",
          R"("op":"pause")",
          R"("op":"step","count":2)",
          R"("op":"resume")",
          R"("op":"reset")",
          R"("op":"scene.join","scene":"a")",
          R"("op":"scene.join","scene":"b")",
          R"("op":"scene.list")",
          R"("op":"hello","caps":["flow.ack"],"window":8)",
          R"("op":"nonsense")"};
      for (int round = 0; round < kRounds; ++round) {
        Guest guest(host, client % 2 ? "a" : "b");
        for (int id = 1; id <= kRequests; ++id) {
          guest.say("{" + requests[random() % requests.size()] + ",\"id\":" + std::to_string(id) + "}");
          guest.reader.drain();
          for (const auto& frame : guest.reader.frames) {
            guest.say(R"({"op":"ack","f":)" + std::to_string(frame.stamp.frame) + "}");
          }
          guest.reader.frames.clear();
        }
        for (int id = 1; id <= kRequests; ++id) {
          if (!guest.reader.wait_until([&] { return !guest.reader.reply(id).is_null(); })) ++unanswered;
        }
      }
    });
  }
  clients.clear();  // joins
  EXPECT_EQ(unanswered, 0);
  EXPECT_EQ(host.find("a")->viewers() + host.find("b")->viewers(), 0);
}

}  // namespace
}  // namespace weft::host::test
