#include "cloth/core/small_system.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(LeastSolution, OfAFullSystemIsItsSolution) {
  SmallMatrix a(3, 3);
  a << 4, 1, 0, 1, 3, -1, 0, -1, 2;
  SmallVector x(3);
  x << 1, -2, 3;
  EXPECT_LT((least_solution(a, a * x) - x).norm(), 1e-14);
}

TEST(LeastSolution, OfNodesInOneLineHasNoTurnAboutIt) {
  // Inertia of nodes along y; the part of the momentum along it can come from no spin.
  SmallMatrix inertia = SmallMatrix::Zero(3, 3);
  inertia(0, 0) = inertia(2, 2) = 0.5;
  SmallVector momentum(3);
  momentum << 1, 7, 2;
  const SmallVector spin = least_solution(inertia, momentum);
  EXPECT_NEAR(spin[0], 2, 1e-14);
  EXPECT_NEAR(spin[1], 0, 1e-14);
  EXPECT_NEAR(spin[2], 4, 1e-14);
}

TEST(LeastSolution, MayHaveNoUnknowns) {
  EXPECT_EQ(least_solution(SmallMatrix(0, 0), SmallVector(0)).size(), 0);
}

TEST(SpectrumOf, HasTheValuesAscendingAndTheirAxes) {
  SmallMatrix a(3, 3);  // eigenvalues 1, 3 and 5: of the axes (1, -1, 0), (1, 1, 0) and z
  a << 2, 1, 0, 1, 2, 0, 0, 0, 5;
  const SmallSpectrum spectrum = spectrum_of(a);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(spectrum.values[i], 1 + 2 * i, 1e-14);
    EXPECT_LT((a * spectrum.vectors.col(i) - spectrum.values[i] * spectrum.vectors.col(i)).norm(), 1e-14);
    EXPECT_NEAR(spectrum.vectors.col(i).norm(), 1, 1e-14);
  }
}

}  // namespace
}  // namespace weft
