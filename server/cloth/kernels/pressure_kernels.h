#pragma once
#include "cloth/kernels/components.h"

namespace weft::kernels {

/// Scalars of work space that add_pressure needs.
std::size_t pressure_work_size(const Grid& grid);

/// Adds p dV/dr to every node of each cell, N, V being the volume under the bilinear patch between its
/// corners: the mean of those under its two pairs of triangles. A triangle of vector area A gives p A / 3 to
/// each of its corners; A points to the sheet's face. Positions and forces lie on `grid`.
void add_pressure(const Grid& grid, Components<const float> position, float pressure, Components<float> force,
                  float* work);
void add_pressure(const Grid& grid, Components<const double> position, double pressure,
                  Components<double> force, double* work);

}  // namespace weft::kernels
