#pragma once
/// What waits to be sent to one viewer: its control messages in order, and its newest frame.
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/way.h"
#include "protocol/frame.h"

namespace weft::host {

/// The bytes of one record, encoded once and shared by all viewers it is sent to.
using Record = std::shared_ptr<const std::vector<std::uint8_t>>;

/// One binary message: its records one after the other.
struct FrameMessage {
  std::uint32_t frame = 0;
  std::uint32_t epoch = 0;
  std::vector<Record> records;
};

/// A control message; one for all may be shared by all.
using Text = std::shared_ptr<const std::string>;
inline Text make_text(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

/// The next message for a viewer: exactly one of the two.
struct Outgoing {
  Text text;
  std::shared_ptr<const FrameMessage> frame;
};

/// A viewer's outbox. The scene's thread fills it, the network's empties it; every method may be called from
/// any thread.
class Viewer {
 public:
  /// Control messages without a key that may wait; the viewer does not read when there are more.
  static constexpr std::size_t kMaxTexts = 256;

  /// `wake` is called, on the filling thread, when there is something to send after take() returned nothing,
  /// and when the outbox overflows. Set it before the first take(). It must not use the viewer. When
  /// on_wake(nullptr) has returned, it is not called any more and no call is under way.
  void on_wake(std::function<void()> wake);
  using TimePoint = Way::TimePoint;
  using Seconds = Way::Seconds;

  /// The next message. Control messages keep their order. A frame is taken only while fewer than window() are
  /// unacknowledged, and never before a control message without a key that was sent before the frame was
  /// published; where both a control message and a frame may be taken they take turns.
  std::optional<Outgoing> take(TimePoint now = std::chrono::steady_clock::now());
  /// More than kMaxTexts waited; what came after them is lost, so the viewer must be closed.
  bool overflowed() const;

  /// A control message, whichever scene the viewer is in.
  void send(Text text);
  /// A control message of the scene entered as `visit`; dropped when the viewer has left it. One with a key
  /// takes the place of one with the same key that still waits, at the end of the line: whatever a slow
  /// viewer is told so, no more waits for it than there are keys.
  void send(std::uint64_t visit, Text text, std::string_view key = {});
  /// The newest frame of that scene, in place of one that still waits.
  void publish(std::uint64_t visit, std::shared_ptr<const FrameMessage> frame);

  /// A command of the viewer's waits for its scene; its reply has been sent, if it has one.
  void command_given();
  void command_answered();
  /// No command waits.
  bool all_answered() const;

  /// Begins a stay in a scene and names it: nothing of the scene before is sent any more, nor awaits an
  /// acknowledgement.
  std::uint64_t enter();
  /// Capability flow.ack: `window` frames may be unacknowledged from now on, and as many more as the way
  /// there and back has room for (Way::shortest).
  void enable_acks(int window);
  /// The frame and those sent before it have been consumed. False if no such frame was outstanding. One that
  /// comes much later than the way takes tells that frames queue: on the way, or at a viewer that is slow.
  bool acknowledge(std::uint32_t frame, TimePoint now = std::chrono::steady_clock::now());
  /// A ping of the WebSocket is to be sent now: false while one waits for its answer.
  bool ping(TimePoint now = std::chrono::steady_clock::now());
  /// Its answer has come.
  void pong(TimePoint now = std::chrono::steady_clock::now());
  /// Frames that may be unacknowledged now.
  int window() const;
  /// Frames replaced by newer ones before they could be sent.
  std::uint64_t dropped() const;
  /// Capability flow.level: what is sent may be coarser where the link carries too little.
  void enable_levels();
  bool takes_coarser() const;
  /// Capability grid.rice: it reads the smaller coding of grids.
  void enable_rice();
  protocol::GridCoding grid_coding() const;
  /// What became of frames.
  struct Flow {
    int published = 0, dropped = 0;
    /// Acknowledgements come much later than pings: frames wait at the viewer, not on the way to it.
    bool at_client = false;
  };
  /// Since the last call.
  Flow flow(TimePoint now = std::chrono::steady_clock::now());

 private:
  // These need mutex_.
  void push(Text text, std::string_view key);
  bool may_send_frame() const;
  void wake_if_idle();
  void wake_now();

  mutable std::mutex mutex_;
  std::function<void()> wake_;
  bool idle_ = false;  ///< take() found nothing and nobody was woken since
  bool overflowed_ = false;
  struct Waiting {
    Text text;
    std::string key;
  };
  std::deque<Waiting> texts_;
  std::size_t unkeyed_ = 0;       ///< of texts_, those without a key
  std::size_t before_frame_ = 0;  ///< of these, those sent before newest_ was published
  bool frame_was_last_ = false;   ///< what was taken last
  std::shared_ptr<const FrameMessage> newest_;
  int unanswered_ = 0;  ///< commands
  std::uint64_t visit_ = 0;
  std::uint64_t dropped_ = 0;
  struct Sent {
    std::uint32_t frame;
    TimePoint when;
  };
  int window_ = 0;       ///< 0: without flow.ack
  int more_ = 0;         ///< frames that may be on the way beside those
  bool levels_ = false;  ///< flow.level
  protocol::GridCoding grid_coding_ = protocol::GridCoding::plain;
  Way way_;
  Seconds taken_{};  ///< from sending a frame to its acknowledgement, smoothed
  Flow flow_;        ///< since the last flow()
  std::deque<Sent> outstanding_;
};

}  // namespace weft::host
