// Cantilever, pure bending, tension and shear against the formulas for a sheet of known stiffness.
#include <gtest/gtest.h>

#include <cmath>

#include "fabric/cantilever.h"
#include "fabric/pure_bending.h"
#include "fabric/shear.h"
#include "fabric/specimen.h"
#include "fabric/tensile.h"

namespace weft::fabric {
namespace {

Material uneven() {
  Material material;
  material.density = 0.15;
  material.structural = {8000, 3000};
  material.shear = 60;
  material.bending = 0;
  material.rigidity = {3e-5, 1e-5, 2e-5};
  return material;
}

// A strip of overhang 2 c hangs by 41.5 degrees where c = (B / (rho g))^(1/3) (Peirce 1930). 32 cells add
// 1e-3.
TEST(Instruments, TheCantileversBendingLengthIsPeircesSlow) {
  const Material material = uneven();
  for (const bool warp : {true, false}) {
    const double rigidity = warp ? material.rigidity.u : material.rigidity.v;
    const double peirce = std::cbrt(rigidity / (material.density * 9.80665));
    const Cantilever strip = cantilever(warp ? material : turned(material));
    EXPECT_NEAR(strip.bending_length() / peirce, 1, 2e-3) << (warp ? "warp" : "weft");
    EXPECT_NEAR(rigidity_of(strip.bending_length(), material.density) / rigidity, 1, 6e-3);
  }
}

TEST(Instruments, AStripWithoutRigidityHasNoOverhang) {
  Material limp = uneven();
  limp.rigidity = {0, 0, 0};
  EXPECT_EQ(cantilever(limp).overhang, 0);
}

// The moment of an arc is B times its curvature; its chords are shorter than it by (k h)^2 / 24, 1e-4 at 1.5
// /cm and cells of 0.3 mm.
TEST(Instruments, PureBendingFindsTheRigidity) {
  const Material material = uneven();
  EXPECT_NEAR(pure_bending(material) / material.rigidity.u, 1, 3e-3);
  EXPECT_NEAR(pure_bending(turned(material)) / material.rigidity.v, 1, 3e-3);
}

// Threads alone stretch by F / Y, in each direction by its own.
TEST(Instruments, ThreadsStretchByTheLoadOverTheirStiffness) {
  Material threads = uneven();
  threads.shear = 0;
  for (const bool warp : {true, false}) {
    const Tensile pulled = tensile(warp ? threads : turned(threads), false);
    EXPECT_NEAR(pulled.extension, kLargestLoad / (warp ? 8000 : 3000), 1e-6) << (warp ? "warp" : "weft");
    EXPECT_NEAR(pulled.linearity, 1, 1e-6);
    EXPECT_NEAR(pulled.work, kLargestLoad * pulled.extension / 2, 1e-4);
  }
}

// Between jaws square cells' diagonals add G: a strain e makes one longer by e h^2 / d, and both hold G e^2 /
// 2 a square metre. Free sides, 1.5 cm of 20 cm that lie less than a jaws' distance from them, give a little.
TEST(Instruments, DiagonalsAddTheShearStiffnessBetweenTheJaws) {
  const Material material = uneven();
  EXPECT_NEAR(kLargestLoad / tensile(material, false).extension, 8060, 0.003 * 8060);
  EXPECT_NEAR(stiffness_of(kLargestLoad / 8060, 60), 8000, 1e-9);
}

// Up to the limit e1 threads take Y e, beyond it 20 times as much: 490 N/m at e1 + (490 - Y e1) / (20 Y).
TEST(Instruments, LimitedThreadsHaveTwoSlopes) {
  Material threads = uneven();
  threads.shear = 0;
  threads.limit = {0.03, 0.08, 0.3, 20};
  const double bend = 0.03, extension = bend + (kLargestLoad - 8000 * bend) / (20 * 8000);
  const Tensile pulled = tensile(threads, true);
  EXPECT_NEAR(pulled.extension, extension, 2e-4);  // the curve is read every 0.2 %
  const double work = 8000 * bend * bend / 2 + (8000 * bend + kLargestLoad) / 2 * (extension - bend);
  EXPECT_NEAR(pulled.work / work, 1, 0.02);
  EXPECT_NEAR(pulled.linearity, 2 * work / (kLargestLoad * extension), 0.02);
}

// A square of side h sheared by the angle t has diagonals h sqrt(2 (1 +- sin t)): of a stiffness per area of
// G they resist by G t where t is small. The free sides' cells have diagonals of half the stiffness along the
// rim: 5 cm of length beside 20 cm of width leave 3 % less.
TEST(Instruments, ShearFindsItsStiffness) {
  const Material material = uneven();
  const Shear sheared = shear(material, false);
  EXPECT_NEAR(sheared.stiffness / 60, 1, 0.04);
  EXPECT_LT(sheared.stiffness, 60);
  Material twice = material;
  twice.shear = 120;
  EXPECT_NEAR(shear(twice, false).stiffness / sheared.stiffness, 2, 0.03);
  EXPECT_NEAR(kGramForcePerDegree, 56.19, 0.005);
}

TEST(Instruments, SayThatTheyFindNoRest) {
  Material soft = uneven();
  soft.structural = 50;
  EXPECT_THROW(tensile(soft, false), NoRest);
  Material nothing = uneven();
  nothing.structural = nothing.shear = 0;
  EXPECT_THROW(shear(nothing, false), NoRest);
}

}  // namespace
}  // namespace weft::fabric
