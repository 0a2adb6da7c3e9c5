#pragma once
/// One hard case of the stability suite: what is simulated, what happens to it, and what must hold beside the
/// criteria that all cases share (criteria.h). Cases are table entries, the files cases_*.cpp by theme.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cloth/world/simulation.h"

namespace weft::stability {

inline constexpr double kGravity = 9.81;  ///< m/s2

enum class Method {
  explicit_fixed,    ///< the paper's: Eq. 6 at one fixed step, that of the ordinary sheet at this level
  symplectic_euler,  ///< Eq. 6 with as many substeps as the stiffest spring needs
  xpbd,
  backward_euler,
  bdf2,
};
const char* name_of(Method method);

/// How a case is run.
struct Setup {
  Method method = Method::bdf2;
  int level = 4;
  int hz = 60;  ///< steps a second, each with the method's settings as shipped

  double time_step() const { return 1.0 / hz; }
};
IntegratorDescription integrator_of(const Setup& setup);

/// What is wrong, if anything is.
using Complaint = std::optional<std::string>;

/// A part of a case with a scene of its own. A second phase goes on from the state the first one left: for
/// what cannot change while a scene runs.
struct Phase {
  double seconds = 5;
  std::function<SimulationDescription(const Setup&)> scene;
};

/// The figures a case states. All are physical: what may be put in, what must have settled by when.
struct Expectation {
  double input = 0;                 ///< J, work that wind and moving bodies may do on the cloth
  double stretch = 0.05;            ///< largest extension of a structural spring, relative
  double stretch_least = 0;         ///< and what the largest is at least: with less the sheet is too stiff
  double stretch_from = 1;          ///< s, of the last phase: from then on it is held to it
  double excess = 0;                ///< beside `stretch`, what XPBD is known to leave (xpbd_excess)
  double penetration = 1e-5;        ///< m, deepest that a node may be in a solid at the end of a step
  double penetration_from = 0;      ///< s, of the case: from then on
  bool rests = true;                ///< falls asleep after it (criteria.h)
  std::optional<double> top_speed;  ///< m/s, of any node, from the first step on
  /// What is in its way is thinner than a cell may be drawn wide. Contact is the nodes': it may come through
  /// between them, and hold the sheet, which then does not claim `stretch`.
  bool may_be_pierced = false;

  /// A method whose known excess is not small beside the limit does not claim it: it is held to both
  /// together, and where it is beyond the limit the verdict says so.
  bool claims_stretch() const { return excess <= 0.1 * stretch; }
  double held_to() const { return claims_stretch() ? stretch : stretch + excess; }
};

/// Called before the first step and after every one with the time since the start, s.
using Watch = std::function<Complaint(const Simulation<float>&, double time)>;
/// Looks at the end.
using Ending = std::function<Complaint(const Simulation<float>&, const Setup&)>;

struct Case {
  std::string name;  ///< as in the list of hard cases: "S1a"
  std::string what;  ///< one line: what is hard, what is checked beside the common criteria
  std::vector<Phase> phases;
  std::vector<int> levels{4, 5, 6};
  double nightly_seconds = 0;  ///< of the last phase, in the nightly mode; 0: as in the phase
  long nightly_steps = 0;      ///< the same in steps, whatever their rate
  /// Cases that symplectic Euler does not claim, its substeps chosen for springs that are not crushed, or so
  /// many that their rounding shakes the sheet: a failure is its limit.
  bool beyond_explicit = false;
  /// Changes the state in a way a scene cannot say; before the first step.
  std::function<void(Simulation<float>&)> prepare = {};
  /// Before every step, with the time since the start, s.
  std::function<void(Simulation<float>&, double time)> drive = {};
  std::function<Watch(const Setup&)> watch = {};
  Ending ending = {};
  std::function<Expectation(const Setup&)> expect = [](const Setup&) { return Expectation{}; };
};

// --- What many cases are made from ---

inline constexpr double kSize = 2.0;  ///< m, of the square sheet most cases have
inline const PinRegion kTopEdge{0, 1, 0, 0}, kTopLeft{0, 0, 0, 0}, kTopRight{1, 1, 0, 0},
    kBottomLeft{0, 0, 1, 1}, kBottomRight{1, 1, 1, 1};

/// The sheet that is not hard: 2 m square, default material, at the setup's level, under gravity and a drag
/// of 5 /s, which is about the critical damping of its swing: after 5 s e^-12 of a swing is left.
SimulationDescription ordinary_sheet(const Setup& setup, std::vector<PinRegion> pins);
/// The same, lying in the x-z plane instead of hanging in the x-y plane, its top edge towards -z.
SimulationDescription level_sheet(const Setup& setup, std::vector<PinRegion> pins);
BallDescription ball(const Vec3& position, double radius, double friction = 0.5);

/// How much longer XPBD leaves a spring that carries `load`, N, than its stiffness says, relative, beside
/// nodes as light as a border's (xpbd.h): F h^2 (1/m_i + 1/m_j) / l. 0 for the other methods.
double xpbd_excess(const SimulationDescription& scene, const Setup& setup, double load);
/// kg
double mass_of(const ClothDescription& cloth);

// --- The table, by theme ---

std::vector<Case> material_cases();  ///< stiffness, mass, step, load: S1 to S5, S13, S22
std::vector<Case> shape_cases();     ///< hopeless shapes and shocks: S6, S7, S12, S18, S19, S21
std::vector<Case> ball_cases();      ///< S8, S10, S20, S44
std::vector<Case> level_cases();     ///< S11
std::vector<Case> long_cases();      ///< S14 to S16
std::vector<Case> mesh_cases();      ///< S41, S55
std::vector<Case> body_cases();      ///< S50
std::vector<Case> effect_cases();    ///< S42, S43, S46
std::vector<Case> contact_cases();   ///< S51
std::vector<Case> tunnel_cases();    ///< S52 to S54
std::vector<Case> driven_cases();    ///< S56 to S60
std::vector<Case> all_cases();

}  // namespace weft::stability
