// --set POINTER=VALUE: what it changes, and what it refuses.
#include "fixtures.h"

namespace weft::scene::test {
namespace {

Result flag_with(const std::vector<std::string>& overrides) { return load("flag", overrides); }

TEST(Overrides, NumbersStringsAndArrays) {
  const Scene scene =
      good(flag_with({"/wind/speed=3.5", "/title=Calm", "/cloths/0/size=[4, 1]", "/cloths/0/size/1=0.5",
                      "/cloths/0/material=denim", "/cloths/0/name=\"x\""}));
  EXPECT_EQ(scene.simulation.wind.speed, 3.5);
  EXPECT_EQ(scene.title, "Calm");
  EXPECT_EQ(scene.simulation.cloths[0].size, Vec2(4, 0.5));
  EXPECT_EQ(scene.simulation.cloths[0].material, find_fabric("denim")->material);
  EXPECT_EQ(scene.simulation.cloths[0].name, "x");
}

TEST(Overrides, MakeObjectsOnTheWay) {
  const Scene scene =
      good(flag_with({"/integrator=null", "/integrator/type=symplectic_euler", "/integrator/substeps=12"}));
  EXPECT_EQ(std::get<SymplecticEulerDescription>(scene.simulation.integrator).substeps, 12);
}

TEST(Overrides, AppendAndTakeAway) {
  const std::size_t pins = good(flag_with({})).simulation.cloths[0].pins.size();
  EXPECT_EQ(good(flag_with({"/cloths/0/pins/-=top_right"})).simulation.cloths[0].pins.size(), pins + 1);
  EXPECT_EQ(good(flag_with({"/cloths/0/pins/0=null"})).simulation.cloths[0].pins.size(), pins - 1);
  EXPECT_EQ(good(flag_with({"/cloths/0/pins=null"})).simulation.cloths[0].pins.size(), 0u);
  const Scene two = good(flag_with({"/cloths/1={\"name\":\"second\"}"}));
  EXPECT_EQ(two.simulation.cloths.size(), 2u);
}

TEST(Overrides, EscapedPointers) {
  EXPECT_EQ(problems_of(flag_with({"/a~1b~0c=1"})).substr(0, 22), "/a~1b~0c: unknown key;");
}

TEST(Overrides, ProblemsAreListedBesideTheScenes) {
  EXPECT_EQ(problems_of(flag_with({"speed=3", "/wind", "/cloths/7/size=[1,1]", "/cloths/x=1", "/title/a=1",
                                   "/bad~2=1", "/wind/speed=-1", "/time_step=1e999"})),
            "cannot set speed=3: must be /json/pointer=value\n"
            "cannot set /wind: must be /json/pointer=value\n"
            "/cloths/7: cannot be set; the array has 1 elements\n"
            "/cloths/x: cannot be set; the array has 1 elements\n"
            "/title/a: cannot be set; what it is to be put into is neither an object nor an array\n"
            "cannot set /bad~2=1: must be /json/pointer=value\n"
            "/wind/speed: is -1; must be a number from 0 to 100 m/s\n"
            "/time_step: is \"1e999\"; must be a number from 1e-06 to 0.1 s\n");
}

}  // namespace
}  // namespace weft::scene::test
