#include "cloth/core/interrupt.h"

#include <utility>

namespace weft {
namespace {

thread_local const std::stop_token* current_stop = nullptr;
thread_local WorkLimit* current_limit = nullptr;

}  // namespace

Interruptible::Interruptible(const std::stop_token* stop) : outer_(std::exchange(current_stop, stop)) {}
Interruptible::~Interruptible() { current_stop = outer_; }

const std::stop_token* Interruptible::current() { return current_stop; }

WorkLimit::WorkLimit(double most) : most_(most), outer_(std::exchange(current_limit, this)) {}
WorkLimit::~WorkLimit() { current_limit = outer_; }

void check_interrupt(double work) {
  if (current_stop != nullptr && current_stop->stop_requested()) throw Interrupted();
  if (current_limit == nullptr) return;
  current_limit->done_ += work;
  if (current_limit->done_ > current_limit->most_) throw TooMuchWork();
}

}  // namespace weft
