#pragma once
/// Many viewers of one server at once, from one thread: what they are served, and how old it is.
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "net/client.h"

namespace weft::net {

struct LoadPlan {
  int viewers = 100;
  double rate = 60;  ///< frames a second that a viewer takes, at most
  /// Shares of the viewers at these distances, together 1.
  std::array<double, 3> mix{0.1, 0.3, 0.6};
  std::array<double, 3> distances{0.8, 5, 12};  ///< m
  double slow = 0;                              ///< share that takes a frame a second only
  double seconds = 10;                          ///< of measuring, after all have joined
};

/// Lets this process have as many connections as it may ask for; how many those are.
std::size_t make_room_for_connections();

/// Of the frames that came while it was measured.
struct LoadResult {
  int joined = 0;                     ///< viewers
  double joining = 0;                 ///< s until they had
  std::vector<std::string> failures;  ///< why the others did not, or left
  double seconds = 0;
  std::uint64_t frames = 0, bytes = 0;
  /// Since the server sent a frame until it was here whole, ms, in ascending order: of viewers that are not
  /// slow.
  std::vector<double> ages;
  double fewest = 0, most = 0;  ///< frames a second of a viewer that is not slow
  double own_cpu = 0;           ///< s of this process' processor time

  /// The age that so many of a hundred frames have at most; 0 if there are none.
  double age(double percent) const;
};

/// Connects all viewers to the scene, calls `joined`, measures, and lets them go. Throws ConnectionError if
/// not one joins, or `security` cannot be used.
LoadResult load(const Url& url, const LoadPlan& plan, const ClientSecurity& security,
                const std::function<void()>& joined);

}  // namespace weft::net
