#pragma once
/// What random scenes of the truths are drawn with.
#include <array>
#include <random>

namespace weft::test {

/// The same on every machine: from the generator's numbers, not through the library's distributions.
class Draws {
 public:
  double between(double low, double high) {
    return low + (high - low) * double(random_()) / double(std::mt19937::max());
  }
  template <class Each, std::size_t count>
  Each one_of(const std::array<Each, count>& all) {
    return all[random_() % count];
  }
  /// From 0 on.
  int below(int count) { return static_cast<int>(random_() % static_cast<std::mt19937::result_type>(count)); }

 private:
  std::mt19937 random_{1};
};

}  // namespace weft::test
