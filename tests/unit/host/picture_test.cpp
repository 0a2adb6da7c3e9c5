// Frames are as exact as a viewer's picture shows, and no more.
#include "host/picture.h"

#include <cmath>
#include <numbers>
#include <set>

#include "fixtures.h"
#include "host/frame_encoder.h"
#include "protocol/grid_codec.h"

namespace weft::host::test {
namespace {

constexpr double kHalfAngle = 0.7;  // 1920 x 1080 pixels, 45 degrees high: atan(tan(45 / 2) * 2203 / 1080)

/// At the cloth's middle, from so far in front of it.
ViewCone eye_at(double distance, double half_angle = kHalfAngle) {
  return {{0.3, 0.2, distance}, Vec3(-0.3, -0.2, -distance).normalized(), half_angle};
}

/// hung_cloth() at level 6 after half a second in a strong wind.
Simulation<float> blown() {
  scene::Scene scene = hung_cloth();
  scene.simulation.wind.speed = 5;
  Simulation<float> simulation(scene.simulation);
  simulation.request_level(0, 6);
  for (int step = 0; step < 30; ++step) simulation.step();
  return simulation;
}

/// Largest angle, rad, between where a node is and where it is shown, as seen from `eye`.
double largest_angle(const protocol::ClothRecord& shown, const Particles<float>& simulated, const Vec3& eye) {
  const int stride = (simulated.grid().rows - 1) / (shown.rows - 1);
  double most = 0;
  for (int r = 0; r < shown.rows; ++r) {
    for (int c = 0; c < shown.cols; ++c) {
      const float* p = &shown.positions[static_cast<std::size_t>(3 * (r * shown.cols + c))];
      const Vec3 seen = Vec3(double(p[0]), double(p[1]), double(p[2])) - eye;
      const Vec3 real = simulated.position_at(r * stride, c * stride) - eye;
      most = std::max(most, std::atan2(seen.cross(real).norm(), seen.dot(real)));
    }
  }
  return most;
}

}  // namespace

// A pixel of 1080 in the middle of a picture 45 degrees high is 2 tan(22.5 degrees) / 1080 = 0.000767 rad.
TEST(Picture, APixelIsThatOfAFlatPicture) {
  const double corner = std::atan(std::tan(std::numbers::pi / 8) * kPicturePixels / 1080);
  EXPECT_NEAR(corner, kHalfAngle, 0.002);
  EXPECT_NEAR(pixel_angle(corner), 2 * std::tan(std::numbers::pi / 8) / 1080, 1e-12);
}

TEST(Picture, NoNodeMovesByMoreThanItsShareOfAPixel) {
  const Simulation<float> simulation = blown();
  FrameEncoder encoder;
  encoder.capture(simulation, {30, 1, 0.5, 0, 0});
  const double rounding = 1e-7;  // rad: of floats, which positions are decoded to
  int coarser = 0;
  for (const double half_angle : {0.05, 0.3, kHalfAngle, 3.0}) {
    for (const double distance : {0.3, 0.8, 2.6, 5.0, 12.0, 100.0}) {
      for (const int level : {4, 5, 6}) {
        const ViewCone view = eye_at(distance, half_angle);
        const protocol::ClothRecord shown = decoded(*encoder.message({level}, view)).cloths.at(0);
        // A cell of level L is 2 m / 2^L.
        EXPECT_LE(double(shown.quantisation.quantum), 2 * std::ldexp(1.0, -level) / kCellQuanta);
        const float finest = decoded(*encoder.message({level})).cloths.at(0).quantisation.quantum;
        if (shown.quantisation.quantum == finest) continue;  // there is none better
        ++coarser;
        EXPECT_LE(largest_angle(shown, simulation.cloths()[0].particles(), view.eye),
                  kPixelShare * pixel_angle(half_angle) + rounding)
            << "level " << level << " from " << distance << " m, " << half_angle << " rad";
      }
    }
  }
  EXPECT_GE(coarser, 40);  // of 72
}

TEST(Picture, ADistantViewerIsSentLess) {
  FrameEncoder encoder;
  encoder.capture(blown(), {30, 1, 0.5, 0, 0});
  const auto sent = [&](const std::optional<ViewCone>& view) {
    const auto message = encoder.message({6}, view);
    return std::pair(double(decoded(*message).cloths.at(0).quantisation.quantum),
                     double(bytes_of(*message).size()));
  };
  const auto [exact, most] = sent(std::nullopt);
  const auto [quantum, bytes] = sent(eye_at(2.6));
  EXPECT_EQ(exact, 1.0 / 16384);   // the least power of two of which 65535 cover 2 m and more
  EXPECT_EQ(quantum, 1.0 / 2048);  // a quarter of a pixel is 0.45 mm there, and 2 / sqrt(3) of it 0.52 mm
  EXPECT_LT(bytes, most);
}

TEST(Picture, IsEncodedOnceALatticeHoweverManyLook) {
  FrameEncoder encoder;
  encoder.capture(blown(), {30, 1, 0.5, 0, 0});
  std::set<float> quanta;
  for (int i = 0; i < 1000; ++i) {
    const auto message = encoder.message({6}, eye_at(0.2 + 0.05 * i));
    quanta.insert(decoded(*message).cloths.at(0).quantisation.quantum);
  }
  EXPECT_GE(quanta.size(), 3U);
  EXPECT_EQ(encoder.encodes(), quanta.size());
  EXPECT_LE(quanta.size(), std::size_t{kLattices} + 1);
}

// Its nodes are in no picture then; it is sent as without one.
TEST(Picture, AnEyeWithinTheClothsBoxSeesAllThatThereIs) {
  const ViewCone inside{{0, 0, 0}, {0, 0, -1}, kHalfAngle};
  const Eigen::AlignedBox3d box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  EXPECT_EQ(exponent_for_picture(inside, box, 0.03), protocol::kMinQuantumExponent);
}

}  // namespace weft::host::test
