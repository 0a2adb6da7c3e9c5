#pragma once
#include <utility>
#include <vector>

#include "cloth/guard/guard_event.h"
#include "cloth/integrators/integrator.h"
#include "cloth/integrators/integrator_description.h"

namespace weft {

/// Keeps a cloth's last good state and takes a step back that leaves a bad one: not finite, runaway, with
/// energy that nothing gave, or given up by the integrator. It is then made again by safer and safer methods
/// (Rung), and the one that works is kept for kHold steps before the cloth's own is tried again, first within
/// limits near what there was meanwhile, so that a method that is not stable does not get far. If none works
/// the cloth is frozen: it stands still at its last good state and is tried again after 1, 2, 4, ... steps.
/// Trouble that comes back soon doubles both times, and begins with the rung that worked.
///
/// Knows nothing of contacts or the integrators' insides: Cloth makes the steps (Cloth::advance).
template <class Real>
class StepGuard {
 public:
  /// Beyond these a state is runaway. A ball may be moved by 1 km within a step (PROTOCOL.md); a sheet of 2 m
  /// that hangs on a pin and is caught by it is then 1,000 times its length, some springs several times
  /// that, and snaps back at up to 1e5 m/s. What is ten times beyond is no motion; a method that is unstable
  /// gets there within a few steps, each being a multiple of the one before.
  static constexpr double kMostSpeed = 1e6;   ///< m/s
  static constexpr double kMostStrain = 1e4;  ///< of structural springs, 1 = twice as long
  /// While the own way is on trial: times what there was at most while another rung was kept, and besides.
  static constexpr double kTrialFactor = 10, kTrialSpeed = 10, kTrialStrain = 1;
  static constexpr int kHold = 60;  ///< steps
  static constexpr int kLongestHold = 64 * kHold;
  static constexpr int kLongestFreeze = 4096;  ///< steps between two attempts

  explicit StepGuard(const IntegratorDescription& own) : own_(own) {}

  /// The cloth is stepped by `own` from now on; troubles with the one before are forgotten. A frozen one is
  /// tried at once.
  void set_integrator(const IntegratorDescription& own);
  /// Another grid, or a state from outside: the last good one from now on, if it is good. `cell` is a cell's
  /// width and height, m; infinite if nothing holds the nodes together. A frozen cloth is tried at once.
  void enter(const Particles<Real>& particles, const Vec2& cell);

  /// How the next step is to be made.
  Rung rung() const { return rung_; }
  IntegratorDescription method() const;
  bool frozen() const { return frozen_; }
  /// Asked once before a step: true if the cloth is left as it is.
  bool stands_still();
  enum class Verdict {
    good,        ///< it is the last good state from now on
    make_again,  ///< the particles are at the last good state again; by method()
    stand_still  ///< they are, at rest, and stay there in this step
  };
  /// A step left a good state.
  bool passes(const Particles<Real>& particles, const AdvanceReport& report) const {
    return find(particles, report).fault == Fault::none;
  }
  /// Judges a step.
  Verdict judge(Particles<Real>& particles, const AdvanceReport& report);
  /// The state was changed after the step it was judged in: it is the last good one from now on, if it is
  /// good, or else put back.
  void amend(Particles<Real>& particles);
  /// Before the particles are used for something else than a step, as a level change: if they are bad they
  /// are put back to the last good state.
  void repair(Particles<Real>& particles);

  /// The particles are at the last good state again.
  void put_back(Particles<Real>& particles) const { restore(particles); }
  /// The step in hand would take too much work: as if nothing had helped, the cloth stands still.
  void give_up(Particles<Real>& particles);
  /// What gave trouble is gone: it is forgotten, and a frozen cloth is tried at once.
  void forgive() {
    freeze_left_ = 0;
    good_steps_ = kHold;
  }

  /// False if the cloth has never been in a good state.
  bool sound() const { return sound_; }
  /// Largest speed in the last good state, m/s.
  double speed() const { return speed_; }
  const GuardCounters& counters() const { return counters_; }
  /// What was done since the last call.
  std::vector<GuardEvent> take_events() { return std::exchange(events_, {}); }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(own_, cell_, place_, position_, velocity_, sound_, speed_, rung_, trouble_, relapse_, good_steps_,
            last_rung_, limits_, trial_limits_, hold_, hold_left_, frozen_, freeze_, freeze_left_, counters_,
            events_);
  }

 private:
  struct Finding {
    Fault fault = Fault::none;
    double value = 0, limit = 0;
    double speed = 0;  ///< m/s
    double strain = 0;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(fault, value, limit, speed, strain);
    }
  };
  struct Limits {
    double speed = kMostSpeed, strain = kMostStrain;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(speed, strain);
    }
  };
  Finding look_at(const Particles<Real>& particles) const;
  /// After a step.
  Finding find(const Particles<Real>& particles, const AdvanceReport& report) const;
  void keep(const Particles<Real>& particles, double speed);
  /// The limits of the trial that follows the hold.
  void watch_hold(const Finding& finding);
  void restore(Particles<Real>& particles) const;
  void went_well(const Finding& finding);
  void went_wrong(const Finding& finding);
  void freeze();
  void tell(GuardEvent::Action action);

  IntegratorDescription own_;
  Vec2 cell_{1, 1};
  Vec3 place_{0, 0, 0};                    ///< Particles::place of the last good state
  VectorField<Real> position_, velocity_;  ///< the last good state
  bool sound_ = false;
  double speed_ = 0;

  Rung rung_ = Rung::own;
  Finding trouble_;             ///< of the step in hand, as it was found first
  bool relapse_ = false;        ///< it came soon after the one before
  int good_steps_ = kHold;      ///< by the own way since then, as far as they count: kHold end the trial
  Rung last_rung_ = Rung::own;  ///< that worked
  Limits limits_, trial_limits_;
  int hold_ = kHold, hold_left_ = 0;  ///< steps that a rung is kept, and that are left of them
  bool frozen_ = false;
  int freeze_ = 1, freeze_left_ = 0;  ///< steps from one attempt to the next
  GuardCounters counters_;
  std::vector<GuardEvent> events_;
};

extern template class StepGuard<float>;
extern template class StepGuard<double>;

}  // namespace weft
