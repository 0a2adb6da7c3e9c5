// What the step guard finds in a state, and how it is told.
#include <gtest/gtest.h>

#include "busy_scene.h"
#include "cloth/kernels/state_kernels.h"
#include "faults.h"

namespace weft {
namespace {

using test::kNaN;

template <class Real>
class GuardLimits : public ::testing::Test {};
using GuardReals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(GuardLimits, GuardReals);

TYPED_TEST(GuardLimits, ExtremesAreThoseOfAPlainLoop) {
  using Real = TypeParam;
  for (const auto& size : {std::pair{2, 2}, {3, 17}, {9, 9}, {17, 33}, {33, 20}}) {
    const int rows = size.first, cols = size.second;
    Particles<Real> sheet(Grid::with_nodes(rows, cols));
    test::randomise(sheet.position, -2, 2, 1);
    test::randomise(sheet.velocity, -5, 5, 2);
    double speed = 0, along_u = 0, along_v = 0;
    test::each_node(sheet.grid(), [&](int r, int c) {
      const Vec3 p = sheet.position_at(r, c);
      speed = std::max(speed, sheet.velocity_at(r, c).squaredNorm());
      if (c + 1 < cols) along_u = std::max(along_u, (sheet.position_at(r, c + 1) - p).squaredNorm());
      if (r + 1 < rows) along_v = std::max(along_v, (sheet.position_at(r + 1, c) - p).squaredNorm());
    });
    const auto found =
        kernels::state_extremes(sheet.grid(), kernels::components(std::as_const(sheet.position)),
                                kernels::components(std::as_const(sheet.velocity)));
    const double rounding = 8 * double(std::numeric_limits<Real>::epsilon());
    EXPECT_NEAR(double(found.speed), speed, rounding * speed);
    EXPECT_NEAR(double(found.along_u), along_u, rounding * along_u);
    EXPECT_NEAR(double(found.along_v), along_v, rounding * along_v);
  }
}

TYPED_TEST(GuardLimits, NoBadNumberIsOverlooked) {
  using Real = TypeParam;
  Particles<Real> sheet = test::flat_sheet<Real>(5, 17, {2, 2});
  StepGuard<Real> guard{IntegratorDescription{}};
  guard.enter(sheet, {0.125, 0.5});
  ASSERT_TRUE(guard.sound());
  const Particles<Real> good = sheet;
  const Real infinity = std::numeric_limits<Real>::infinity();
  for (const Real bad : {kNaN<Real>, -kNaN<Real>, infinity, -infinity}) {
    test::each_node(sheet.grid(), [&](int r, int c) {
      for (VectorField<Real> Particles<Real>::*field :
           {&Particles<Real>::position, &Particles<Real>::velocity}) {
        for (Field<Real> VectorField<Real>::*axis :
             {&VectorField<Real>::x, &VectorField<Real>::y, &VectorField<Real>::z}) {
          guard.set_integrator(IntegratorDescription{});
          (sheet.*field.*axis).at(r, c) = bad;
          ASSERT_EQ(guard.judge(sheet, {}), StepGuard<Real>::Verdict::make_again) << r << ", " << c;
          ASSERT_TRUE(test::same_bits(sheet.position, good.position) &&
                      test::same_bits(sheet.velocity, good.velocity));
          ASSERT_EQ(guard.judge(sheet, {}), StepGuard<Real>::Verdict::good);
          const auto events = guard.take_events();
          ASSERT_EQ(events.size(), 1U);
          ASSERT_EQ(events[0].fault, Fault::not_finite);
        }
      }
    });
  }
}

TYPED_TEST(GuardLimits, SpeedAndStrainHaveLimits) {
  using Real = TypeParam;
  Particles<Real> sheet = test::flat_sheet<Real>(5, 5, {2, 2});
  StepGuard<Real> guard{IntegratorDescription{}};
  const Vec2 cell(0.5, 0.5);
  guard.enter(sheet, cell);
  const Particles<Real> good = sheet;
  const auto fault_of = [&](const Vec3& position, const Vec3& velocity) {
    sheet = good;
    test::set(sheet.position, 4, 4, position);
    test::set(sheet.velocity, 4, 4, velocity);
    if (guard.judge(sheet, {}) == StepGuard<Real>::Verdict::good) {
      guard.enter(good, cell);
      return GuardEvent{};
    }
    guard.judge(sheet, {});  // good again
    return guard.take_events().at(0);
  };
  const Vec3 place = good.position_at(4, 4);
  EXPECT_EQ(fault_of(place, {0.99e6, 0, 0}).fault, Fault::none);
  const GuardEvent fast = fault_of(place, {0, 1.01e6, 0});
  EXPECT_EQ(fast.fault, Fault::too_fast);
  EXPECT_NEAR(fast.value, 1.01e6, 1);
  EXPECT_EQ(fast.limit, 1e6);
  // Neighbours 0.5 m apart at rest: 10,001 times that is a strain of 10,000.
  EXPECT_EQ(fault_of({0, 0, 4.9e3}, {0, 0, 0}).fault, Fault::none);
  const GuardEvent stretched = fault_of({0, 0, 5.1e3}, {0, 0, 0});
  EXPECT_EQ(stretched.fault, Fault::too_stretched);
  EXPECT_NEAR(stretched.value, 5.1e3 / 0.5 - 1, 0.01);
  EXPECT_EQ(stretched.limit, 1e4);
}

TYPED_TEST(GuardLimits, WhatAStepGainedIsNoMoreThanWhatCouldBeGiven) {
  using Real = TypeParam;
  Particles<Real> sheet = test::flat_sheet<Real>(5, 5, {2, 2});
  StepGuard<Real> guard{IntegratorDescription{}};
  guard.enter(sheet, {0.5, 0.5});
  AdvanceReport report;
  report.gained = report.could_give = 3;
  EXPECT_EQ(guard.judge(sheet, report), StepGuard<Real>::Verdict::good);
  report.gained = 3.5;
  EXPECT_EQ(guard.judge(sheet, report), StepGuard<Real>::Verdict::make_again);
  guard.judge(sheet, {});  // good again
  const GuardEvent event = guard.take_events().at(0);
  EXPECT_EQ(event.fault, Fault::gained);
  EXPECT_EQ(event.value, 3.5);
  EXPECT_EQ(event.limit, 3);
  EXPECT_EQ(event.rung, Rung::substeps_4);
}

TEST(GuardEvents, AreToldInWords) {
  GuardEvent event;
  event.action = GuardEvent::Action::redone;
  event.fault = Fault::too_fast;
  event.value = 2e7;
  event.limit = 1e6;
  event.rung = Rung::substeps_4;
  event.step = 120;
  EXPECT_EQ(describe(event, "flag"),
            "flag: step 120 gave a speed of 2e+07 m/s (at most 1e+06): made again with 4 times the substeps");
  event.fault = Fault::gained;
  event.value = 317;
  event.limit = 40;
  EXPECT_EQ(
      describe(event, "flag"),
      "flag: step 120 gave 317 J more than before (at most 40 J could come from what it met): made again "
      "with 4 times the substeps");
  event.action = GuardEvent::Action::ball_stopped;
  event.fault = Fault::not_finite;
  event.ball = 3;
  EXPECT_EQ(describe(event, ""),
            "ball 3: step 120 gave a position or velocity that is not finite: put back to its last good "
            "place, at rest");
  event.action = GuardEvent::Action::let_through;
  event.fault = Fault::crowded;
  EXPECT_EQ(describe(event, "flag"),
            "flag: step 120 gave more contacts in one place than are held: those beyond are not felt, and "
            "cloth may pass through cloth there");
}

}  // namespace
}  // namespace weft
