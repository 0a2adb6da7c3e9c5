// T6: the order in which the error falls with the step: 1 for symplectic Euler, backward Euler and XPBD, 2
// for BDF2.
#include "methods.h"

namespace weft::test {
namespace {

using Order = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Order, ::testing::ValuesIn(kMethods), name_of_case);
using StripOrder = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, StripOrder,
                         ::testing::Values(Method::symplectic_euler, Method::backward_euler, Method::bdf2),
                         name_of_case);

int order_of(Method method) { return method == Method::bdf2 ? 2 : 1; }

/// The middle column of 2 x 3 nodes, 1 kg each, swings between held ones on two springs of k: w^2 = 2k.
Rig<double> oscillator(double k, const IntegratorDescription& method) {
  Particles<double> sheet = flat_sheet<double>(2, 3, {2, 1});
  for (int r : {0, 1}) {
    for (int c : {0, 2}) sheet.inverse_mass.at(r, c) = 0;
    set(sheet.position, r, 1, get(sheet.position, r, 1) + Vec3(0.01, 0, 0));
  }
  return {std::move(sheet), {2, 1}, strands(k), Discretization::paper, {}, method};
}

/// Slope of log2 error from one halving of the step to the next.
TEST_P(Order, OfOneSpring) {
  constexpr double k = 2, kTime = 0.5;  // w = 2 rad/s: a sixth of a period
  const auto error = [&](int steps) {
    Rig<double> rig = oscillator(k, stepping(GetParam(), 1));
    for (int step = 0; step < steps; ++step) rig.advance(step * kTime / steps, kTime / steps);
    return std::abs(get(rig.particles.position, 0, 1).x() - 0.01 * std::cos(2 * kTime));
  };
  for (const int steps : {160, 320, 640}) {
    EXPECT_NEAR(std::log2(error(steps) / error(2 * steps)), order_of(GetParam()), 0.1) << steps;
  }
}

/// Where the lower end of a strip is after 0.5 s: 1 m of 9 nodes, released at 0.3 rad from hanging, Y soft
/// enough that its own waves are resolved too.
Vec3 swinging_end(Method method, int steps) {
  constexpr int kRows = 9;
  constexpr double kTime = 0.5;
  Particles<double> sheet = flat_sheet<double>(kRows, 3, {0.25, 1});
  share_mass(sheet, 0.1 * 0.25, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    const double s = double(r) / (kRows - 1), x = get(sheet.position, r, c).x();
    set(sheet.position, r, c, {x, -s * std::cos(0.3), s * std::sin(0.3)});
    if (r == 0) sheet.inverse_mass.at(r, c) = 0;
  });
  Rig<double> rig(std::move(sheet), {0.25, 1}, strands(20), Discretization::continuum, {GravityEffect{}},
                  stepping(method, 1, 4));
  for (int step = 0; step < steps; ++step) rig.advance(step * kTime / steps, kTime / steps);
  return get(rig.particles.position, kRows - 1, 1);
}

// The reference is BDF2's own answer, extrapolated from two steps finer than any here (Richardson). XPBD is
// left out: until its substeps are far more, what one projection of each spring leaves undone, of second
// order, hides its order.
TEST_P(StripOrder, OfASwingingStrip) {
  const int coarsest = 1024;
  static const Vec3 reference =
      (4 * swinging_end(Method::bdf2, 16384) - swinging_end(Method::bdf2, 8192)) / 3;
  const auto error = [&](int steps) { return (swinging_end(GetParam(), steps) - reference).norm(); };
  const double slope = std::log2(error(coarsest) / error(4 * coarsest)) / 2;
  EXPECT_NEAR(slope, order_of(GetParam()), 0.1);
}

}  // namespace
}  // namespace weft::test
