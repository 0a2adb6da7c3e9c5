// Random impacts, a hundred fixed ones and, in the nightly tests, a thousand new ones from the environment's
// WEFT_SEED on.
#include "impacts.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace weft::stability {
namespace {

#ifdef WEFT_SANITIZED
constexpr int kFixedImpacts = 20, kNewImpacts = 40;
#else
constexpr int kFixedImpacts = 100, kNewImpacts = 1000;
#endif

/// A firm solid that stands takes energy, as friction and where it stops what strikes it, and gives none; one
/// that moves gives what the books say. But a step's iterations may end before they have found where a stiff
/// sheet folds in a blow: so many impacts may have a step that brings in more than a twentieth of the blow's
/// energy, and in so many a node may pass.
void strike_all(std::uint64_t first, int count, int may_create, int may_pass) {
  int create = 0, pass = 0;
  for (int i = 0; i < count; ++i) {
    const Blow blow = strike(random_impact(first + static_cast<std::uint64_t>(i)));
    create += blow.created > 0.05 ? 1 : 0;
    pass += blow.passed ? 1 : 0;
  }
  ::testing::Test::RecordProperty("create", create);
  ::testing::Test::RecordProperty("pass", pass);
  EXPECT_LE(create, may_create);
  EXPECT_LE(pass, may_pass);
}

TEST(RandomImpacts, HardlyMakeEnergy) {
  strike_all(1, kFixedImpacts, kFixedImpacts / 10, kFixedImpacts / 50);
}

TEST(RandomImpactsNightly, HardlyMakeEnergy) {
  const char* seed = std::getenv("WEFT_SEED");
  strike_all(seed != nullptr ? std::strtoull(seed, nullptr, 10) : 10000, kNewImpacts, kNewImpacts / 20,
             kNewImpacts / 100);
}

}  // namespace
}  // namespace weft::stability
