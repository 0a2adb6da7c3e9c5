#pragma once
#include <limits>
#include <stop_token>

/// Ways to end a step in hand, which may take minutes: the loops that may take long (substeps, Newton
/// iterations, conjugate gradients, contacts) say what they are about to do, and ask whether they shall. A
/// step that is not ended is the same to the bit.
namespace weft {

/// Thrown by a step that was interrupted. The simulation has no meaningful state then: it may only be reset
/// or destroyed. No std::exception, as it is no error.
struct Interrupted {};

/// As long as it lives, steps made on its thread throw Interrupted soon after `stop` is requested, whatever
/// threads of the pool help (parallel.h). The innermost of several counts. `stop` must outlive it; nullptr:
/// nothing interrupts them.
class Interruptible {
 public:
  explicit Interruptible(const std::stop_token* stop);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  /// What interrupts the calling thread now, or nullptr.
  static const std::stop_token* current();

 private:
  const std::stop_token* outer_;
};

/// Thrown when a WorkLimit is passed. Like Interrupted no std::exception.
struct TooMuchWork {};

/// Counts the work done on its thread as long as it lives; beyond `most`, TooMuchWork is thrown. The
/// innermost of several counts. Work is counted, not timed, so it is the same on any machine and number of
/// threads: one unit is a node in a substep of symplectic Euler, some 20 ns; others take as many units as
/// they are dearer.
class WorkLimit {
 public:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  explicit WorkLimit(double most);
  ~WorkLimit();
  WorkLimit(const WorkLimit&) = delete;
  WorkLimit& operator=(const WorkLimit&) = delete;

  /// So far.
  double done() const { return done_; }

 private:
  friend void check_interrupt(double);
  double most_, done_ = 0;
  WorkLimit* outer_;
};

/// Throws Interrupted if what the calling thread is doing shall end, TooMuchWork if so much more work is more
/// than it may do.
void check_interrupt(double work);

}  // namespace weft
