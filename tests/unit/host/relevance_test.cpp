/// A cloth that no viewer sees: when that is so, what is left out or made coarser then, and that it is all
/// back at once.
#include <cmath>
#include <limits>

#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

using Unseen = Relevance::Unseen;

constexpr int kDwell = 60;  // steps: 1 s

/// hung_cloth(), which is 2 m wide and high around the origin, of which `unseen` is made.
scene::Scene relevant(Unseen unseen, double far = std::numeric_limits<double>::infinity()) {
  scene::Scene scene = hung_cloth();
  scene.simulation.cloths[0].relevance = {unseen, far};
  return scene;
}

/// The same without anything that moves it, so that its bounding sphere has a radius of sqrt(2) m.
scene::Scene still(Unseen unseen, double far) {
  scene::Scene scene = relevant(unseen, far);
  scene.simulation.effects = {};
  return scene;
}

/// From 5 m, with 0.5 rad to each side: at the cloth, and the other way.
protocol::Camera towards(double z) {
  return {.eye = protocol::Vector{0, 0, 5}, .target = protocol::Vector{0, 0, z}, .half_angle = 0.5};
}
const protocol::Camera kAtIt = towards(0), kAway = towards(10);

struct Seen {
  int substeps, simulated_level, sent_level;
  std::string state;
  bool unseen;
  bool operator==(const Seen&) const = default;
};
void PrintTo(const Seen& seen, std::ostream* out) {
  *out << seen.substeps << " substeps at level " << seen.simulated_level << ", sent " << seen.sent_level
       << ", " << seen.state << (seen.unseen ? ", unseen" : "");
}
constexpr int kAwake = 1;  // substeps of the scene's integrator

class Watched {
 public:
  explicit Watched(const scene::Scene& scene, int viewers = 1)
      : live(scene, {}), readers(static_cast<std::size_t>(viewers)) {
    for (Reader& reader : readers) {
      visits.push_back(reader.viewer->enter());
      live.add_viewer(reader.viewer, visits.back());
    }
  }
  void command(const SceneCommand& what, std::size_t viewer = 0) {
    live.apply(readers[viewer].viewer, visits[viewer], {std::nullopt, what});
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      live.step();
      live.publish(0);
      for (Reader& reader : readers) reader.drain();
    }
  }
  /// What a viewer is told of the first cloth, and sees of it.
  Seen seen(std::size_t viewer = 0) {
    live.send_stats(1);
    Reader& reader = readers[viewer];
    reader.drain();
    const json cloth = reader.last("stats").at("cloths").at(0);
    const protocol::ClothRecord& record = reader.frames.back().cloths[0];
    EXPECT_EQ(record.level, cloth.at("level"));
    EXPECT_EQ(record.simulated_level, cloth.at("simulated_level"));
    return {cloth.at("substeps"), record.simulated_level, record.level, cloth.at("state"),
            cloth.value("unseen", false)};
  }

  LiveScene live;
  std::vector<Reader> readers;
  std::vector<std::uint64_t> visits;
};

const Seen kFine{kAwake, 5, 5, "awake", false};  // Table 1: level 5 from 1 m to 10 m

TEST(RelevanceTest, OneThatMaySleepDoesSoASecondAfterItWasSeenLast) {
  Watched scene(relevant(Unseen::sleep));
  scene.command(kAtIt);
  scene.steps(2 * kDwell);
  EXPECT_EQ(scene.seen(), kFine);
  scene.command(kAway);
  scene.steps(kDwell);
  EXPECT_EQ(scene.seen(), kFine);
  const Particles<float> left = scene.live.simulation().cloths()[0].particles();
  scene.steps(1);
  EXPECT_EQ(scene.seen(), (Seen{0, 5, 4, "asleep", true}));
  scene.steps(100);
  EXPECT_EQ(scene.seen(), (Seen{0, 5, 4, "asleep", true}));
  const Particles<float>& now = scene.live.simulation().cloths()[0].particles();
  EXPECT_TRUE(now.position.x.values() == left.position.x.values() &&
              now.position.z.values() == left.position.z.values());
  scene.command(kAtIt);
  scene.steps(1);
  EXPECT_EQ(scene.seen(), kFine);
}

TEST(RelevanceTest, OneThatMayBeCoarseIsSteppedAtItsLowestLevel) {
  Watched scene(relevant(Unseen::coarse));
  scene.command(kAway);
  scene.steps(kDwell);
  EXPECT_EQ(scene.seen(), kFine);
  scene.steps(1);
  EXPECT_EQ(scene.seen(), (Seen{kAwake, 4, 4, "awake", true}));
  scene.steps(50);
  EXPECT_EQ(scene.seen(), (Seen{kAwake, 4, 4, "awake", true}));
  scene.command(kAtIt);
  scene.steps(1);
  EXPECT_EQ(scene.seen(), kFine);
}

