#pragma once

namespace weft::host {

/// Numbers too small for full precision become zero on this thread: they slow arithmetic down a hundredfold,
/// and a cloth at rest is full of them.
void flush_subnormals();

}  // namespace weft::host
