#pragma once
#include "cloth/kernels/components.h"

namespace weft::kernels {

/// One wave of moving air: velocity a cos(2 pi (k.x + phase)).
struct AirWave {
  float kx, ky, kz;  ///< wave vector, turns/m
  float phase;       ///< turns
  float ax, ay, az;  ///< amplitude, m/s
};

/// velocity += the sum of the waves at each of `count` points.
void add_waves(const AirWave* waves, int wave_count, Components<const float> points, std::size_t count,
               Components<float> velocity);

/// All within `radius` of a box, where the air moves at `velocity`: fully inside, fading over an edge.
struct AirZone {
  float axes[3][3];  ///< the box's own axes in the world
  float centre[3];
  float half[3];  ///< half the lengths of the box's edges, m; 0 for a ball
  float radius;   ///< m; 0 for a box
  float one_over_edge;
  float velocity[3];
};

/// velocity += w (zone.velocity - velocity) at each of `count` points, w = 1 - 3 s^2 + 2 s^3 at a distance of
/// s edges from the zone.
void blend_zone(const AirZone& zone, Components<const float> points, std::size_t count,
                Components<float> velocity);

/// velocity += what lies between the coarse grid's values, bilinearly: node (r, c) of the coarse grid is node
/// (r rows, c cols) of the fine one. Coarse values are dense, coarse_cols a row.
void add_between(int coarse_rows, int coarse_cols, Components<const float> coarse, int rows, int cols,
                 const Grid& fine, Components<float> velocity);

}  // namespace weft::kernels