TEST(RelevanceTest, WithoutAWordOfItNothingChanges) {
  Watched scene(hung_cloth());
  scene.command(kAway);
  scene.steps(2 * kDwell);
  EXPECT_EQ(scene.seen(), kFine);
  scene.command(protocol::Camera{.eye = protocol::Vector{0, 0, 1e6}});
  scene.steps(2 * kDwell);
  EXPECT_EQ(scene.seen(), (Seen{kAwake, 4, 4, "awake", false}));  // Table 1, beyond 10 m
}

TEST(RelevanceTest, WhoTellsNoConeSeesInEveryDirection) {
  for (const protocol::Camera& camera :
       {protocol::Camera{.distance = 5}, protocol::Camera{.eye = kAway.eye}}) {
    Watched scene(relevant(Unseen::sleep));
    scene.command(kAway);  // is forgotten
    scene.steps(10);
    scene.command(camera);
    scene.steps(2 * kDwell);
    EXPECT_EQ(scene.seen(), kFine);
  }
}

TEST(RelevanceTest, WhoLooksAroundForLessThanASecondLosesNothing) {
  Watched scene(relevant(Unseen::sleep));
  for (int round = 0; round < 3; ++round) {
    scene.command(kAway);
    scene.steps(kDwell);
    EXPECT_EQ(scene.seen(), kFine);
    scene.command(kAtIt);
    scene.steps(1);
    EXPECT_EQ(scene.seen(), kFine);
  }
}

TEST(RelevanceTest, ASecondIsOneOfTheScenesTime) {
  scene::Scene scene = relevant(Unseen::sleep);
  scene.simulation.time_step = 1.0 / 240;
  Watched watched(scene);
  watched.command(kAway);
  watched.steps(240);
  EXPECT_EQ(watched.seen().substeps, kAwake);
  watched.steps(4);
  EXPECT_EQ(watched.seen().substeps, 0);
}

TEST(RelevanceTest, WhileOneSeesItItIsSteppedForAllAndSentCoarselyToTheOthers) {
  for (const Unseen unseen : {Unseen::sleep, Unseen::coarse}) {
    Watched scene(relevant(unseen), 2);
    scene.command(kAtIt, 0);
    scene.command(kAway, 1);
    scene.steps(2 * kDwell);
    EXPECT_EQ(scene.seen(0), kFine);
    EXPECT_EQ(scene.seen(1), (Seen{kAwake, 5, 4, "awake", false}));
    scene.command(kAway, 0);
    scene.steps(kDwell + 1);
    EXPECT_TRUE(scene.seen(0).unseen && scene.seen(1).unseen);
    scene.command(kAtIt, 1);
    scene.steps(1);
    EXPECT_EQ(scene.seen(0), (Seen{kAwake, 5, 4, "awake", false}));
    EXPECT_EQ(scene.seen(1), kFine);
  }
}

// The sphere of sqrt(2) = 1.4142 m touches the cone of 0.5 rad when its centre, 5 m ahead, is at most
// 5 tan 0.5 + 1.4142 / cos 0.5 = 2.7315 + 1.6115 = 4.3430 m aside.
TEST(RelevanceTest, ItIsSeenWhenItsBoundingSphereIsTouched) {
  for (const auto& [aside, sees] :
       {std::pair{4.342, true}, {4.344, false}, {-4.342, true}, {-4.344, false}}) {
    Watched scene(still(Unseen::sleep, 1e6));
    scene.command(protocol::Camera{
        .eye = protocol::Vector{aside, 0, 5}, .target = protocol::Vector{aside, 0, 0}, .half_angle = 0.5});
    scene.steps(kDwell + 1);
    EXPECT_EQ(scene.seen().unseen, !sees) << aside;
  }
}

// As far as 30 m: 31.4142 m from its centre.
TEST(RelevanceTest, BeyondItsFarLimitItIsNotSeenByAnybody) {
  for (const auto& [distance, sees] : {std::pair{31.414, true}, {31.415, false}}) {
    protocol::Camera with_cone = towards(0);
    with_cone.eye = protocol::Vector{0, 0, distance};
    for (const protocol::Camera& camera :
         {with_cone, protocol::Camera{.eye = with_cone.eye}, protocol::Camera{.distance = distance}}) {
      Watched scene(still(Unseen::coarse, 30));
      scene.command(camera);
      scene.steps(kDwell + 1);
      EXPECT_EQ(scene.seen().unseen, !sees) << distance;
    }
  }
}

