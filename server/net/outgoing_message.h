#pragma once
/// A message as it is written to a viewer's WebSocket: its head and, without a copy, what the host shares.
#include <cstddef>
#include <utility>
#include <vector>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/buffer.hpp>

#include "host/viewer.h"
#include "net/message_head.h"

namespace weft::net {

class OutgoingMessage {
 public:
  OutgoingMessage() = default;
  OutgoingMessage(const OutgoingMessage&) = delete;  // buffers point into it
  OutgoingMessage& operator=(const OutgoingMessage&) = delete;

  void take(host::Outgoing message) {
    message_ = std::move(message);
    buffers_.assign(1, {});  // the head, when it is known
    if (message_.text) {
      buffers_.push_back(boost::asio::buffer(*message_.text));
    } else {
      for (const host::Record& record : message_.frame->records)
        buffers_.push_back(boost::asio::buffer(*record));
    }
    payload_ = boost::asio::buffer_size(buffers_);
    head_ = {is_text() ? MessageHead::Kind::text : MessageHead::Kind::binary, payload_};
    buffers_.front() = boost::asio::buffer(head_.bytes().data(), head_.bytes().size());
  }
  /// Keeps nothing of it alive; buffers() are of no use until the next.
  void clear() { message_ = {}; }

  bool is_text() const { return message_.text != nullptr; }
  /// Bytes without the head.
  std::size_t payload() const { return payload_; }
  /// All bytes, head first. Valid until the next take() or clear().
  const std::vector<boost::asio::const_buffer>& buffers() const { return buffers_; }

 private:
  host::Outgoing message_;
  MessageHead head_;
  std::size_t payload_ = 0;
  std::vector<boost::asio::const_buffer> buffers_;
};

}  // namespace weft::net
