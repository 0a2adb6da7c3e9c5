// The coefficients that a substep gets, rate 1/h and offset 0 by backward Euler, rate 3/(2h) by BDF2, and
// when it gets which.
#include "cloth/integrators/step_formula.h"

#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kFormulaStep = 0.01;       // s
const Vec3 kFormulaSpeed = Vec3(1, 2, -1);  // m/s

/// A sheet of 2 x 2 nodes that flies on evenly, substep by substep.
class Formula : public ::testing::Test {
 protected:
  void begin(StepFormula<double>& formula, double h = kFormulaStep) {
    formula.begin_step(sheet, h);
    formula.begin_substep(sheet);
    formula.prepare();
  }
  void end(StepFormula<double>& formula, double h = kFormulaStep) {
    each_node(sheet.grid(), [&](int r, int c) {
      set(sheet.position, r, c, get(sheet.position, r, c) + h * kFormulaSpeed);
      set(sheet.velocity, r, c, kFormulaSpeed);
    });
    formula.end_substep(sheet);
  }
  double rate(const StepFormula<double>& formula, int r, int c) const {
    return formula.coefficients().rate[sheet.grid().index(r, c)];
  }

  Particles<double> sheet = flat_sheet<double>(2, 2, {1, 1});
};

TEST_F(Formula, TheFirstSubstepIsBackwardEulersTheNextOneBdf2s) {
  StepFormula<double> formula(sheet.grid(), true);
  each_node(sheet.grid(), [&](int r, int c) { set(sheet.velocity, r, c, kFormulaSpeed); });
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 1 / kFormulaStep);
  EXPECT_DOUBLE_EQ(formula.coefficients().free_move.y[0], kFormulaStep * kFormulaSpeed.y());
  end(formula);
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 1.5 / kFormulaStep);
  // What moves evenly would go on so, by either formula.
  EXPECT_NEAR(formula.coefficients().free_move.y[0], kFormulaStep * kFormulaSpeed.y(), 1e-15);
  EXPECT_EQ(formula.lead(), nullptr) << "BDF2's places do not run ahead";
}

TEST_F(Formula, ABrokenNodeGoesByBackwardEulerInThatSubstep) {
  StepFormula<double> formula(sheet.grid(), true);
  begin(formula);
  end(formula);
  formula.begin_step(sheet, kFormulaStep);
  formula.begin_substep(sheet);
  formula.break_motion(sheet.grid().index(0, 1));
  formula.prepare();
  EXPECT_DOUBLE_EQ(rate(formula, 0, 1), 1 / kFormulaStep);
  EXPECT_DOUBLE_EQ(rate(formula, 1, 1), 1.5 / kFormulaStep);
  end(formula);
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 1), 1.5 / kFormulaStep) << "it has a past again";
  end(formula);
  formula.begin_anew(sheet.grid().index(1, 0));
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 1, 0), 1 / kFormulaStep) << "as what touched it has let go";
}

TEST_F(Formula, ASubstepTakenBackHasNoPastAndLeavesNone) {
  StepFormula<double> formula(sheet.grid(), true);
  begin(formula);
  end(formula);
  begin(formula);
  const Vec3 before = get(sheet.position, 0, 0);
  set(sheet.position, 0, 0, Vec3(7, 7, 7));
  formula.return_to_start(sheet);
  EXPECT_EQ(get(sheet.position, 0, 0), before);
  EXPECT_EQ(get(sheet.velocity, 0, 0), kFormulaSpeed);
  formula.break_all();
  formula.prepare();
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 1 / kFormulaStep);
  end(formula);
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 1 / kFormulaStep);
  end(formula);
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 1.5 / kFormulaStep);
}

TEST_F(Formula, Bdf2IsForEqualSteps) {
  StepFormula<double> formula(sheet.grid(), true);
  begin(formula);
  end(formula);
  begin(formula, kFormulaStep / 2);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 2 / kFormulaStep);
}

// Under a steady force backward Euler's places are half a substep ahead of its speeds (EnergyLedger).
TEST_F(Formula, BackwardEulersPlacesRunAheadUnlessANodeIsHeld) {
  StepFormula<double> formula(sheet.grid(), false);
  begin(formula);
  EXPECT_EQ(formula.by_bdf2(), nullptr);
  ASSERT_NE(formula.lead(), nullptr);
  EXPECT_DOUBLE_EQ(formula.lead()->at(1, 0), kFormulaStep / 2);
  formula.break_motion(sheet.grid().index(1, 0));
  EXPECT_EQ(formula.lead()->at(1, 0), 0);
  end(formula);
  begin(formula);
  EXPECT_DOUBLE_EQ(rate(formula, 0, 0), 1 / kFormulaStep) << "it never looks back";
  sheet.inverse_mass.at(0, 0) = 0;
  begin(formula);
  EXPECT_EQ(formula.lead(), nullptr);
}

// The acceleration is the change of the velocity over the substep, and what is remembered of the velocity is
// scaled as the sheet's own is: of a sheet that is held from 0.
TEST_F(Formula, TellsTheAccelerationAndScalesWhatItRemembers) {
  StepFormula<double> formula(sheet.grid(), true);
  begin(formula);
  end(formula);
  EXPECT_NEAR((get(sheet.acceleration, 1, 1) - kFormulaSpeed / kFormulaStep).norm(), 0, 1e-12);
  begin(formula);
  end(formula);
  begin(formula);
  const double whole = formula.coefficients().free_move.x[0];
  formula.scale(sheet, 0.5, Freedom::none());
  formula.prepare();
  // Without forces 3 v_new = 4 v - v_last, and the move is v_new / rate + last move / 3, rate = 3/(2h): half
  // of v_last less is a move of h v_last / 9 more.
  EXPECT_NEAR(formula.coefficients().free_move.x[0], whole + kFormulaStep * kFormulaSpeed.x() / 9, 1e-15);
}

}  // namespace
}  // namespace weft::test
