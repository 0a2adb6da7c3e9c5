#include "host/viewer.h"

#include <algorithm>
#include <utility>

namespace weft::host {

void Viewer::on_wake(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

std::optional<Outgoing> Viewer::take() {
  const std::lock_guard lock(mutex_);
  if (!texts_.empty()) {
    Outgoing next{std::move(texts_.front()), nullptr};
    texts_.pop_front();
    return next;
  }
  if (may_send_frame()) {
    if (window_ > 0) outstanding_.push_back(newest_->frame);
    return Outgoing{nullptr, std::exchange(newest_, nullptr)};
  }
  idle_ = true;
  return std::nullopt;
}

bool Viewer::overflowed() const {
  const std::lock_guard lock(mutex_);
  return overflowed_;
}

void Viewer::send(Text text) {
  const std::lock_guard lock(mutex_);
  // One that does not read is never found idle: what is being sent to it does not get through.
  if (!push(std::move(text))) return wake_now();
  wake_if_idle();
}

void Viewer::send(std::uint64_t visit, Text text) {
  const std::lock_guard lock(mutex_);
  if (visit != visit_) return;
  // One that does not read is never found idle: what is being sent to it does not get through.
  if (!push(std::move(text))) return wake_now();
  wake_if_idle();
}

void Viewer::publish(std::uint64_t visit, std::shared_ptr<const FrameMessage> frame) {
  const std::lock_guard lock(mutex_);
  if (visit != visit_) return;
  if (newest_) ++dropped_;
  newest_ = std::move(frame);
  wake_if_idle();
}

std::uint64_t Viewer::enter() {
  const std::lock_guard lock(mutex_);
  newest_ = nullptr;
  outstanding_.clear();
  return ++visit_;
}

void Viewer::enable_acks(int window) {
  const std::lock_guard lock(mutex_);
  window_ = window;
  wake_if_idle();
}

bool Viewer::acknowledge(std::uint32_t frame) {
  const std::lock_guard lock(mutex_);
  // The last one of that number: a paused scene sends one step more than once.
  const auto found = std::find(outstanding_.rbegin(), outstanding_.rend(), frame);
  if (found == outstanding_.rend()) return false;
  outstanding_.erase(outstanding_.begin(), found.base());
  wake_if_idle();
  return true;
}

std::uint64_t Viewer::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

bool Viewer::push(Text text) {
  if (texts_.size() >= kMaxTexts) return std::exchange(overflowed_, true);
  texts_.push_back(std::move(text));
  return true;
}

bool Viewer::may_send_frame() const {
  return newest_ && (window_ == 0 || outstanding_.size() < static_cast<std::size_t>(window_));
}

void Viewer::wake_if_idle() {
  if (!idle_ || !(overflowed_ || !texts_.empty() || may_send_frame())) return;
  wake_now();
}

void Viewer::wake_now() {
  idle_ = false;
  if (wake_) wake_();
}

}  // namespace weft::host
