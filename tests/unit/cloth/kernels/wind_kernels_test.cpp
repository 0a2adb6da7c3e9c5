#include "cloth/kernels/wind_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cloth/kernels/cosine.h"

namespace weft::kernels {
namespace {

constexpr std::size_t kPoints = 19;

struct Points {
  std::array<std::vector<float>, 3> values;
  Points() { values.fill(std::vector<float>(kPoints, 0)); }
  Components<float> view() { return {values[0].data(), values[1].data(), values[2].data()}; }
};

// The header's bound, 7e-9, in double precision; half turns and whole ones apart.
TEST(WindKernels, CosineIsWithinItsBound) {
  for (int i = -4000; i <= 4000; ++i) {
    const double turns = i / 1000.0 * 1.25;
    EXPECT_NEAR(cosine_of_turns(turns), std::cos(2 * std::numbers::pi * turns), 7e-9) << turns;
  }
}

// a cos(2 pi (k.x + phase)), of two waves.
TEST(WindKernels, WavesAddUp) {
  Points points, velocity;
  for (std::size_t i = 0; i < kPoints; ++i) points.values[0][i] = 0.1F * static_cast<float>(i);
  const AirWave waves[] = {{0.5F, 0, 0, 0.25F, 0, 2, 0}, {0, 0, 0, 0, 0, 0, 3}};
  add_waves(waves, 2, points.view(), kPoints, velocity.view());
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double turns = 0.05 * static_cast<double>(i) + 0.25;
    EXPECT_NEAR(velocity.values[1][i], 2 * std::cos(2 * std::numbers::pi * turns), 2e-6);
    EXPECT_NEAR(velocity.values[2][i], 3, 1e-6);
  }
}

// w = 1 - 3 s^2 + 2 s^3: 1 in the box, 27/32 a quarter of the edge out, 1/2 half way, 0 beyond.
TEST(WindKernels, AZoneFadesOverItsEdge) {
  Points points, velocity;
  velocity.values[0].assign(kPoints, 8);
  const float out[] = {0, 0.9F, 1.05F, 1.1F, 1.2F, 5};
  const float weight[] = {1, 1, 27.0F / 32, 0.5F, 0, 0};
  for (std::size_t i = 0; i < std::size(out); ++i) points.values[1][i] = out[i];
  const AirZone box{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, {1, 1, 1}, 0, 1 / 0.2F, {-2, 0, 4}};
  blend_zone(box, points.view(), kPoints, velocity.view());
  for (std::size_t i = 0; i < std::size(out); ++i) {
    EXPECT_NEAR(velocity.values[0][i], 8 - 10 * weight[i], 2e-5) << out[i];
    EXPECT_NEAR(velocity.values[2][i], 4 * weight[i], 1e-5) << out[i];
  }
}

// A ball is a box of no size with a radius: across a corner's direction it fades by the distance.
TEST(WindKernels, ABallFadesAllRound) {
  Points points, velocity;
  const float side = 1.1F / std::sqrt(3.0F);
  for (auto& values : points.values) values[0] = side;
  const AirZone ball{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, {0, 0, 0}, 1, 1 / 0.2F, {1, 0, 0}};
  blend_zone(ball, points.view(), kPoints, velocity.view());
  EXPECT_NEAR(velocity.values[0][0], 0.5, 1e-5);
  EXPECT_NEAR(velocity.values[0][1], 1, 1e-6);
}

// Bilinear between coarse nodes 2 rows and 4 columns apart: a bilinear function comes back.
TEST(WindKernels, CoarseValuesAreInterpolated) {
  const Grid fine = Grid::with_nodes(5, 9);
  const auto value = [](int r, int c) {
    return 1 + 0.5F * float(r) - 0.25F * float(c) + 0.125F * float(r * c);
  };
  std::vector<float> coarse;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) coarse.push_back(value(2 * r, 4 * c));
  VectorField<float> velocity(fine);
  add_between(3, 3, {coarse.data(), coarse.data(), coarse.data()}, 2, 4, fine, components(velocity));
  for (int r = 0; r < fine.rows; ++r) {
    for (int c = 0; c < fine.cols; ++c) {
      EXPECT_NEAR(velocity.x.at(r, c), value(r, c), 1e-5) << r << ' ' << c;
      EXPECT_EQ(velocity.x.at(r, c), velocity.z.at(r, c));
    }
  }
}

}  // namespace
}  // namespace weft::kernels
