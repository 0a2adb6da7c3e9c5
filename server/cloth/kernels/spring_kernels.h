#pragma once
#include <span>

#include "cloth/kernels/components.h"
#include "cloth/spring_family.h"

namespace weft::kernels {

/// Adds Eq. 1's force of every spring of every family to both its ends, N. Positions and forces lie on
/// `grid`.
void add_spring_forces(std::span<const SpringFamily> families, const Grid& grid,
                       Components<const float> position, Components<float> force);
void add_spring_forces(std::span<const SpringFamily> families, const Grid& grid,
                       Components<const double> position, Components<double> force);

}  // namespace weft::kernels
