#pragma once
#include <cstddef>
#include <vector>

#include "scene/object.h"

namespace weft::scene {

/// A number, or several, that scene files give and that may be changed while a scene runs.
struct ParameterKind {
  const char* name;          ///< as in commands
  std::size_t count = 1;     ///< it has so many numbers: more than one are an array
  Range range;               ///< of each of them, both ends included
  bool one_for_all = false;  ///< a single number stands for `count` equal ones

  /// A number may stand for it that is no array.
  bool takes_one() const { return count == 1 || one_for_all; }
};

/// One of an effect, or of a material.
template <class Owner>
struct Parameter : ParameterKind {
  /// Its numbers; where the owner has none of its own those that it goes by.
  std::vector<double> (*read)(const Owner& owner);
  /// Takes `count` numbers, which are in the range.
  void (*write)(Owner& owner, const std::vector<double>& values);
};

}  // namespace weft::scene
