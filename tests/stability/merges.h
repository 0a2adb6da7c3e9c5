#pragma once
/// What a change to a coarser level brings in that no way of making it could leave out: across a fold that
/// the finer grid has and the coarser one has not, springs lie compressed for as long as the fold is held.
#include "cloth/world/simulation.h"

namespace weft::stability {

/// The least energy, J, that springs and plate of a scene's first cloth can hold between its pins near where
/// they are, at its level: relaxed from rest without effects until that takes out no more than a thousandth.
double relaxed_energy(const Simulation<float>& simulation);

/// The merges of a run, to be asked what they had to bring in if it should matter.
class Merges {
 public:
  /// The first cloth's level has just been lowered; springs and plate held `before`, J.
  void add(const Simulation<float>& simulation, double before);
  /// J, that those added had to bring in; they are forgotten.
  double take_brought_in();

 private:
  struct Merge {
    Simulation<float> relaxing;
    double before;
  };
  std::vector<Merge> merges_;
};

}  // namespace weft::stability
