#pragma once
#include <vector>

namespace weft {

/// A spring of an implicit step's linear system that resists one way only, as a contact does, along a change
/// of the nodes' moves.
struct OneSidedSpring {
  double depth;      ///< to which it is pressed before the change, m; below 0 it would pull
  double approach;   ///< by which the whole change presses it deeper, m
  double stiffness;  ///< N/m
  bool acts;         ///< the system holds it, both ways; if not it resists all the same where it is pressed
};

/// The share of the change, in (0, 1], at which the energy is least. By the system the whole change is best
/// and lowers the energy by `decrease`, J. Without this search springs that hardly pull are let go all
/// together, nodes sink in, are all held again, and so on: a falling tablecloth at level 6 took 6.8 systems a
/// step, with it 3.4 (Nocedal and Wright, Numerical Optimization, 2006, chapter 3).
double best_share(const std::vector<OneSidedSpring>& springs, double decrease);

}  // namespace weft
