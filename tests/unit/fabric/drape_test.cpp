// Cusick's drapemeter and the shadow that it measures.
#include "fabric/drape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fabric/shadow.h"

namespace weft::fabric {
namespace {

TEST(Shadow, HasTheAreaOfATriangle) {
  Shadow shadow(0.3, 5e-4);
  shadow.add({0, 0, 0}, {0.3, 0.1, 0}, {0, -2, 0.3});
  EXPECT_NEAR(shadow.area(), 0.045, 0.3 * 5e-4);  // a row of pixels along the slope
}

TEST(Shadow, CountsWhatLiesOverItselfOnce) {
  Shadow shadow(0.3, 5e-4);
  shadow.add({0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1});
  const double once = shadow.area();
  shadow.add({0, 1, 0.1}, {0.1, 1, 0}, {0, 1, 0});  // the same from above, turned the other way
  EXPECT_EQ(shadow.area(), once);
}

TEST(Shadow, IsCutAtItsBorder) {
  Shadow shadow(0.3, 1e-2);
  shadow.add({-100, 0, -100}, {100, 0, -100}, {0, 0, 200});
  EXPECT_NEAR(shadow.area(), 0.36, 1e-9);
}

Material cloth(double rigidity) {
  Material material;
  material.density = 0.15;
  material.structural = 3000;
  material.shear = 40;
  material.bending = 3;
  material.rigidity = {rigidity, rigidity, rigidity};
  return material;
}

// 1.47 Pa on a ring of 6 cm and 1 N m: q b^4 / D is 2e-5 m.
TEST(CusicksDrape, ABoardDoesNotDrape) {
  const Drape board = drape(cloth(1), 16);
  EXPECT_NEAR(board.coefficient, 1, 0.01);
  EXPECT_EQ(board.folds, 0);
}

// Drape follows from bending stiffness (Cusick 1965).
TEST(CusicksDrape, StifferClothCastsALargerShadowSlow) {
  const double limp = drape(cloth(3e-6), 32).coefficient, middle = drape(cloth(3e-5), 32).coefficient,
               stiff = drape(cloth(3e-4), 32).coefficient;
  EXPECT_GT(limp, 0.2);
  EXPECT_LT(limp + 0.1, middle);
  EXPECT_LT(middle + 0.05, stiff);
  EXPECT_LT(stiff, 1);
}

TEST(CusicksDrape, IsTheSameEachTime) {
  const Drape first = drape(cloth(3e-5), 16), second = drape(cloth(3e-5), 16);
  EXPECT_EQ(first.coefficient, second.coefficient);
  EXPECT_EQ(first.folds, second.folds);
}

// 5 to 8 folds on 37 woven fabrics (Fibres and Textiles 1/2018, at second hand), and some more of limp cloth.
TEST(CusicksDrapeNightly, ClothFoldsRoundTheDisc) {
  const Drape folded = drape(cloth(1e-5), 64);
  EXPECT_GE(folded.folds, 4);
  EXPECT_LE(folded.folds, 10);
}

}  // namespace
}  // namespace weft::fabric
