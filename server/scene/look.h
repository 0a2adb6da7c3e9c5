#pragma once
/// What a cloth looks like: told to viewers, never to the simulation.
#include <optional>
#include <string>
#include <string_view>

namespace weft::scene {

/// Bands of another colour that run down the cloth.
struct Stripe {
  std::string colour;   ///< "#rrggbb", sRGB
  double width = 0;     ///< of all bands of one stripe and the gaps between them, m
  double spacing = 0;   ///< from one stripe to the next, m
  int bands = 1;        ///< a stripe is so many, as wide as the gaps between them
  bool across = false;  ///< across the cloth, too: checks
  bool operator==(const Stripe&) const = default;
};

struct Look {
  std::string_view weave = "plain";  ///< one of read_look's
  std::string colour;  ///< of the threads that run down the cloth, or of all of it; "#rrggbb", sRGB
  std::string weft;    ///< of the threads that run across it
  std::string back;    ///< of the other side; empty: as the weave gives it
  double thread = 0;   ///< width of a thread, a stitch or a grain, m
  std::optional<Stripe> stripe;
  bool operator==(const Look&) const = default;
};

}  // namespace weft::scene
