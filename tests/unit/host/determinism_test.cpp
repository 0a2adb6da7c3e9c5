// A scene's bits depend on its description and on what was commanded at which step, not on who watches.
#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

constexpr int kSteps = 90;

// What is commanded, before these steps; at the last two the nearest viewer goes nearer and then far away,
// which changes the cloth's level.
constexpr int kAdd = 10, kThrow = 20, kWind = 45, kNearer = 30, kFarther = 60;
/// From 5 m, which level 5 is for, to level 6 and to level 4 (Table 1).
constexpr int kStartLevel = 5, kNearLevel = 6, kFarLevel = 4;
constexpr double kStart = 5, kNear = 0.8, kFar = 12;  // m

SceneCommand from(double distance) { return protocol::Camera{distance, std::nullopt}; }

/// The hash of every step while so many viewers watch, all but the first from far away.
std::vector<std::uint64_t> hashes_watched_by(int viewers) {
  LiveScene live(hung_cloth(), {});
  std::vector<Reader> readers(static_cast<std::size_t>(viewers));
  std::vector<std::uint64_t> visits;
  for (Reader& reader : readers) {
    visits.push_back(reader.viewer->enter());
    live.add_viewer(reader.viewer, visits.back());
    if (visits.size() > 1) live.apply(reader.viewer, visits.back(), {std::nullopt, from(kFar)});
  }
  const auto command = [&](const SceneCommand& what) {
    live.apply(readers[0].viewer, visits[0], {std::nullopt, what});
  };
  command(from(kStart));
  std::vector<std::uint64_t> hashes;
  for (int step = 0; step < kSteps; ++step) {
    if (step == kAdd) command(protocol::BallAdd{.position = {0, 0, 1}, .radius = 0.3});
    if (step == kThrow) command(protocol::BallThrow{.ball = 1, .velocity = {0, 1, -6}});
    if (step == kWind) command(protocol::WindSet{.direction = {0.6, 0, -0.8}, .speed = 4});
    if (step == kNearer) command(from(kNear));
    if (step == kFarther) command(from(kFar));
    live.step();
    live.publish(0);
    for (Reader& reader : readers) reader.drain();
    hashes.push_back(state_hash(live.simulation()));
  }
  return hashes;
}

/// The same without a server around it: levels are commands among the others.
std::vector<std::uint64_t> hashes_unwatched() {
  Simulation<float> simulation(hung_cloth().simulation);
  simulation.request_level(0, kStartLevel);
  std::vector<std::uint64_t> hashes;
  for (int step = 0; step < kSteps; ++step) {
    if (step == kAdd) {
      BallDescription ball;
      ball.position = {0, 0, 1};
      ball.radius = 0.3;
      simulation.add_ball(ball);
    }
    if (step == kThrow) simulation.throw_ball(1, {0, 1, -6});
    if (step == kWind) simulation.set_wind({{0.6, 0, -0.8}, 4});
    if (step == kNearer) simulation.request_level(0, kNearLevel);
    if (step == kFarther) simulation.request_level(0, kFarLevel);
    simulation.step();
    EXPECT_EQ(simulation.cloths()[0].level(), step < kNearer    ? kStartLevel
                                              : step < kFarther ? kNearLevel
                                                                : kFarLevel);
    hashes.push_back(state_hash(simulation));
  }
  return hashes;
}

TEST(Determinism, ViewersDoNotChangeABit) {
  const std::vector<std::uint64_t> alone = hashes_unwatched();
  for (const int viewers : {1, 100}) EXPECT_EQ(hashes_watched_by(viewers), alone) << viewers << " viewers";
  // The ball and the wind did something: every step is another state.
  std::vector<std::uint64_t> sorted = alone;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

TEST(Determinism, ACommandAStepLaterIsAnotherState) {
  Simulation<float> one(hung_cloth().simulation), other(hung_cloth().simulation);
  one.set_wind({{0.6, 0, -0.8}, 4});
  one.step();
  other.step();
  EXPECT_NE(state_hash(one), state_hash(other));
}

}  // namespace
}  // namespace weft::host::test
