#include "runner.h"

#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "cloth/integrators/symplectic_euler.h"
#include "cloth/sheet/diagnostics.h"
#include "criteria.h"

namespace weft::stability {
namespace {

constexpr double kLosingTime = 30;    ///< s, in which what is not asleep yet loses energy
constexpr int kLosingTimes = 10;      ///< after the last phase; then it is asleep
constexpr double kRestSeconds = 0.5;  ///< at the end, watched for jitter
/// Under a sanitizer, which is there for the code and not for the figures, a run ends after so many
/// substeps: more are the same ones again (S12 makes 7.3 million with symplectic Euler, S1a 4.8). The release
/// build, whose affair the figures are, makes all.
#ifdef WEFT_SANITIZED
constexpr long kMostSubsteps = 50000;
#else
constexpr long kMostSubsteps = std::numeric_limits<long>::max();
#endif

/// s, of the calling thread.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

bool unsolved(const std::vector<GuardEvent>& events) {
  return std::any_of(events.begin(), events.end(),
                     [](const GuardEvent& event) { return event.fault == Fault::unsolved; });
}

/// One case being run.
class Run {
 public:
  Run(const Case& hard_case, const Setup& setup, bool nightly)
      : case_(hard_case), setup_(setup), nightly_(nightly), expect_(hard_case.expect(setup)) {}

  Result result() {
    if (case_.watch) watch_ = case_.watch(setup_);
    for (std::size_t i = 0; i < case_.phases.size() && goes_on(); ++i) run_phase(i);
    if (goes_on() && result_.stretch < expect_.stretch_least) {
      complain("stiff: stretch " + number(result_.stretch) + "; at least " + number(expect_.stretch_least),
               time_);
    }
    if (goes_on() && expect_.rests) come_to_rest();
    if (goes_on() && case_.ending) complain_once(case_.ending(*simulation_, setup_));
    result_.cut_short = finite_ && !goes_on();
    if (steps_ > 0) result_.milliseconds = 1e3 * seconds_ / static_cast<double>(steps_);
    result_.stretch_limit = expect_.stretch;
    if (!result_.complaints.empty()) {
      result_.verdict = expected_to_fail() ? Verdict::limit : Verdict::fail;
    } else if (pierced_) {
      result_.verdict = Verdict::pierced;
      result_.complaints.push_back("a solid has come through between nodes: stretch " +
                                   number(result_.stretch));
    } else if (result_.stretch > expect_.stretch) {
      result_.verdict = Verdict::stretches;
      result_.complaints.push_back("stretch of at most " + number(expect_.stretch) +
                                   " is not claimed: XPBD is known to leave " + number(expect_.excess) +
                                   " more");
    }
    return std::move(result_);
  }

 private:
  bool goes_on() const { return finite_ && substeps_ < kMostSubsteps; }
  /// Symplectic Euler's substeps are bounded, too: where it would need more it has no solution.
  bool expected_to_fail() const {
    return setup_.method == Method::explicit_fixed ||
           (setup_.method == Method::symplectic_euler && (case_.beyond_explicit || out_of_substeps_));
  }

  void run_phase(std::size_t index) {
    const Phase& phase = case_.phases[index];
    const bool last = index + 1 == case_.phases.size();
    auto next = std::make_unique<Simulation<float>>(phase.scene(setup_));
    if (simulation_) {
      next->cloths()[0].particles() = simulation_->cloths()[0].particles();
    } else if (case_.prepare) {
      case_.prepare(*next);
    }
    simulation_ = std::move(next);
    bound_ = energy_bound(*simulation_, setup_, expect_.input);
    if (watch_ && index == 0) complain_once(watch_(*simulation_, 0));
    const long steps = last && nightly_ ? nightly_steps() : std::lround(phase.seconds * setup_.hz);
    for (long step = 0; step < steps && goes_on(); ++step) {
      make_step();
      judge(static_cast<double>(step + 1) / setup_.hz, last);
    }
  }

  /// Of the last phase.
  long nightly_steps() const {
    if (case_.nightly_steps > 0) return case_.nightly_steps;
    const double seconds = case_.nightly_seconds > 0 ? case_.nightly_seconds : case_.phases.back().seconds;
    return std::lround(seconds * setup_.hz);
  }

  void make_step() {
    const double before = processor_time();
    if (case_.drive) case_.drive(*simulation_, time_);
    simulation_->step();
    seconds_ += processor_time() - before;
    substeps_ += simulation_->last_advance(0).substeps;
    ++steps_;
    time_ = static_cast<double>(steps_) / setup_.hz;
  }

