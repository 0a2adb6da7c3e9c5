#include "host/arithmetic.h"

#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace weft::host {

void flush_subnormals() {
#if defined(__SSE__)
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _mm_setcsr(_mm_getcsr() | 0x0040U);  // denormals are zero
#endif
}

}  // namespace weft::host
