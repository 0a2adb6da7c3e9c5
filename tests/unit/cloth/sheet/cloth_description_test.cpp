#include "cloth/sheet/cloth_description.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

// As scene.schema.json tells whoever leaves them out: levels from 4, 6 at first.
TEST(ClothDescription, DefaultsAreTheDocumentedOnes) {
  const ClothDescription cloth;
  EXPECT_EQ(cloth.min_level, 4);
  EXPECT_EQ(cloth.initial_level, 6);
  EXPECT_LE(cloth.initial_level, cloth.max_level);
  EXPECT_LE(cloth.max_level, kMaxLevel);
  EXPECT_EQ(cloth.position, Vec3(0, 0, 0));
  EXPECT_EQ(cloth.velocity, Vec3(0, 0, 0));
  EXPECT_EQ(cloth.perturbation, 0);
  EXPECT_EQ(cloth.discretization, Discretization::continuum);
  EXPECT_FALSE(cloth.sewn);
  EXPECT_EQ(cloth.material.density, 0.1);
  EXPECT_EQ(cloth.material.structural, Stiffness(5000));
  EXPECT_EQ(cloth.material.shear, 500);
  EXPECT_EQ(cloth.material.bending, 5);
  EXPECT_EQ(cloth.material.damping, 0.1);
  EXPECT_EQ(cloth.material.rigidity, (Rigidity{1e-5, 1e-5, 1e-5}));
}

// The paper's square cloth: 64 x 64 cells at level 6.
TEST(ClothDescription, ItsInitialLevelIsThePapersGrid) {
  const ClothDescription cloth;
  EXPECT_EQ(cloth.base_cells.at(cloth.initial_level).cells(), 64 * 64);
}

// Everybody sees it, from anywhere, and a pin holds from the beginning and for ever.
TEST(ClothDescription, NothingIsLeftOutUnlessAskedFor) {
  EXPECT_EQ(Relevance{}.unseen, Relevance::Unseen::step);
  EXPECT_TRUE(std::isinf(Relevance{}.far));
  EXPECT_EQ(PinRegion{}.from, 0);
  EXPECT_TRUE(std::isinf(PinRegion{}.until));
  EXPECT_FALSE(PinRegion{}.stiffness);
}

}  // namespace
}  // namespace weft