  void come_to_rest() {
    const double start = time_;
    for (int time = 1; time <= kLosingTimes && goes_on() && !asleep(); ++time) {
      if (!loses_energy(start, time == kLosingTimes)) break;
    }
    result_.rest_seconds = time_ - start;
  }
  /// For kLosingTime or until it sleeps. Complains if it does neither, or is awake `at_last`.
  bool loses_energy(double start, bool at_last) {
    const auto steps = std::lround(kLosingTime * setup_.hz);
    const auto rest = static_cast<long>(kRestSeconds * setup_.hz);
    EnergyFall energy(steps);
    Jitter jitter;
    for (long step = 0; step < steps && goes_on() && !asleep(); ++step) {
      make_step();
      judge(case_.phases.back().seconds, true);
      energy.add(energy_);
      if (step >= steps - rest) jitter.add(positions(*simulation_));
    }
    if (!goes_on() || asleep() || (energy.falls() && !at_last)) return true;
    complain(
        "awake " + number(time_ - start) + " s after" + (energy.falls() ? "" : ", its energy falls no more"),
        time_);
    const double share = jitter.largest() / simulation_->description().cloths[0].size.maxCoeff();
    if (share > kJitter) {
      complain("jitter of " + number(share) + " of the size; at most " + number(kJitter), time_);
    }
    return false;
  }
  bool asleep() const {
    const auto& cloths = simulation_->cloths();
    return std::all_of(cloths.begin(), cloths.end(), [](const auto& cloth) { return cloth.asleep(); });
  }

  /// After a step, `time` since the phase's start.
  void judge(double time, bool last_phase) {
    finite_ = simulation_->healthy();
    result_.guard_events += static_cast<int>(simulation_->guard_events().size());
    out_of_substeps_ = out_of_substeps_ || simulation_->last_advance(0).substeps == kMaxSubsteps ||
                       unsolved(simulation_->guard_events());
    if (!finite_) return complain("not finite", time_);
    complain_once(guard_complaint(*simulation_));
    const Reading now = read(*simulation_, setup_.method != Method::xpbd);
    energy_ = now.energy;
    const double rise = now.energy - bound_.start;
    result_.energy_rise = std::max(result_.energy_rise, rise / bound_.allowed);
    if (!(rise <= bound_.allowed)) {
      complain("energy " + number(rise) + " J above the start's; allowed " + number(bound_.allowed), time_);
      constexpr double kHopeless = 1e6;
      finite_ = rise < kHopeless * bound_.allowed;
    }
    result_.worst_stretch = std::max(result_.worst_stretch, now.stretch);
    if (last_phase && time >= expect_.stretch_from) {
      result_.stretch = std::max(result_.stretch, now.stretch);
      if (now.stretch > expect_.held_to()) {
        pierced_ = expect_.may_be_pierced && is_pierced(*simulation_);
        if (!pierced_)
          complain("stretch " + number(now.stretch) + "; at most " + number(expect_.held_to()), time_);
      }
    }
    if (time_ >= expect_.penetration_from) {
      result_.penetration = std::max(result_.penetration, now.penetration);
      if (now.penetration > expect_.penetration) {
        complain("penetration " + number(now.penetration) + " m; at most " + number(expect_.penetration),
                 time_);
      }
    }
    if (expect_.top_speed && now.speed > *expect_.top_speed) {
      complain("speed " + number(now.speed) + " m/s; at most " + number(*expect_.top_speed), time_);
    }
    if (watch_) complain_once(watch_(*simulation_, time_));
  }

  void complain_once(const Complaint& complaint) {
    if (complaint) complain(*complaint, time_);
  }
  /// Keeps the first complaint of each kind, which its first word tells.
  void complain(const std::string& text, double time) {
    const std::string kind = text.substr(0, text.find(' '));
    for (const std::string& earlier : result_.complaints) {
      if (earlier.substr(0, earlier.find(' ')) == kind) return;
    }
    result_.complaints.push_back(text + " (at " + number(time) + " s)");
  }

  const Case& case_;
  Setup setup_;
  bool nightly_;
  Expectation expect_;
  std::unique_ptr<Simulation<float>> simulation_;
  Watch watch_;
  EnergyBound bound_;
  bool out_of_substeps_ = false;
  Result result_;
  double time_ = 0, seconds_ = 0, energy_ = 0;
  long steps_ = 0, substeps_ = 0;
  bool finite_ = true, pierced_ = false;
};

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr std::array kNames{"pass", "fail", "limit", "stretches", "pierced"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Result run(const Case& hard_case, const Setup& setup, bool nightly) {
  return Run(hard_case, setup, nightly).result();
}

}  // namespace weft::stability
