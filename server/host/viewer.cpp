#include "host/viewer.h"

#include <algorithm>
#include <utility>

namespace weft::host {
namespace {

/// As many frames a second are sent at most.
constexpr double kMostASecond = 60;
/// Frames on the way at most beside those that a viewer asks for: of a second.
constexpr int kMostMore = 60;
/// An acknowledgement later than the way takes by more than this is of a frame that has queued.
constexpr Viewer::Seconds kQueued{0.1};
/// What a viewer may take over a frame without being slow.
constexpr Viewer::Seconds kAtOnce{0.02};
/// Of one acknowledgement in what they take.
constexpr double kWeightOfOne = 0.25;

}  // namespace

void Viewer::on_wake(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

std::optional<Outgoing> Viewer::take(TimePoint now) {
  const std::lock_guard lock(mutex_);
  if (may_send_frame() && (texts_.empty() || !frame_was_last_)) {
    frame_was_last_ = true;
    if (window_ > 0) outstanding_.push_back({newest_->frame, now});
    return Outgoing{nullptr, std::exchange(newest_, nullptr)};
  }
  if (texts_.empty()) {
    idle_ = true;
    return std::nullopt;
  }
  frame_was_last_ = false;
  Waiting next = std::move(texts_.front());
  texts_.pop_front();
  if (next.key.empty()) {
    --unkeyed_;
    if (before_frame_ > 0) --before_frame_;
  }
  return Outgoing{std::move(next.text), nullptr};
}

bool Viewer::overflowed() const {
  const std::lock_guard lock(mutex_);
  return overflowed_;
}

void Viewer::send(Text text) {
  const std::lock_guard lock(mutex_);
  push(std::move(text), {});
}

void Viewer::send(std::uint64_t visit, Text text, std::string_view key) {
  const std::lock_guard lock(mutex_);
  if (visit == visit_) push(std::move(text), key);
}

void Viewer::publish(std::uint64_t visit, std::shared_ptr<const FrameMessage> frame) {
  const std::lock_guard lock(mutex_);
  if (visit != visit_) return;
  ++flow_.published;
  if (newest_) {
    ++dropped_;
    ++flow_.dropped;
  }
  newest_ = std::move(frame);
  before_frame_ = unkeyed_;
  wake_if_idle();
}

void Viewer::command_given() {
  const std::lock_guard lock(mutex_);
  ++unanswered_;
}

void Viewer::command_answered() {
  const std::lock_guard lock(mutex_);
  --unanswered_;
}

bool Viewer::all_answered() const {
  const std::lock_guard lock(mutex_);
  return unanswered_ == 0;
}

std::uint64_t Viewer::enter() {
  const std::lock_guard lock(mutex_);
  newest_ = nullptr;
  outstanding_.clear();
  flow_ = {};
  return ++visit_;
}

void Viewer::enable_acks(int window) {
  const std::lock_guard lock(mutex_);
  window_ = window;
  wake_if_idle();
}

bool Viewer::acknowledge(std::uint32_t frame, TimePoint now) {
  const std::lock_guard lock(mutex_);
  // The last one of that number: a paused scene sends one step more than once.
  const auto found = std::find_if(outstanding_.rbegin(), outstanding_.rend(),
                                  [&](const Sent& sent) { return sent.frame == frame; });
  if (found == outstanding_.rend()) return false;
  // One at a time, up as down: what is sent now is told of a round trip later.
  const Seconds taken = now - found->when;
  const bool queued = taken > way_.shortest() + kQueued;
  const int room = std::min(kMostMore, static_cast<int>(way_.shortest().count() * kMostASecond));
  more_ = queued ? std::max(0, more_ - 1) : std::min(room, more_ + 1);
  taken_ += kWeightOfOne * (taken - taken_);
  outstanding_.erase(outstanding_.begin(), found.base());
  wake_if_idle();
  return true;
}

bool Viewer::ping(TimePoint now) {
  const std::lock_guard lock(mutex_);
  if (way_.waits()) return false;
  way_.asked(now);
  return true;
}

void Viewer::pong(TimePoint now) {
  const std::lock_guard lock(mutex_);
  way_.answered(now);
}

void Viewer::enable_levels() {
  const std::lock_guard lock(mutex_);
  levels_ = true;
}

bool Viewer::takes_coarser() const {
  const std::lock_guard lock(mutex_);
  return levels_;
}

void Viewer::enable_rice() {
  const std::lock_guard lock(mutex_);
  grid_coding_ = protocol::GridCoding::rice;
}

protocol::GridCoding Viewer::grid_coding() const {
  const std::lock_guard lock(mutex_);
  return grid_coding_;
}

Viewer::Flow Viewer::flow(TimePoint now) {
  const std::lock_guard lock(mutex_);
  Flow flow = std::exchange(flow_, {});
  // A ping waits behind one frame at least where two are on a slow link.
  const Seconds waiting = outstanding_.empty() ? Seconds(0) : now - outstanding_.front().when;
  flow.at_client = window_ > 0 && std::max(taken_, waiting) > 2 * way_.at_present(now) + kAtOnce;
  return flow;
}

int Viewer::window() const {
  const std::lock_guard lock(mutex_);
  return window_ + more_;
}

std::uint64_t Viewer::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void Viewer::push(Text text, std::string_view key) {
  if (!key.empty()) {
    std::erase_if(texts_, [&](const Waiting& waiting) { return waiting.key == key; });
  } else if (unkeyed_ < kMaxTexts) {
    ++unkeyed_;
  } else {
    // One that does not read is never found idle: what is being sent to it does not get through.
    if (!std::exchange(overflowed_, true)) wake_now();
    return;
  }
  texts_.push_back({std::move(text), std::string(key)});
  wake_if_idle();
}

bool Viewer::may_send_frame() const {
  const int most = window_ + more_;
  return newest_ && before_frame_ == 0 &&
         (window_ == 0 || outstanding_.size() < static_cast<std::size_t>(most));
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
