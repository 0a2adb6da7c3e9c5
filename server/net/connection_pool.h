#pragma once
/// How many connections there are, and from where. Any thread may use it.
#include <cstddef>
#include <map>
#include <mutex>
#include <string>

namespace weft::net {

/// Why a connection gets no place.
enum class NoPlace { none, all_taken, taken_by_address };

/// The connections of one server: at most so many, of which at most so many from one address.
class ConnectionPool {
 public:
  /// A connection's place, given back when it ends. What got none is one as well, and says why.
  class Place {
   public:
    Place(Place&& other) noexcept;
    Place& operator=(Place&&) = delete;
    ~Place();
    NoPlace refusal() const { return refusal_; }

   private:
    friend class ConnectionPool;
    Place(ConnectionPool& pool, std::string address, NoPlace refusal);

    ConnectionPool* pool_;
    std::string address_;
    NoPlace refusal_;
  };

  /// `max_per_address` 0: no limit an address.
  ConnectionPool(std::size_t max, std::size_t max_per_address)
      : max_(max), max_per_address_(max_per_address) {}
  ConnectionPool(const ConnectionPool&) = delete;
  ConnectionPool& operator=(const ConnectionPool&) = delete;

  /// Connections that have one.
  std::size_t taken() const;
  /// A place for a connection from `address`, if there is one. The pool must outlive it.
  Place take(std::string address);

 private:
  void give_back(const std::string& address);

  const std::size_t max_, max_per_address_;
  mutable std::mutex mutex_;  // of what follows
  std::size_t taken_ = 0;
  std::map<std::string, std::size_t> by_address_;  ///< only those that have some
};

}  // namespace weft::net
