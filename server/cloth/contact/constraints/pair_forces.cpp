#include "cloth/contact/constraints/pair_forces.h"

#include <algorithm>

namespace weft {

void share_forces(std::span<std::vector<PairForce>* const> of_cloths) {
  std::vector<PairForce*> found;
  for (std::vector<PairForce>* forces : of_cloths) {
    for (PairForce& force : *forces) {
      if (force.between_cloths) found.push_back(&force);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const PairForce* a, const PairForce* b) { return a->pair < b->pair; });
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (found[i]->pair != found[i - 1]->pair) continue;
    found[i]->force = found[i - 1]->force = (found[i]->force + found[i - 1]->force) / 2;
    found[i]->grip = found[i - 1]->grip = (found[i]->grip + found[i - 1]->grip) / 2;
  }
}

}  // namespace weft
