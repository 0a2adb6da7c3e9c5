#pragma once
#include <array>
#include <cstdint>
#include <numeric>
#include <string>

namespace weft {

/// What a step must not leave behind.
enum class Fault {
  none,
  not_finite,     ///< a position or a velocity is NaN or infinite
  too_fast,       ///< a node is faster than StepGuard::kMostSpeed
  too_stretched,  ///< a structural spring is strained beyond StepGuard::kMostStrain
  gained,         ///< it brought in more energy than anything could give (BodyEnergy)
  unsolved,       ///< the integrator itself says that it found no next state
  too_costly,     ///< the step would take more work than it may (interrupt.h)
  crowded,        ///< more cloth lies in one place than is kept apart
};

/// How a step is made: the cloth's own way, and what is tried in its place, one after the other.
enum class Rung { own, substeps_4, substeps_16, backward_euler_4, backward_euler_16 };
inline constexpr std::size_t kRungs = 5;

/// Something that the step guard found and did.
struct GuardEvent {
  enum class Action {
    redone,        ///< the step was taken back and made again by `rung`, which is kept for a while
    frozen,        ///< nothing helped: the cloth stands still at its last good state, and is tried again
    thawed,        ///< a frozen cloth moves again, by `rung`
    ball_stopped,  ///< a ball, or a body, was put back to its last good place, at rest
    let_through    ///< a part of the cloth was not kept from passing through cloth (FeatureSearch)
  };
  Action action = Action::redone;
  Fault fault = Fault::none;  ///< none if thawed
  double value = 0;           ///< what was found: m/s, the strain, or J; not by let_through
  double limit = 0;           ///< and what is allowed
  Rung rung = Rung::own;      ///< redone and thawed
  std::size_t cloth = 0;      ///< index
  std::uint32_t ball = 0;     ///< ball_stopped: its ColliderId, in place of a cloth
  std::uint64_t step = 0;     ///< step_count() of the simulation after it
  template <class Archive>
  void serialize(Archive& archive) {
    archive(action, fault, value, limit, rung, cloth, ball, step);
  }
};

/// One line for people: "cloth "flag": step 120 gave a speed of 2e+07 m/s (at most 1e+06): made again with 4
/// times the substeps". `cloth` is the name, not used for balls.
std::string describe(const GuardEvent& event, const std::string& cloth);

/// Counted since the cloth was made.
struct GuardCounters {
  std::array<std::uint64_t, kRungs> redone{};  ///< steps made again, by the rung that did it; none by own
  std::uint64_t frozen = 0;                    ///< times

  template <class Archive>
  void serialize(Archive& archive) {
    archive(redone, frozen);
  }

  std::uint64_t all_redone() const { return std::accumulate(redone.begin(), redone.end(), std::uint64_t{0}); }
};

}  // namespace weft
