#include "cloth/guard/guard_event.h"

#include <cstdio>

#include "cloth/shapes/solid.h"

namespace weft {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string what_was_wrong(const GuardEvent& event) {
  const std::string limit = " (at most " + number(event.limit) + ")";
  switch (event.fault) {
    case Fault::not_finite:
      return "a position or velocity that is not finite";
    case Fault::too_fast:
      return "a speed of " + number(event.value) + " m/s" + limit;
    case Fault::too_stretched:
      return "a strain of " + number(event.value) + limit;
    case Fault::gained:
      return number(event.value) + " J more than before (at most " + number(event.limit) +
             " J could come from what it met)";
    case Fault::unsolved:
      return "no solution";
    case Fault::too_costly:
      return "more work than a step may take";
    case Fault::crowded:
      return "more contacts in one place than are held";
    case Fault::none:
      break;
  }
  return "nothing wrong";
}

const char* name_of(Rung rung) {
  switch (rung) {
    case Rung::substeps_4:
      return "with 4 times the substeps";
    case Rung::substeps_16:
      return "with 16 times the substeps";
    case Rung::backward_euler_4:
      return "by backward Euler with 4 substeps";
    case Rung::backward_euler_16:
      return "by backward Euler with 16 substeps";
    case Rung::own:
      break;
  }
  return "its own way";
}

}  // namespace

std::string describe(const GuardEvent& event, const std::string& cloth) {
  const std::string gave = ": step " + std::to_string(event.step) + " gave " + what_was_wrong(event);
  switch (event.action) {
    case GuardEvent::Action::redone:
      return cloth + gave + ": made again " + name_of(event.rung);
    case GuardEvent::Action::frozen:
      if (event.fault == Fault::too_costly)
        return cloth + gave + ": it stands still and is tried again from time to time";
      return cloth + gave + ", smaller steps too: it stands still and is tried again from time to time";
    case GuardEvent::Action::thawed:
      return cloth + ": moves again from step " + std::to_string(event.step) + " on, " + name_of(event.rung);
    case GuardEvent::Action::let_through:
      return cloth + gave + ": those beyond are not felt, and cloth may pass through cloth there";
    case GuardEvent::Action::ball_stopped:
      break;
  }
  const std::string name = event.ball < kFirstObstacle
                               ? "ball " + std::to_string(event.ball)
                               : "obstacle " + std::to_string(event.ball - kFirstObstacle);
  return name + gave + ": put back to its last good place, at rest";
}

}  // namespace weft
