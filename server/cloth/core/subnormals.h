#pragma once

namespace weft {

/// Numbers too small for full precision become zero on this thread: they slow arithmetic down a hundredfold,
/// and a cloth at rest is full of them.
void flush_subnormals();

/// The same as long as it lives: the thread is the caller's, whose own arithmetic is then as it was.
class FlushedSubnormals {
 public:
  FlushedSubnormals();
  ~FlushedSubnormals();
  FlushedSubnormals(const FlushedSubnormals&) = delete;
  FlushedSubnormals& operator=(const FlushedSubnormals&) = delete;

 private:
  unsigned before_;
};

}  // namespace weft
