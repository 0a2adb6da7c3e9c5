#pragma once
/// What a study tries: integrators and their settings.
#include <string>
#include <string_view>
#include <vector>

#include "cloth/world/description.h"

namespace weft::study {

/// One way to step a scene.
struct Candidate {
  IntegratorDescription integrator;
  bool present = false;  ///< the scene's own choice
};

/// Every integrator's name, in the order of a study's curves.
const std::vector<std::string_view>& integrator_names();

std::string_view name_of(const IntegratorDescription& integrator);
/// The settings in words, "8 substeps, tolerance 0.05"; says all that sets two candidates of one name apart.
std::string setting_of(const IntegratorDescription& integrator);

/// The scene's own choice, then each named integrator's settings in rounds: the first round has one setting
/// of every integrator, cheapest first, so that a study cut short has something of each. symplectic_euler: 1,
/// 2 and 4 times the fewest stable substeps; xpbd: 5 to 160 substeps; implicit ones: 1 to 16 substeps,
/// first with one loosely solved linearisation each, then as scenes have it, then with three tightly solved
/// ones. `names` are of integrator_names().
std::vector<Candidate> candidates(const std::vector<std::string_view>& names,
                                  const IntegratorDescription& present);

}  // namespace weft::study
