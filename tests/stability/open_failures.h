#pragma once
#include <string>

namespace weft::stability {

/// Whether a run, "S1a_bdf2_L4_60Hz", or a random scene, "seed_50", with its file in regressions/, is in
/// open_failures.txt, each with its reason behind it: it is known to fail and waits for a repair. Such a test
/// is skipped and says why; one that passes fails until it is taken off the list, so that the list only gets
/// shorter.
bool is_open(const std::string& name);

}  // namespace weft::stability
