#pragma once
#include "cloth/kernels/components.h"
#include "cloth/kernels/link_kernels.h"

namespace weft::kernels {

/// A vector that is the same everywhere: the air's velocity, the wind's direction.
template <class Real>
struct Uniform {
  Real x, y, z;
};

/// Flat-plate pressure on every face (cell), a quarter of it on each corner: F = factor |w.A| (w.A) A / |A|^2
/// with A the face's area vector, half the cross product of its diagonals, and w the air's velocity relative
/// to the mean of the corners'. factor = 1/2 rho C. The first |w.A| counts no more than `most_flow`, m3/s:
/// the force then grows with speed no longer by its square.
void add_air_pressure(const Grid& grid, Components<const float> position, Components<const float> velocity,
                      const Uniform<float>& air, float factor, float most_flow, Components<float> force);
void add_air_pressure(const Grid& grid, Components<const double> position, Components<const double> velocity,
                      const Uniform<double>& air, double factor, double most_flow, Components<double> force);

/// Adds -dF/dv of add_air_pressure (without a limit to the flow) to every node's matrix, N s/m: of each face
/// 2 factor |w.A| n n^T, a quarter to each corner as if only that corner moved the face's air.
void add_air_damping(const Grid& grid, Components<const float> position, Components<const float> velocity,
                     const Uniform<float>& air, float factor, const Blocks<float>& damping);
void add_air_damping(const Grid& grid, Components<const double> position, Components<const double> velocity,
                     const Uniform<double>& air, double factor, const Blocks<double>& damping);

/// Largest |w.A| of any face, m3/s.
float max_air_flow(const Grid& grid, Components<const float> position, Components<const float> velocity,
                   const Uniform<float>& air);
double max_air_flow(const Grid& grid, Components<const double> position, Components<const double> velocity,
                    const Uniform<double>& air);

/// Strength of the paper's wind on a node, N: per_node + per_mass * mass.
template <class Real>
struct Push {
  Real per_node;
  Real per_mass;
};

/// force += push * direction on every node.
void add_push(const Grid& grid, const float* mass, const Push<float>& push, const Uniform<float>& direction,
              Components<float> force);
void add_push(const Grid& grid, const double* mass, const Push<double>& push,
              const Uniform<double>& direction, Components<double> force);

/// force += push * N, N the unit normal of the surface at the node (from its four neighbours, fewer on the
/// border), turned towards `direction`; nothing where the neighbours span no surface.
void add_push_along_normals(const Grid& grid, Components<const float> position, const float* mass,
                            const Push<float>& push, const Uniform<float>& direction,
                            Components<float> force);
void add_push_along_normals(const Grid& grid, Components<const double> position, const double* mass,
                            const Push<double>& push, const Uniform<double>& direction,
                            Components<double> force);

}  // namespace weft::kernels