TEST(RelevanceTest, EachClothIsSeenForItself) {
  scene::Scene scene = relevant(Unseen::sleep);
  scene.simulation.cloths.push_back(scene.simulation.cloths[0]);
  scene.simulation.cloths[1].position = {20, 0, 0};
  Watched watched(scene);
  watched.command(kAtIt);
  watched.steps(kDwell + 1);
  EXPECT_EQ(watched.live.simulation().last_advance(0).substeps, kAwake);
  EXPECT_EQ(watched.live.simulation().last_advance(1).substeps, 0);
  const protocol::Frame& frame = watched.readers[0].frames.back();
  EXPECT_EQ(frame.cloths[0].level, 5);
  EXPECT_EQ(frame.cloths[1].level, 4);
}

TEST(RelevanceTest, WhoComesNearWakesIt) {
  Watched scene(relevant(Unseen::sleep));
  scene.command(kAway);
  scene.steps(kDwell + 1);
  ASSERT_EQ(scene.seen().substeps, 0);
  Reader late;
  const std::uint64_t visit = late.viewer->enter();
  scene.live.add_viewer(late.viewer, visit);
  scene.steps(1);
  EXPECT_EQ(scene.seen().substeps, 0) << "nobody knows yet where it is";
  scene.live.apply(late.viewer, visit, {std::nullopt, kAtIt});
  scene.steps(1);
  EXPECT_EQ(scene.seen(), (Seen{kAwake, 5, 4, "awake", false}));
  scene.live.remove_viewer(late.viewer.get(), visit);
  scene.steps(1);
  EXPECT_EQ(scene.seen(), (Seen{0, 5, 4, "asleep", true})) << "who stays has not seen it for long";
}

TEST(RelevanceTest, WithoutViewersAllStandsStillWhateverIsSaid) {
  Watched scene(relevant(Unseen::step));
  EXPECT_TRUE(scene.live.wants_step());
  scene.live.remove_viewer(scene.readers[0].viewer.get(), scene.visits[0]);
  EXPECT_FALSE(scene.live.wants_step());
}

TEST(RelevanceTest, AResetShowsItToAllAgain) {
  Watched scene(relevant(Unseen::sleep));
  scene.command(kAway);
  scene.steps(kDwell + 1);
  ASSERT_EQ(scene.seen().substeps, 0);
  scene.command(protocol::Reset{});
  scene.steps(kDwell);
  EXPECT_EQ(scene.seen(), kFine);
  scene.steps(1);
  EXPECT_EQ(scene.seen(), (Seen{0, 5, 4, "asleep", true}));
}

TEST(RelevanceTest, InAPausedSceneItIsFineAgainAtOnce) {
  Watched scene(relevant(Unseen::coarse));
  scene.command(kAway);
  scene.steps(kDwell + 1);
  scene.command(protocol::Pause{});
  scene.live.publish(0);
  EXPECT_EQ(scene.seen().sent_level, 4);
  scene.command(kAtIt);
  scene.live.publish(0);
  EXPECT_EQ(scene.seen().sent_level, 5);
}

TEST(RelevanceTest, TheSceneTellsViewersOfIt) {
  const auto told = [](const scene::Scene& scene) {
    Watched watched(scene);
    watched.readers[0].drain();
    return watched.readers[0].last("scene").at("cloths").at(0).value("relevance", json());
  };
  EXPECT_EQ(told(relevant(Unseen::sleep, 30)), (json{{"unseen", "sleep"}, {"far", 30}}));
  EXPECT_EQ(told(relevant(Unseen::coarse)), (json{{"unseen", "coarse"}}));
  EXPECT_EQ(told(hung_cloth()), json());
}

// --- The same commands at the same steps are the same state, however many watch ---

std::vector<std::uint64_t> watched_by(int viewers) {
  Watched scene(relevant(Unseen::sleep), viewers);
  for (std::size_t viewer = 0; viewer < scene.readers.size(); ++viewer) scene.command(kAtIt, viewer);
  std::vector<std::uint64_t> hashes;
  for (int step = 0; step < 180; ++step) {
    for (std::size_t viewer = 0; viewer < scene.readers.size(); ++viewer) {
      if (step == 20) scene.command(kAway, viewer);
      if (step == 120) scene.command(kAtIt, viewer);
    }
    scene.steps(1);
    hashes.push_back(state_hash(scene.live.simulation()));
  }
  return hashes;
}

TEST(RelevanceTest, ViewersDoNotChangeABit) {
  Simulation<float> simulation(relevant(Unseen::sleep).simulation);
  simulation.request_level(0, 5);
  std::vector<std::uint64_t> alone;
  for (int step = 0; step < 180; ++step) {
    if (step == 20 + kDwell) simulation.set_resting(0, true);
    if (step == 120) simulation.set_resting(0, false);
    simulation.step();
    alone.push_back(state_hash(simulation));
  }
  for (const int viewers : {1, 100}) EXPECT_EQ(watched_by(viewers), alone) << viewers << " viewers";
}

}  // namespace
}  // namespace weft::host::test
