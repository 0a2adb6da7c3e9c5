#include "cloth/core/subnormals.h"

#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace weft {

#if defined(__SSE__)

void flush_subnormals() {
  // Results, and what they are made from.
  _mm_setcsr(_mm_getcsr() | _MM_FLUSH_ZERO_ON | 0x0040U);
}

FlushedSubnormals::FlushedSubnormals() : before_(_mm_getcsr()) { flush_subnormals(); }
FlushedSubnormals::~FlushedSubnormals() { _mm_setcsr(before_); }

#else

void flush_subnormals() {}
FlushedSubnormals::FlushedSubnormals() : before_(0) {}
FlushedSubnormals::~FlushedSubnormals() = default;

#endif

}  // namespace weft
