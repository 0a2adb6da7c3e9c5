#pragma once
#include "host/viewer.h"

namespace weft::host {

/// Keeps what one viewer is sent to what its link carries: frames that find no room are left out; where too
/// few are left, all cloths are sent at a coarser level; and finer again when the link carries all frames.
/// Pure: it knows no clock; the caller tells it what became of the frames of each half second or so.
class LinkKeeper {
 public:
  /// What keeps frames from the viewer.
  enum class Limit { nothing, link, client };
  /// Stretches with fewer frames than these, of which some were left out, say nothing. While a scene sleeps
  /// hardly any are made, and all of them arrive: then the link has room.
  static constexpr int kLeastFrames = 8;
  /// Of the frames made, left out without that being a limit: a few are when a garbage collector runs.
  static constexpr double kFewLeftOut = 0.1;
  /// With a smaller share of frames than this a coarser level is seen better: 15 a second of 60.
  static constexpr double kFewest = 0.25;
  /// Stretches in a row with too few frames before the level becomes coarser.
  static constexpr int kSettling = 2;
  /// Stretches in a row without a limit before a finer level is tried. Doubled each time that proves too
  /// much, up to kMostPatience, so that two levels are not swapped for ever.
  static constexpr int kPatience = 6;
  static constexpr int kMostPatience = 64 * kPatience;

  /// What became of the frames since the last call; `most`: levels that what is sent may be coarser by.
  void passed(const Viewer::Flow& flow, int most);
  Limit limit() const { return limit_; }
  /// By so many levels what is sent is coarser than the viewer's distance asks for.
  int coarser() const { return coarser_; }

 private:
  void change(int by);

  Limit limit_ = Limit::nothing;
  int coarser_ = 0;
  int poor_ = 0, good_ = 0;  ///< stretches in a row with too few frames, and without a limit
  int since_ = 0;            ///< stretches since the last change
  int patience_ = kPatience;
  bool tried_ = false;  ///< the last change was to a finer level
};

}  // namespace weft::host
