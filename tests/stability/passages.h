#pragma once
/// Whether anything passes through anything.
#include "case.h"

namespace weft::stability {

/// Nodes that pass through a solid in a step, as seen from the solid: their straight way enters it, and they
/// end in its shadow and behind the tangent plane where they met it in their flight. What is struck stays on
/// that plane's side, be it stopped, carried along or deflected, unless it is drawn round: from when they
/// meet until the step's end, t, the springs of a node of mass m are stretched by no more than s, the
/// farthest that any node goes and the solid, so that they pull with no more than K s beyond what they did
/// when the step began, F. With gravity that gets it behind the plane by ((F + K s) / m + g) t^2 at most, in
/// a step of backward Euler; what is farther behind it has passed. So has, whatever springs may do, what went
/// half as deep as the solid is thick and ends within a quarter of its radius of where its flight alone would
/// have taken it.
Watch nothing_passes(const Setup& setup);

}  // namespace weft::stability
