#pragma once
#include "cloth/core/grid.h"
#include "cloth/kernels/components.h"
#include "cloth/kernels/uniform.h"

/// The paper's wind: what pushes nodes, whatever the area that it meets. Air is the wind: Uniform, or
/// Components<const float> of every node.
namespace weft::kernels {

/// Strength of the paper's wind on a node, N, where it blows at unit speed: per_node + per_mass * mass.
template <class Real>
struct Push {
  Real per_node;
  Real per_mass;
};

/// force += push * wind on every node.
template <class Real, class Air>
void add_push(const Grid& grid, const Real* mass, const Push<Real>& push, const Air& wind,
              Components<Real> force);

/// force += push |wind| N, N the unit normal of the surface at the node (from its four neighbours, fewer on
/// the border), turned towards the wind; nothing where the neighbours span no surface. A Uniform wind must
/// be of unit length.
template <class Real, class Air>
void add_push_along_normals(const Grid& grid, Components<const Real> position, const Real* mass,
                            const Push<Real>& push, const Air& wind, Components<Real> force);

}  // namespace weft::kernels
