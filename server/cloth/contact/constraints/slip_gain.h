#pragma once
#include <cmath>
#include <utility>

namespace weft {

/// By how much farther a contact slid in the last substep, and in the one before, than if it had gone on as
/// it went, m: what an acceleration adds to its slip.
class SlipGain {
 public:
  void add(double gained) { before_ = std::exchange(last_, gained); }
  /// That it will gain again: the nearer to zero of the two, 0 if they differ in sign. A gain that lasts is
  /// trusted, one that a single step's rounding gave is not.
  double lasting() const {
    if (last_ * before_ <= 0) return 0;
    return std::abs(last_) < std::abs(before_) ? last_ : before_;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(last_, before_);
  }

 private:
  double last_ = 0, before_ = 0;
};

}  // namespace weft
