#pragma once
#include "cloth/contact/search/broad_phase.h"
#include "cloth/sheet/cloth_point.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// A point of a cell, between nodes, that a solid may reach.
struct NearPoint {
  PointId point;
  std::size_t solid = 0;  ///< index

  friend bool operator==(const NearPoint&, const NearPoint&) = default;
  friend bool operator<(const NearPoint& a, const NearPoint& b) {
    return a.point == b.point ? a.solid < b.solid : a.point < b.point;
  }
};

/// Which points are looked for, by what holds them.
enum class PointHold {
  free,    ///< by half or more by free nodes
  pinned,  ///< by more than half by pinned ones
};

/// Where cloth meets solids that would slip between its nodes: points of the cells' sides and insides, so
/// close that a hole between them is smaller than the solid (bore; of a body that cloth pushes its inner
/// radius, as it turns). A solid that is larger than the cells has none, and costs nothing but this to be
/// found.
///
/// The points that are near a solid on its way through `sweep`, in which nodes go `sweep.reach`, m, at most
/// from these places; of cells that are not torn, or of links of such; `torn` is nullptr while the cloth is
/// whole. `pairs` are the broad phase's. Ordered by point, then solid.
template <class Real>
std::vector<NearPoint> points_between(const Particles<Real>& particles, const VectorField<Real>& position,
                                      const std::vector<Tile>& tiles, const std::vector<TileSolidPair>& pairs,
                                      const std::vector<Solid>& solids, const Sweep& sweep,
                                      const TornLinks* torn, PointHold hold = PointHold::free);

/// How the cloth at `place`, where this point of it is or will be, leaves a solid: by the nearest way; where
/// a point between nodes is deep inside, across the sheet. Along it, it would draw the cell out around the
/// solid.
template <class Real>
Surface way_out_of(const PlacedShape& shape, const PointId& point, const Vec3& place,
                   const VectorField<Real>& position);

extern template Surface way_out_of(const PlacedShape&, const PointId&, const Vec3&,
                                   const VectorField<float>&);
extern template Surface way_out_of(const PlacedShape&, const PointId&, const Vec3&,
                                   const VectorField<double>&);
extern template std::vector<NearPoint> points_between(const Particles<float>&, const VectorField<float>&,
                                                      const std::vector<Tile>&,
                                                      const std::vector<TileSolidPair>&,
                                                      const std::vector<Solid>&, const Sweep&,
                                                      const TornLinks*, PointHold);
extern template std::vector<NearPoint> points_between(const Particles<double>&, const VectorField<double>&,
                                                      const std::vector<Tile>&,
                                                      const std::vector<TileSolidPair>&,
                                                      const std::vector<Solid>&, const Sweep&,
                                                      const TornLinks*, PointHold);

}  // namespace weft
