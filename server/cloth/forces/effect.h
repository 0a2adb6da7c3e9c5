#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "cloth/air/gust_series.h"
#include "cloth/core/effect_description.h"
#include "cloth/core/particles.h"
#include "cloth/kernels/link_kernels.h"
#include "cloth/sheet/cloth_description.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// What an effect may read beside the particles.
struct EffectContext {
  const ClothDescription* cloth = nullptr;
  const Wind* wind = nullptr;
  double time = 0;  ///< s
  /// Largest damping rate, 1/s, that the substep bears. A force that grows with speed faster than it did when
  /// the substeps were chosen (a fast ball strikes) is held to it. Infinite for methods that bear any.
  double damping_limit = std::numeric_limits<double>::infinity();
  /// The faces that air can press on, if some are torn; null while the cloth is whole.
  const std::vector<FaceRun>* whole_faces = nullptr;
  const GustSeries* gusts = nullptr;  ///< null if the wind has none
  /// The air's velocity at the nodes during this step, m/s, gusts included; null if it is the same
  /// everywhere.
  const VectorField<float>* node_air = nullptr;
  /// Of the wind at `time`, m/s; below 0 where a gust turns it round.
  double wind_speed() const { return gusts ? wind->speed * gusts->factor(time) : wind->speed; }
  /// Not all air is still.
  bool has_wind() const { return wind->speed > 0 || node_air != nullptr; }
};

/// Calls visit(faces, first) for all faces that are not torn: those of a grid that begins at the scalar
/// `first` of the cloth's fields and has their stride.
template <class Visit>
void for_each_whole_part(const Grid& grid, const EffectContext& context, Visit visit) {
  if (context.whole_faces == nullptr) {
    visit(grid, std::size_t{0});
    return;
  }
  for (const FaceRun& run : *context.whole_faces) {
    visit(Grid{2, run.end - run.begin + 1, grid.stride}, grid.index(run.row, run.begin));
  }
}

/// -dF/dv of a cloth as the implicit methods take it, N s/m: at every node a scalar and a symmetric matrix.
template <class Real>
struct DampingMatrix {
  Real* scalar;
  kernels::Blocks<Real> blocks;  ///< null unless some effect needs_blocks()
};

/// Something a scene asks to be simulated: adds its force for a whole cloth at once, no call per particle.
template <class Real>
class Effect {
 public:
  virtual ~Effect() = default;
  virtual const char* name() const = 0;
  /// Adds this effect's force on every node, N.
  virtual void add_forces(const Particles<Real>& particles, const EffectContext& context,
                          VectorField<Real>& force) const = 0;
  /// Largest damping rate -dF/dv / m of any node, 1/s: what an explicit step must respect. 0 for forces
  /// without v.
  virtual double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const;
  /// Adds -dF/dv of every node, its couplings to other nodes lumped: never less than the true one. Nothing
  /// for forces without v.
  virtual void add_damping(const Particles<Real>& particles, const EffectContext& context,
                           const DampingMatrix<Real>& damping) const;
  /// Adds -dF/dx of every node, N/m, the same in all directions and lumped likewise. Nothing for forces
  /// without x.
  virtual void add_stiffness(const Particles<Real>& particles, const EffectContext& context,
                             Real* stiffness) const;
  /// The largest that the sheet needs to hold what it does, N/m: of a pressure p on a sheet of side L, p L.
  virtual double tension(const Particles<Real>&, const EffectContext&) const { return 0; }
  /// Whether it asks for the air's velocity at the nodes, if that differs from node to node.
  virtual bool feels_wind() const { return false; }
  /// Whether its force hardly changes from one of many substeps to the next and takes a while to find:
  /// explicit methods may give what it does in several at one blow. It damps, if anything.
  virtual bool slow() const { return false; }
  /// Whether add_damping writes blocks.
  virtual bool needs_blocks() const { return false; }
  /// Whether it may do work on the cloth, in this wind. If not it only takes energy, but for what energy()
  /// has.
  virtual bool drives(const EffectContext&) const { return true; }
  /// Whether it draws nodes to places of its own, by a stiffness.
  virtual bool holds() const { return false; }
  /// Potential energy of a force that is its gradient, J, 0 at the place of the particles; 0 for others.
  virtual double energy(const Particles<Real>&) const { return 0; }
};

extern template class Effect<float>;
extern template class Effect<double>;

/// The effects of one cloth, made once at load; an absent effect has no object here, no branch, no memory.
/// Those that belong to the sheet itself, strain_damping, strain_limit, plate_bending and tearing, are left
/// to Springs, Plate and Cloth, and so is gas that is shut in, cloth_contact to the simulation.
template <class Real>
std::vector<std::unique_ptr<Effect<Real>>> make_effects(const std::vector<EffectDescription>& descriptions);

/// As in scene files: "gravity".
const char* name_of(const EffectDescription& description);

/// The scene's gravity, m/s2: the sum of its gravity effects, zero without one. Balls fall by it too.
Vec3 total_gravity(const std::vector<EffectDescription>& descriptions);

}  // namespace weft
