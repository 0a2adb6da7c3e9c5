#pragma once
/// What is read off a run after every step, and the criteria that every case shares:
///  - every number is finite, and no step had to be taken back by the step guard (step_guard.h), which would
///    hide from all that follows that the method had failed;
///  - the energy stays below what was put in: the energy at the start and the work of gravity (both are in
///  the
///    total energy, which may only fall) and the input a case states, with 1 % of all that moves as room.
///    Symplectic Euler conserves a modified energy instead, whose ratio to the true one lies, for a mode of
///    angular frequency w, within 1 +- w h / 2 (Hairer, Lubich and Wanner, Geometric Numerical Integration,
///    2006, I.1): at the 0.9 its steps are chosen for, that is up to 19 times what was put in.
///    XPBD leaves constraints unsolved, which is no energy that ever comes back: its springs are not counted;
///  - from a stated time on no structural spring is stretched beyond a stated limit. Compression is no harm:
///    a spring mesh shortens where cloth has folds finer than the mesh;
///  - no node is inside a ball or an obstacle deeper than stated;
///  - after the last event it comes to rest: it falls asleep, which it does when no node has got on at more
///    than 0.1 mm/s for 60 steps. In every half minute until then it has to lose energy (EnergyFall): a sheet
///    that still unfolds or slides has not settled yet and may take up to five minutes, a limit cycle, whose
///    energy does not fall, fails after half a minute. Of one that fails the jitter is told as well, the
///    largest change of a node's move from step to step: over 1e-5 of the size it is a complaint of its own.
#include <limits>

#include "case.h"

namespace weft::stability {

/// The state of a run after a step.
struct Reading {
  double energy = 0;       ///< J, of cloth, dynamic balls and bodies
  double stretch = 0;      ///< of structural springs, relative
  double compression = 0;  ///< the same, of those shortened
  double penetration = 0;  ///< m
  double speed = 0;        ///< of the fastest node, m/s
};
/// `springs_count`: whether the energy holds the springs'.
Reading read(const Simulation<float>& simulation, bool springs_count);

/// Whether the structural spring that is stretched most goes through a solid: its middle is inside by more
/// than rounding.
bool is_pierced(const Simulation<float>& simulation);

/// What the step guard had to do in the last step: a step made again, a cloth frozen, a ball stopped. That
/// more cloth lies in one place than is kept apart is told for information and no fault of the step.
Complaint guard_complaint(const Simulation<float>& simulation);

/// Largest energy that a run may have.
struct EnergyBound {
  double start = 0;    ///< J
  double allowed = 0;  ///< J above it
};
/// The part of what moves by which a method's energy may seem more than it is: 1 %, or 18 times.
double energy_room(Method method);
EnergyBound energy_bound(const Simulation<float>& simulation, const Setup& setup, double input);

/// The largest distance of a node from where it was, m.
double movement(const std::vector<Vec3>& before, const std::vector<Vec3>& now);
double root_mean_square_movement(const std::vector<Vec3>& before, const std::vector<Vec3>& now);  ///< m

/// Whether the energy falls, read after every step of some time: in the last third of it the highest is below
/// the lowest of the first third. Nothing that repeats itself within a third does that, however little energy
/// it has.
class EnergyFall {
 public:
  /// `steps` of the whole time, at least 3.
  explicit EnergyFall(long steps) : third_(steps / 3), steps_(steps) {}
  void add(double energy);  ///< J
  /// After all steps.
  bool falls() const { return highest_last_ < lowest_first_; }

 private:
  long third_, steps_, seen_ = 0;
  double lowest_first_ = std::numeric_limits<double>::infinity();
  double highest_last_ = -std::numeric_limits<double>::infinity();
};

inline constexpr double kJitter = 1e-5;  ///< of the size, what nodes at rest may shake by
/// How nodes shake: the largest change of a node's move from one step to the next.
class Jitter {
 public:
  void add(std::vector<Vec3> positions);
  double largest() const { return largest_; }  ///< m

 private:
  std::vector<Vec3> last_, before_last_;
  double largest_ = 0;
};

/// How deep a point is inside a solid at the step's end, m; 0 or less outside.
double depth(const Solid& solid, const Vec3& point);

/// Where the nodes are, row by row.
std::vector<Vec3> positions(const Simulation<float>& simulation);

}  // namespace weft::stability
