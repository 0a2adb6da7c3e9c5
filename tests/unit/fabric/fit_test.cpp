// Materials from numbers: those of a simulated test give the material back that was tested.
#include "fabric/fit.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fabric/cantilever.h"
#include "fabric/drape.h"
#include "fabric/shear.h"
#include "fabric/specimen.h"
#include "fabric/tensile.h"

namespace weft::fabric {
namespace {

using nlohmann::json;

Numbers read(const json& value) {
  auto result = read_numbers(value);
  EXPECT_TRUE(std::holds_alternative<Numbers>(result)) << value;
  return std::get<Numbers>(result);
}

std::vector<std::string> problems_of(const json& value) {
  std::vector<std::string> texts;
  const auto result = read_numbers(value);
  if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
    for (const scene::Problem& each : *problems) texts.push_back(each.text());
  }
  return texts;
}

Material known() {
  Material material;
  material.density = 0.2;
  material.structural = {9000, 4000};
  material.shear = 50;
  material.bending = 0;
  material.rigidity = {2e-5, 8e-6, 1.3e-5};
  return material;
}

// The shear test reads 4 % less at most (its free sides), the others are within 1 %.
TEST(Fits, GiveBackWhatWasTestedSlow) {
  const Material tested = known();
  const Numbers numbers = read({{"density", 0.2},
                                {"emt_warp", tensile(tested, false).extension},
                                {"emt_weft", tensile(turned(tested), false).extension},
                                {"bending_length_warp", cantilever(tested).bending_length()},
                                {"bending_length_weft", cantilever(turned(tested)).bending_length()},
                                {"shear_stiffness", shear(tested, false).stiffness}});
  const Material found = fit(numbers, 16).material;
  EXPECT_EQ(found.density, 0.2);
  EXPECT_NEAR(found.structural.warp / 9000, 1, 0.01);
  EXPECT_NEAR(found.structural.weft / 4000, 1, 0.01);
  EXPECT_NEAR(found.shear / 50, 1, 0.04);
  EXPECT_NEAR(found.rigidity.u / 2e-5, 1, 0.01);
  EXPECT_NEAR(found.rigidity.v / 8e-6, 1, 0.01);
}

// 20 % in rigidity are less than a fiftieth in the coefficient of this cloth.
TEST(FitsNightly, FindTheRigidityThatDrapesSo) {
  Material tested;
  tested.density = 0.2;
  tested.rigidity = {2e-5, 2e-5, 2e-5};
  const double coefficient = drape(tested, 32).coefficient;
  const Fit found = fit(read({{"density", 0.2}, {"drape", coefficient}}), 32);
  EXPECT_NEAR(*found.drape, coefficient, 0.005);
  EXPECT_NEAR(found.material.rigidity.u / 2e-5, 1, 0.2);
  EXPECT_EQ(found.material.rigidity.u, found.material.rigidity.twist);
}

// Cusick 1965: drape follows from bending and shear; of a known bending the shear is what is left.
TEST(FitsNightly, FindTheShearThatDrapesSo) {
  Numbers numbers = read({{"density", 0.2}, {"emt_warp", 0.05}, {"bending_length_warp", 0.02}});
  numbers.shear_stiffness = 60;
  const double coefficient = drape(fit(numbers, 16).material, 32).coefficient;
  numbers.shear_stiffness.reset();
  numbers.drape = coefficient;
  const Fit found = fit(numbers, 32);
  EXPECT_NEAR(*found.drape, coefficient, 0.005);
  EXPECT_NEAR(found.material.shear / 60, 1, 0.25);
}

TEST(Fits, CompareADrapeWhereNothingIsLeftToFind) {
  Numbers numbers =
      read({{"density", 0.2}, {"bending_length_warp", 0.02}, {"shear_stiffness", 50}, {"drape", 0.99}});
  const Fit found = fit(numbers, 16);
  EXPECT_EQ(*found.drape, drape(found.material, 16).coefficient);
  EXPECT_EQ(found.material.shear, 50);
}

TEST(Fits, RefuseADrapeThatNoRigidityGives) {
  const Numbers numbers = read({{"density", 0.2}, {"drape", 0.01}});
  EXPECT_THROW(fit(numbers, 16), NoFit);
}

TEST(Fits, WithoutTheWeftsNumbersTakeTheWarps) {
  const Material found =
      fit(read({{"density", 0.1}, {"emt_warp", 0.05}, {"bending_length_weft", 0.02}}), 16).material;
  EXPECT_EQ(found.structural.warp, found.structural.weft);
  EXPECT_EQ(found.rigidity.u, found.rigidity.v);
  EXPECT_DOUBLE_EQ(found.rigidity.u, 0.1 * 9.80665 * 8e-6);
}

TEST(Fits, SayWhatIsMeasuredAndNothingElse) {
  const Numbers numbers = read({{"density", 0.1}, {"shear_stiffness", 40}});
  EXPECT_EQ(block_of(numbers, fit(numbers, 16).material), (json{{"density", 0.1}, {"shear", 40.0}}));
}

TEST(Fits, RefuseWhatIsOutOfRange) {
  EXPECT_EQ(problems_of({{"density", 0.1}, {"emt_warp", 5}, {"drape", 55}, {"weight", 3}}),
            (std::vector<std::string>{
                "/emt_warp: is 5; must be a number from 0.0001 to 2",
                "/drape: is 55; must be a number from 0.01 to 0.99",
                "/weight: unknown key; known here: density, emt_warp, emt_weft, bending_length_warp, "
                "bending_length_weft, shear_stiffness, drape"}));
  EXPECT_EQ(problems_of(json::object()).size(), 1u);  // the density
}

TEST(Fits, RefuseAnExtensionThatTheShearAloneForbids) {
  try {
    fit(read({{"density", 0.1}, {"emt_warp", 1}, {"shear_stiffness", 1000}}), 16);
    FAIL();
  } catch (const NoFit& none) {
    EXPECT_STREQ(none.what(),
                 "emt_warp is 1; with a shear_stiffness of 1000 N/m it must be less than 0.490333");
  }
}

}  // namespace
}  // namespace weft::fabric
