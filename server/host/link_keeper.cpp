#include "host/link_keeper.h"

#include <algorithm>

namespace weft::host {

void LinkKeeper::passed(const Viewer::Flow& flow, int most) {
  coarser_ = std::min(coarser_, most);
  const bool few = flow.published < kLeastFrames;
  if (few && flow.dropped > 0) {
    limit_ = Limit::nothing;
    return;
  }
  const double left_out = few ? 0 : double(flow.dropped) / flow.published;
  limit_ = left_out <= kFewLeftOut ? Limit::nothing : flow.at_client ? Limit::client : Limit::link;
  ++since_;
  good_ = limit_ == Limit::link ? 0 : good_ + 1;
  poor_ = limit_ == Limit::link && 1 - left_out < kFewest ? poor_ + 1 : 0;
  if (poor_ >= kSettling && coarser_ < most) {
    const bool in_vain = tried_ && since_ < patience_;
    patience_ = in_vain ? std::min(2 * patience_, kMostPatience) : kPatience;
    change(1);
  } else if (coarser_ > 0 && good_ >= patience_) {
    change(-1);
  }
}

void LinkKeeper::change(int by) {
  coarser_ += by;
  tried_ = by < 0;
  poor_ = good_ = since_ = 0;
}

}  // namespace weft::host
