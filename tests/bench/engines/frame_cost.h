#pragma once
/// Cost of Weft's frames alone, compiled twice: with Weft as shipped, which chooses among instruction sets,
/// and with weft_cloth_portable, the same kernels for any x86-64 processor, whose namespace is weft_portable
/// (and where both declarations below are one).

namespace weft::bench {
/// Median CPU time of a frame of scene H (engine_scene.h), damped, Y = 50,000 N/m, ms.
double frame_cost(const char* integrator, int level);
}  // namespace weft::bench

namespace weft_portable::bench {
double frame_cost(const char* integrator, int level);
}  // namespace weft_portable::bench
