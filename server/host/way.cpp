#include "host/way.h"

#include <algorithm>
#include <utility>

namespace weft::host {
namespace {

constexpr std::size_t kWaysKept = 10;
constexpr std::ptrdiff_t kWaysAtPresent = 3;

}  // namespace

void Way::answered(TimePoint now) {
  if (!asked_) return;
  late_.emplace_back(now - *std::exchange(asked_, std::nullopt));
  if (late_.size() > kWaysKept) late_.pop_front();
}

Way::Seconds Way::shortest() const {
  return late_.empty() ? Seconds(0) : *std::min_element(late_.begin(), late_.end());
}

Way::Seconds Way::at_present(TimePoint now) const {
  Seconds longest = asked_ ? Seconds(now - *asked_) : Seconds(0);
  const auto first = late_.end() - std::min(kWaysAtPresent, std::ssize(late_));
  for (auto each = first; each != late_.end(); ++each) longest = std::max(longest, *each);
  return longest;
}

}  // namespace weft::host
