#include <spdlog/spdlog.h>

#include "host/host.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

/// So small that a scene within them is tried in milliseconds.
host::MakingLimits small() {
  host::MakingLimits limits;
  limits.scenes = 1;
  limits.nodes = 300;
  limits.colliders = 4;
  limits.work = 2e5;
  return limits;
}

}  // namespace

// A scene is made, its first step tried, or what is wrong with it is told.
void scenes(Input input) {
  static host::Host host({}, "", small());
  spdlog::set_level(spdlog::level::off);
  if (const auto no = host.make("made", text_of(input))) {
    require(!no->text.empty(), "a refusal says why");
    require((no->why == host::NotMade::Why::problems) != no->problems.empty(),
            "a scene with problems has some");
    for (const scene::Problem& problem : no->problems)
      require(!problem.message.empty(), "a problem has a message");
    return;
  }
  require(host.end("made") == host::Host::Ending::ended, "a scene that was made can be ended");
}

}  // namespace weft::fuzz
