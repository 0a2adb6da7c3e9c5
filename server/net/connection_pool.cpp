#include "net/connection_pool.h"

#include <utility>

namespace weft::net {

ConnectionPool::Place::Place(ConnectionPool& pool, std::string address, NoPlace refusal)
    : pool_(refusal == NoPlace::none ? &pool : nullptr), address_(std::move(address)), refusal_(refusal) {}

ConnectionPool::Place::Place(Place&& other) noexcept
    : pool_(std::exchange(other.pool_, nullptr)),
      address_(std::move(other.address_)),
      refusal_(other.refusal_) {}

ConnectionPool::Place::~Place() {
  if (pool_) pool_->give_back(address_);
}

std::size_t ConnectionPool::taken() const {
  const std::lock_guard lock(mutex_);
  return taken_;
}

void ConnectionPool::give_back(const std::string& address) {
  const std::lock_guard lock(mutex_);
  --taken_;
  const auto from = by_address_.find(address);
  if (--from->second == 0) by_address_.erase(from);
}

ConnectionPool::Place ConnectionPool::take(std::string address) {
  const std::lock_guard lock(mutex_);
  if (taken_ >= max_) return {*this, std::move(address), NoPlace::all_taken};
  const auto from = by_address_.try_emplace(address, 0).first;
  if (max_per_address_ > 0 && from->second >= max_per_address_)
    return {*this, std::move(address), NoPlace::taken_by_address};
  ++taken_;
  ++from->second;
  return {*this, std::move(address), NoPlace::none};
}

}  // namespace weft::net
