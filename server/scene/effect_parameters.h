#pragma once
/// The numbers of each effect that scene files give and that may be changed while a scene runs, with their
/// ranges: the one table for both.
#include <cstddef>
#include <vector>

#include "cloth/description.h"
#include "scene/object.h"

namespace weft::scene {

struct EffectParameter {
  const char* name;          ///< as in scene files
  std::size_t count = 1;     ///< it has so many numbers: more than one are an array
  Range range;               ///< of each of them, both ends included
  bool one_for_all = false;  ///< a single number stands for `count` equal ones
  /// Its numbers in an effect; where the effect has none of its own those that it goes by.
  std::vector<double> (*read)(const EffectDescription& effect);
  /// Takes `count` numbers, which are in the range.
  void (*write)(EffectDescription& effect, const std::vector<double>& values);

  /// A number may stand for it that is no array.
  bool takes_one() const { return count == 1 || one_for_all; }
};

/// Those of the effect's type, in the order in which they are read and listed; none if it has no numbers. An
/// inflation with a volume is of gas and has others than one without.
const std::vector<EffectParameter>& parameters_of(const EffectDescription& effect);

}  // namespace weft::scene
