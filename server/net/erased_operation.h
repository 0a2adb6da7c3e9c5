#pragma once
/// What the operations of a connection take, as one type each. The layers above have hundreds of types of
/// handlers and buffers, and would compile a socket's and a TLS stream's operations anew for each.
#include <memory>
#include <type_traits>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/container/static_vector.hpp>

namespace weft::net {

/// A completion handler of any type. It is called once, on the operation's executor: its own is not asked
/// for.
class AnyHandler {
 public:
  using error_code = boost::beast::error_code;

  /// handler(error_code, std::size_t) or handler(error_code); may be movable only.
  template <class Handler>
  requires(!std::is_same_v<Handler, AnyHandler>)
      AnyHandler(Handler handler)  // NOLINT(google-explicit-constructor): given as a handler
      : handler_(std::make_unique<Of<Handler>>(std::move(handler))) {}

  void operator()(error_code error, std::size_t count = 0) {
    Base& handler = *handler_;
    handler.call(std::move(handler_), error, count);
  }

 private:
  struct Base {
    virtual ~Base() = default;
    /// Frees itself first, so that what the handler begins finds that memory free.
    virtual void call(std::unique_ptr<Base> self, error_code error, std::size_t count) = 0;
  };
  template <class Handler>
  struct Of final : Base {
    explicit Of(Handler given) : handler(std::move(given)) {}
    void call(std::unique_ptr<Base> self, error_code error, std::size_t count) override {
      Handler mine(std::move(handler));
      self.reset();
      if constexpr (std::is_invocable_v<Handler, error_code, std::size_t>)
        mine(error, count);
      else
        mine(error);
    }
    Handler handler;
  };

  std::unique_ptr<Base> handler_;
};

/// The first buffers of a sequence that are not empty, as many as one call to the system takes well.
template <class Buffer>
class BufferList : public boost::container::static_vector<Buffer, 16> {
 public:
  template <class Buffers>
  static BufferList of(const Buffers& buffers) {
    BufferList list;
    const auto end = boost::asio::buffer_sequence_end(buffers);
    for (auto it = boost::asio::buffer_sequence_begin(buffers); it != end && list.size() < list.capacity();
         ++it) {
      const Buffer buffer(*it);
      if (buffer.size() > 0) list.push_back(buffer);
    }
    return list;
  }
};

}  // namespace weft::net
