// Frames of cloths far from the origin.
#include "fixtures.h"
#include "host/frame_encoder.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

/// Farthest, m, that a node of the message's only record, decoded in double, is from where it is simulated.
double farthest(const FrameMessage& message, const Particles<float>& simulated) {
  const protocol::ClothRecord record = decoded(message).cloths.at(0);
  protocol::Quantisation from_origin = record.quantisation;
  from_origin.origin = {};
  std::vector<float> offsets;
  std::string error;
  EXPECT_TRUE(protocol::decode_grid(std::span(*message.records.at(0)).subspan(protocol::kHeaderBytes),
                                    record.rows, record.cols, from_origin, offsets, error))
      << error;
  double most = 0;
  for (int r = 0; r < record.rows; ++r) {
    for (int c = 0; c < record.cols; ++c) {
      const float* offset = &offsets[static_cast<std::size_t>(3 * (r * record.cols + c))];
      const auto& origin = record.quantisation.origin;
      const Vec3 at{double(origin[0]) + double(offset[0]), double(origin[1]) + double(offset[1]),
                    double(origin[2]) + double(offset[2])};
      most = std::max(most, (at - simulated.position_at(r, c)).cwiseAbs().maxCoeff());
    }
  }
  return most;
}

}  // namespace

TEST(Place, FramesAreExactToHalfAQuantumAnywhere) {
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(9998.3, -7000.2, 3.1)}) {
    scene::Scene scene = hung_cloth();
    scene.simulation.cloths[0].position = at;
    Simulation<float> simulation(scene.simulation);
    for (int step = 0; step < 5; ++step) simulation.step();
    FrameEncoder encoder;
    encoder.capture(simulation, {5, 1, 0.1, 0, 0});
    const auto message = encoder.message({6});
    const double quantum = double(decoded(*message).cloths.at(0).quantisation.quantum);
    EXPECT_LT(quantum, 1e-4);
    EXPECT_LE(farthest(*message, simulation.cloths()[0].particles()), quantum / 2);
  }
}

TEST(Place, BallsFallAnywhere) {
  scene::Scene scene = hung_cloth();
  const Vec3 at(9998.3, -7000.2, 3.1);
  scene.simulation.cloths[0].position = at;
  BallDescription ball;
  ball.position = at + Vec3(0, 0, 2);
  ball.motion = BallDescription::Motion::dynamic;
  scene.simulation.balls = {ball};
  LiveScene live(scene, protocol::Limits{});
  for (int step = 0; step < 3; ++step) live.step();
  ASSERT_EQ(live.simulation().colliders().balls().size(), 1U);
  EXPECT_LT(live.simulation().colliders().balls()[0].velocity.y(), 0);
}

}  // namespace weft::host::test
