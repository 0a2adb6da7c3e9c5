// Published numbers, and how far a value is from them.
#include "fabric/published.h"

#include <gtest/gtest.h>

#include "cloth/sheet/material.h"
#include "fabric/report.h"

namespace weft::fabric {
namespace {

TEST(Published, AreOfNamedFabricsWithSources) {
  for (const Published& each : published()) {
    EXPECT_NE(find_fabric(each.fabric), nullptr) << each.fabric;
    EXPECT_FALSE(each.source.empty()) << each.fabric;
    EXPECT_GT(each.low, 0) << each.fabric;
    EXPECT_LE(each.low, each.high) << each.fabric;
  }
}

TEST(Published, EveryFabricHasItsTensionAndItsBendingLength) {
  for (const Fabric& fabric : fabrics()) {
    for (const Quantity quantity : {Quantity::bending_length_warp, Quantity::bending_length_weft,
                                    Quantity::stretch_warp, Quantity::stretch_weft})
      EXPECT_FALSE(published_of(fabric.name, quantity).empty()) << fabric.name << " " << name_of(quantity);
  }
}

// Those whose numbers differ along warp and weft are as their source has them.
TEST(Published, TheTwoUnevenFabricsStretchAsTheirSourceSays) {
  for (const char* name : {"polyester", "stretch_wool"}) {
    const Stiffness& structural = find_fabric(name)->material.structural;
    EXPECT_NEAR(structural.warp, published_of(name, Quantity::stretch_warp)[0].low, 0.5) << name;
    EXPECT_NEAR(structural.weft, published_of(name, Quantity::stretch_weft)[0].low, 0.5) << name;
  }
}

TEST(Published, DeviationIsFromTheNearestEnd) {
  const Published range{"cotton", Quantity::drape, 0.5, 0.8, false, "a source"};
  EXPECT_EQ(deviation(0.6, range), 0);
  EXPECT_DOUBLE_EQ(deviation(0.4, range), -0.2);
  EXPECT_DOUBLE_EQ(deviation(1.0, range), 0.25);
}

}  // namespace
}  // namespace weft::fabric
