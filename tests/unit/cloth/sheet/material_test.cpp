// The named fabrics.
#include "cloth/sheet/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace weft {
namespace {

TEST(Fabrics, AreAtLeastFourWithDistinctNamesAndSources) {
  std::set<std::string_view> names;
  for (const Fabric& fabric : fabrics()) {
    names.insert(fabric.name);
    EXPECT_FALSE(fabric.source.empty()) << fabric.name;
  }
  EXPECT_GE(names.size(), 4u);
  EXPECT_EQ(names.size(), fabrics().size());
}

TEST(Fabrics, HaveValuesOfRealCloth) {
  // Ranges around physics.md A: silk to denim 0.06 to 0.4 kg/m2, membrane stiffness 1e3 to 1e4 N/m, shear 10
  // to 500 N/m.
  for (const Fabric& fabric : fabrics()) {
    const Material& m = fabric.material;
    EXPECT_GE(m.density, 0.02) << fabric.name;
    EXPECT_LE(m.density, 1.0) << fabric.name;
    EXPECT_GE(m.structural.least(), 50) << fabric.name;
    EXPECT_LE(m.structural.most(), 1e5) << fabric.name;
    EXPECT_GT(m.shear, 0) << fabric.name;
    EXPECT_LT(m.shear, m.structural.least())
        << fabric.name << ": woven cloth shears more easily than it stretches";
    EXPECT_GT(m.bending, 0) << fabric.name;
    EXPECT_LT(m.bending, m.structural.least()) << fabric.name << ": and bends more easily still";
    EXPECT_GE(m.damping, 0) << fabric.name;
    EXPECT_TRUE(std::isfinite(m.damping)) << fabric.name;
  }
}

TEST(Fabrics, HaveTheRigidityOfRealCloth) {
  // physics.md A: silk 5e-6 to denim 1e-4 N m; a hand's width of overhang is (B / (rho g))^(1/3) = 2 to 4 cm.
  for (const Fabric& fabric : fabrics()) {
    const auto& [u, v, twist] = fabric.material.rigidity;
    for (const double rigidity : {u, v, twist}) {
      EXPECT_GE(rigidity, 1e-6) << fabric.name;
      EXPECT_LE(rigidity, 2e-4) << fabric.name;
    }
    const double bending_length = std::cbrt((u + v) / 2 / (fabric.material.density * 9.81));
    EXPECT_GT(bending_length, 0.01) << fabric.name;
    EXPECT_LT(bending_length, 0.05) << fabric.name;
  }
}

TEST(Fabrics, DenimsBiasIsAsMeasured) {
  // 64, 73 and 97 uN m along u, the bias and v.
  const Rigidity denim = find_fabric("denim")->material.rigidity;
  EXPECT_DOUBLE_EQ((denim.u + denim.v + 2 * denim.twist) / 4, 7.3e-5);
}

TEST(Fabrics, AreFoundByName) {
  for (const Fabric& fabric : fabrics()) {
    const Fabric* found = find_fabric(fabric.name);
    ASSERT_NE(found, nullptr) << fabric.name;
    EXPECT_EQ(found->material, fabric.material);
  }
  EXPECT_EQ(find_fabric("no such fabric"), nullptr);
  EXPECT_EQ(find_fabric(""), nullptr);
}

}  // namespace
}  // namespace weft
