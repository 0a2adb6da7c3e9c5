// The program that libFuzzer drives: compiled once a target, which WEFT_FUZZ_TARGET names.
#include <cstddef>

#include "targets.h"

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::WEFT_FUZZ_TARGET({data, size});
  return 0;
}
