#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cloth/core/grid.h"
#include "cloth/core/path.h"
#include "cloth/core/vec3.h"
#include "cloth/sheet/material.h"

namespace weft {

/// Nodes held where they are: all with u, v inside the closed rectangle, or the nearest one if there is none.
/// (0, 0) is the top left corner, (1, 1) the bottom right one.
struct PinRegion {
  double u_min = 0, u_max = 0, v_min = 0, v_max = 0;  ///< in [0, 1]
  std::vector<Waypoint> path = {};  ///< how far they are from where they start, if they are moved
  bool loop = false;  ///< the path or the motion begins anew when it ends; it then ends where it begins
  /// They go with this one of the simulation's obstacles, counted from 0, as if fixed to it; no path then.
  std::optional<int> obstacle = {};
  /// The same of one of the simulation's balls. Pins on what may fly have a stiffness: it feels their pull.
  std::optional<int> ball = {};
  /// They go with what takes these poses, in the world, as if fixed to it; no path and no obstacle then.
  std::vector<PoseWaypoint> motion = {};
  /// When it begins and ends to hold, s: it takes the nodes where they are then, and lets go of them at rest.
  double from = 0, until = std::numeric_limits<double>::infinity();
  /// A spring of this draws the nodes to where they would be held, N/m, of all of them together; > 0.
  std::optional<double> stiffness = {};
};

/// What becomes of a cloth that no viewer sees. Like LevelPolicy it is for whoever shows a simulation: the
/// simulation itself knows no viewers.
struct Relevance {
  enum class Unseen {
    step,    ///< stepped as if it were seen
    coarse,  ///< stepped at its lowest level: what is finer is lost, and grows anew when it is seen again
    sleep,   ///< its steps are left out, unless something moves it (Simulation::set_resting)
  };
  Unseen unseen = Unseen::step;
  double far = std::numeric_limits<double>::infinity();  ///< from where on it is too far to be seen, m
};

struct ClothDescription {
  std::string name = "cloth";
  Vec2 size{2.0, 2.0};  ///< width (along u) and height (along v), m; > 0
  BaseCells base_cells;
  /// The cloth lies in its local x-y plane, centred, u along +x, v along -y (it hangs), face normal +z.
  Vec3 position{0.0, 0.0, 0.0};                     ///< of the centre, m
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  std::vector<Vec3> nodes;  ///< start positions in the world at initial_level, row by row; empty: the flat
                            ///< sheet. Rest lengths always come from `size`.
  Vec3 velocity{0.0, 0.0, 0.0};  ///< of every free node at the start, m/s
  double perturbation =
      0.0;  ///< random offset of each free node along the sheet's local z at the start, up to this, m
  int min_level = 4, max_level = 6, initial_level = 6;
  Material material;
  Discretization discretization = Discretization::continuum;
  /// A bag: folded over along u = 1/2, its back inside, and sewn together along its open rims (seam.h). It
  /// begins so, hardly open, its flat half as wide.
  bool sewn = false;
  std::vector<PinRegion> pins;
  Relevance relevance;
};

}  // namespace weft
