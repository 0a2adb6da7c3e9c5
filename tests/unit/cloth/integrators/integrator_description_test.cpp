#include "cloth/integrators/integrator_description.h"

#include <gtest/gtest.h>

#include "cloth/world/description.h"

namespace weft {
namespace {

TEST(IntegratorDescription, TheImplicitMethodsAreTold) {
  EXPECT_TRUE(is_implicit(BackwardEulerDescription{}));
  EXPECT_TRUE(is_implicit(Bdf2Description{}));
  EXPECT_FALSE(is_implicit(SymplecticEulerDescription{}));
  EXPECT_FALSE(is_implicit(XpbdDescription{}));
}

// As scene.schema.json and scenes.md tell whoever leaves them out.
TEST(IntegratorDescription, DefaultsAreTheDocumentedOnes) {
  for (const ImplicitParameters& implicit :
       {ImplicitParameters(BackwardEulerDescription{}), ImplicitParameters(Bdf2Description{})}) {
    EXPECT_EQ(implicit.substeps, 1);
    EXPECT_EQ(implicit.tolerance, 0.1);
    EXPECT_EQ(implicit.newton_iterations, 2);
    EXPECT_EQ(implicit.linear_iterations, 200);
    EXPECT_EQ(implicit.liveliness, 1);
  }
  EXPECT_EQ(XpbdDescription{}.substeps, 0);
  EXPECT_DOUBLE_EQ(40 * XpbdDescription{}.longest_substep, 1.0 / 60);
  EXPECT_EQ(SymplecticEulerDescription{}.substeps, 0);
  EXPECT_TRUE(std::holds_alternative<Bdf2Description>(SimulationDescription{}.integrator));
}

// A method that has other parameters, or is another one with the same, is not the same: set_integrator
// depends on it.
TEST(IntegratorDescription, DescriptionsAreEqualByMethodAndParameters) {
  Bdf2Description finer;
  finer.tolerance = 0.05;
  EXPECT_EQ(IntegratorDescription(Bdf2Description{}), IntegratorDescription(Bdf2Description{}));
  EXPECT_NE(IntegratorDescription(finer), IntegratorDescription(Bdf2Description{}));
  EXPECT_NE(IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{}));
}

}  // namespace
}  // namespace weft
