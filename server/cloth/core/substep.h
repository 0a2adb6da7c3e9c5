#pragma once

namespace weft {

/// A part of a step: it begins and ends at these fractions of the step and takes so many seconds. One that
/// begins where it ends is a moment, in which no solid moves, of a step of so many seconds.
struct Substep {
  double from = 0, to = 1;
  double seconds = 1.0 / 60;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(from, to, seconds);
  }

  /// Of the whole step.
  double step_seconds() const { return to > from ? seconds / (to - from) : seconds; }
  static Substep of(int index, int count, double dt) {
    return {static_cast<double>(index) / count, static_cast<double>(index + 1) / count, dt / count};
  }
};

}  // namespace weft
