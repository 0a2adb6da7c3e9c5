#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "protocol/message.h"

namespace weft::host {

/// A scene's events until its viewers are told, together with the next frame. Each event has the whole state
/// of its subject, so of one kind and subject the newest is enough: however many commands change a thing
/// between two frames, viewers are told once. Used by the scene's thread alone.
class EventQueue {
 public:
  /// The event's members beside `kind` and `f`: made when the event is told, of the state as it is then.
  using Members = std::function<nlohmann::json()>;

  /// `subject` tells apart the things of one kind, where there are several: a cloth's number, an effect's
  /// name. Takes effect in step `frame`.
  void add(const std::string& kind, const std::string& subject, std::uint64_t frame, Members members) {
    const std::string key = kind + ' ' + subject;
    std::erase_if(events_, [&](const Event& event) { return event.key == key; });
    events_.push_back({key, kind, frame, std::move(members)});
  }
  bool empty() const { return events_.empty(); }
  /// Calls tell(text, key) for each event, in the order of the newest changes, and forgets them. Events of
  /// equal keys replace each other.
  template <class Tell>
  void flush(const Tell& tell) {
    for (const Event& event : std::exchange(events_, {}))
      tell(protocol::event_text(event.kind, event.frame, event.members()), event.key);
  }

 private:
  struct Event {
    std::string key, kind;
    std::uint64_t frame;
    Members members;
  };
  std::vector<Event> events_;
};

}  // namespace weft::host
