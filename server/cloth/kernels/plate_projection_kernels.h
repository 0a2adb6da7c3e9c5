#pragma once
#include "cloth/kernels/plate_kernels.h"
#include "cloth/kernels/xpbd_kernels.h"

namespace weft::kernels {

/// Scalars that a plate's stiffnesses take in XPBD's layout.
std::size_t plate_lanes_size(const QuarterRows& layout);

/// Lays out the plate's stiffnesses for substeps of h seconds, times h^2, in kg. Lanes without a node must be
/// zero.
void set_plate_lanes(const QuarterRows& layout, const Grid& grid, const PlateStencils<float>& plate,
                     float h_squared, float* lanes);
void set_plate_lanes(const QuarterRows& layout, const Grid& grid, const PlateStencils<double>& plate,
                     double h_squared, double* lanes);

/// One sweep over the plate's stencils. Each is a constraint C = sum a_i r_i = 0 of compliance 1/k in the
/// three components, projected once from a multiplier of zero: node i moves by
/// -w_i a_i C / (sum w_j a_j^2 + 1 / (k h^2)). No two stencils of a colour share a node.
void project_plate(const QuarterRows& layout, const float* plate_lanes, float* sheet);
void project_plate(const QuarterRows& layout, const double* plate_lanes, double* sheet);

}  // namespace weft::kernels
