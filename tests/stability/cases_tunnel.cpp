// Nothing passes through anything, however fast: S52 a soft sheet in the way of a fast ball, S53 sheets
// thrown, S54 sheets yanked against what stands in the way.
#include <algorithm>
#include <numbers>

#include "criteria.h"
#include "passages.h"

namespace weft::stability {
namespace {

constexpr double kHalf = 0.2;  ///< m, of what stands in the way

/// As wide as a ball of kHalf is.
void stand_ball(SimulationDescription& made) { made.balls = {ball({0, 0, 0}, kHalf, 0.3)}; }
void stand_box(SimulationDescription& made) {
  const Quaternion turned(Eigen::AngleAxisd(0.6, Vec3(1, 2, 0.5).normalized()));
  made.obstacles = {{.shape = BoxDescription{{2 * kHalf, 2 * kHalf, 0.1}, turned}, .friction = 0.3}};
}
void stand_capsule(SimulationDescription& made) {
  const Quaternion across(Eigen::AngleAxisd(1.3, Vec3::UnitZ()));
  made.obstacles = {{.shape = CapsuleDescription{0.05, 4 * kHalf, across}, .friction = 0.3}};
}
void stand_floor(SimulationDescription& made) {
  made.obstacles = {{.shape = PlaneDescription{Vec3::UnitZ()}, .friction = 0.3}};
}

/// So soft and heavy that in a step no spring can draw a node round anything (passages.h), and all nodes go
/// on as they are struck.
void soften(Material& material) {
  material.density = 10;
  material.structural = 0.1;
  material.shear = material.bending = 0;
}

/// J: those of a sheet's nodes that something `wide`, m, strikes are stopped, or carried on, for a step
/// before their neighbours follow, by their springs' cost.
double work_of_blow(const ClothDescription& cloth, const Setup& setup, double speed, double wide) {
  const double cell = kSize / (1 << setup.level), way = speed * setup.time_step();
  const double struck = std::max(1.0, std::min(wide * wide, kSize * kSize) / (cell * cell));
  const double stiffness =
      4 * (cloth.material.structural.most() + cloth.material.shear + cloth.material.bending);
  return struck * stiffness * way * way / 2;
}

Case shot_at_soft(std::string name, std::string what, double speed) {
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {});
    soften(made.cloths[0].material);
    BallDescription fast = ball({0.01, 0.02, 1}, 0.1, 0);
    fast.velocity = {0, 0, -speed};
    made.balls = {fast};
    return made;
  };
  Case made{std::move(name), std::move(what), {{0.5, scene}}};
  made.watch = nothing_passes;
  made.expect = [=](const Setup& setup) {
    const ClothDescription sheet = scene(setup).cloths[0];
    Expectation expect;
    // What is struck flies off at twice the ball's speed at most.
    expect.input = mass_of(sheet) * 4 * speed * speed / 2 + work_of_blow(sheet, setup, speed, 0.2);
    expect.stretch_from = 1;  // never: it is torn apart
    expect.rests = false;
    return expect;
  };
  return made;
}

Case thrown(std::string name, std::string what, double speed, bool soft,
            void (*stand)(SimulationDescription&)) {
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {});
    ClothDescription& cloth = made.cloths[0];
    if (soft) soften(cloth.material);
    cloth.position = {0.03, 0.02, 1};
    cloth.velocity = {0, 0, -speed};
    stand(made);
    return made;
  };
  Case made{std::move(name), std::move(what), {{1, scene}}};
  made.watch = nothing_passes;
  made.expect = [=](const Setup& setup) {
    const ClothDescription sheet = scene(setup).cloths[0];
    Expectation expect;
    expect.input = work_of_blow(sheet, setup, speed, stand == stand_floor ? kSize : 4 * kHalf);
    expect.stretch_from = 1.5;  // never: it flies off at what is left of its speed
    expect.rests = false;
    return expect;
  };
  return made;
}

/// Its upper edge is drawn through what stands in front of its middle, 10 m far and back. Cells are drawn to
/// several times their width: what is `thin` may pierce one.
Case yanked_against(std::string name, std::string what, void (*stand)(SimulationDescription&), bool thin) {
  constexpr double kStart = 0.1, kPull = 0.2, kSpeed = 50, kFar = kSpeed * kPull;
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
    made.cloths[0].position = {0.03, 0.02, 0.4};
    made.cloths[0].pins[0].path = {
        {kStart, {0, 0, 0}}, {kStart + kPull, {0, 0, -kFar}}, {kStart + 2 * kPull, {0, 0, 0}}};
    stand(made);
    return made;
  };
  Case made{std::move(name), std::move(what), {{3, scene}}};
  made.watch = nothing_passes;
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    const double strain = kFar / kSize;
    Expectation expect;
    // As S7's.
    expect.input = hung.cloths[0].material.structural.most() * strain * strain / 2 * kSize * kSize +
                   mass_of(hung.cloths[0]) * kSpeed * kSpeed / 2;
    expect.stretch = 0.1 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity);
    expect.stretch_from = kStart + 2 * kPull + 2;
    expect.may_be_pierced = thin;
    expect.rests = false;
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> tunnel_cases() {
  return {
      shot_at_soft("S52a",
                   "ball of 0.1 m at 100 m/s through grains hardly joined: each struck one is carried off",
                   100),
      shot_at_soft("S52b", "the same at 200 m/s", 200),
      thrown("S53a", "sheet thrown at 100 m/s at a ball: no node passes", 100, false, stand_ball),
      thrown("S53b", "sheet thrown at 100 m/s at a turned box", 100, false, stand_box),
      thrown("S53c", "sheet thrown at 100 m/s at a rail of 10 cm", 100, false, stand_capsule),
      thrown("S53d", "sheet thrown at 200 m/s at a wall", 200, false, stand_floor),
      thrown("S53e", "grains hardly joined thrown at 200 m/s at a ball: no node passes", 200, true,
             stand_ball),
      thrown("S53f", "grains hardly joined thrown at 200 m/s at a turned box", 200, true, stand_box),
      thrown("S53g", "grains hardly joined thrown at 200 m/s at a rail of 10 cm", 200, true, stand_capsule),
      yanked_against("S54a", "edge yanked at 50 m/s past a ball and back: no node passes", stand_ball, false),
      yanked_against("S54b", "the same past a turned box", stand_box, true),
      yanked_against("S54c", "the same past a rail of 10 cm", stand_capsule, true),
  };
}

}  // namespace weft::stability
