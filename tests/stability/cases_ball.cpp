// Balls: S8 to S10, S20, S44; bodies: S45.
#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>

#include "criteria.h"
#include "passages.h"

namespace weft::stability {
namespace {

Case shot_through(std::string name, std::string what, double speed, bool pinned) {
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made =
        ordinary_sheet(setup, pinned ? std::vector<PinRegion>{kTopEdge} : std::vector<PinRegion>{});
    BallDescription fast = ball({0, 0, 1}, 0.1, 0);
    fast.velocity = {0, 0, -speed};
    made.balls = {fast};
    return made;
  };
  Case made{std::move(name), std::move(what), {{4, scene}}};
  made.watch = nothing_passes;
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    // Struck by a body that nothing slows, the sheet flies off at twice its speed at most; held, it is pulled
    // to twice its length before it slips off.
    const double mass = mass_of(hung.cloths[0]);
    expect.input = mass * 4 * speed * speed / 2 + (pinned ? 5000 * kSize * kSize / 2 : 0);
    // The nodes it strikes are carried on for a step before their neighbours follow: eight springs each.
    const double cell = kSize / (1 << setup.level), way = speed * setup.time_step();
    const double struck = std::max(1.0, std::numbers::pi * 0.1 * 0.1 / (cell * cell));
    expect.input += struck * (4 * 5000 + 4 * 500) * way * way / 2;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass * 9.81 / (1 << setup.level));
    expect.stretch_from = 2;
    expect.rests = pinned;
    return expect;
  };
  return made;
}

/// Shot through a sheet that is held by two edges and tears easily.
Case torn_through() {
  constexpr double kSpeed = 100, kStrength = 50;  // m/s, N/m
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {kTopEdge, {0, 1, 1, 1}});
    BallDescription fast = ball({0, 0, 1}, 0.1, 0);
    fast.velocity = {0, 0, -kSpeed};
    made.balls = {fast};
    made.effects.push_back(TearingEffect{kStrength, kStrength});
    return made;
  };
  Case made{"S44",
            "ball of 0.1 m at 100 m/s through a sheet that bears 50 N/m, held by two edges: torn",
            {{4, scene}}};
  made.expect = [=](const Setup& setup) {
    Expectation expect;
    // As S8's sheet, which is held and does not tear.
    expect.input = mass_of(scene(setup).cloths[0]) * 4 * kSpeed * kSpeed / 2 + 5000 * kSize * kSize / 2;
    const double cell = kSize / (1 << setup.level), way = kSpeed * setup.time_step();
    const double struck = std::max(1.0, std::numbers::pi * 0.1 * 0.1 / (cell * cell));
    expect.input += struck * (4 * 5000 + 4 * 500) * way * way / 2;
    // What is left hangs, or flies off: no link bears more than its strength, 1 % of its stiffness, for long.
    expect.stretch = 0.1;
    expect.stretch_from = 2;
    expect.rests = false;
    return expect;
  };
  made.ending = [](const Simulation<float>& simulation, const Setup&) -> Complaint {
    if (simulation.cloths()[0].walls() != nullptr) return {};
    return "the sheet is whole; should be torn";
  };
  return made;
}

constexpr double kBallRadius = 0.3, kDrapeSeconds = 3;

/// Falls on a ball in the middle, which friction keeps it on.
SimulationDescription drape(const Setup& setup) {
  SimulationDescription scene = level_sheet(setup, {});
  scene.cloths[0].position = {0, kBallRadius + 0.05, 0};
  scene.balls = {ball({0, 0, 0}, kBallRadius)};
  return scene;
}

/// Something happens to the drape at rest, after which no node is inside for more than three steps.
Case struck_drape(std::string name, std::string what, double struck_radius,
                  std::function<void(Simulation<float>&)> strike) {
  Case made{std::move(name), std::move(what), {{kDrapeSeconds + 4, drape}}};
  made.drive = [strike = std::move(strike)](Simulation<float>& simulation, double time) {
    const double step = simulation.description().time_step;
    if (time >= kDrapeSeconds && time < kDrapeSeconds + 0.5 * step) strike(simulation);
  };
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = drape(setup);
    Expectation expect;
    // The struck part is stretched to twice its size in both directions at most.
    expect.input = 5000 * 4 * std::numbers::pi * struck_radius * struck_radius;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81 / 2);
    expect.stretch_from = kDrapeSeconds + 1;
    expect.penetration_from = kDrapeSeconds + 2.5 * setup.time_step();  // from the third step's end on
    expect.top_speed = 10;
    return expect;
  };
  return made;
}

/// No node is deeper than `most` in all solids at once, and those between them keep still from a time to
/// another, s: what is pushed from one solid into the other and back again does not.
Watch watch_pinched(double most, double from, double until) {
  const auto between = std::make_shared<std::vector<std::size_t>>();
  const auto jitter = std::make_shared<Jitter>();
  return [=](const Simulation<float>& simulation, double time) -> Complaint {
    if (time == 0) return {};  // the first step places the solids
    const std::vector<Vec3> nodes = positions(simulation);
    const bool quiet = time >= from && time < until, first = quiet && between->empty();
    double deepest = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (const Solid& each : simulation.colliders().solids())
        least = std::min(least, -each.placed(1).surface(nodes[i]).distance);
      deepest = std::max(deepest, least);
      if (first && least > -most) between->push_back(i);
    }
    if (deepest > most) {
      return "pinched node is " + std::to_string(deepest) + " m deep in both; at most " +
             std::to_string(most);
    }
    if (!quiet) return {};
    if (between->empty()) return "no node is pinched";
    std::vector<Vec3> held;
    for (const std::size_t i : *between) held.push_back(nodes[i]);
    jitter->add(std::move(held));
    const double share = jitter->largest() / kSize;
    if (share <= kJitter) return {};
    return "pinched nodes shake by " + std::to_string(share) + " of the size; at most " +
           std::to_string(kJitter);
  };
}

/// A ball comes down onto the sheet on something fixed at 1 m/s, 5 cm farther than there is room for it,
/// stays for a second, in whose second half what it presses is at rest, and goes. Where solids overlap
/// no node can be outside of both: held to is the one it is less deep in, which it can give way to.
Case pinched(std::string name, std::string what, std::function<void(SimulationDescription&)> add_fixed,
             double top) {
  constexpr double kRadius = 0.3, kHeight = 0.5, kPast = 0.05, kDown = 2, kStay = 1, kDepth = 1e-3;
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {});
    made.cloths[0].position = {0, top + 0.05, 0};
    const Vec3 above(0, top + kRadius + kHeight, 0), pressing(0, top + kRadius - kPast, 0);
    const double reach = kHeight + kPast;  // s, at 1 m/s
    BallDescription presses = ball({0, 0, 0}, kRadius);
    presses.path = {{kDown, above},
                    {kDown + reach, pressing},
                    {kDown + reach + kStay, pressing},
                    {kDown + 2 * reach + kStay, above}};
    made.balls = {presses};
    add_fixed(made);
    return made;
  };
  Case made{std::move(name), std::move(what), {{7, scene}}};
  made.watch = [=](const Setup&) -> Watch {
    const double held = kDown + kHeight + kPast;
    return watch_pinched(kDepth, held + kStay / 2, held + kStay);
  };
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    // What is pressed is drawn in by its depth at most, and moves at the ball's speed.
    expect.input = 5000 * kPast * kPast + mass_of(hung.cloths[0]) / 2;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81 / 2);
    expect.stretch_from = kDown + 2 * (kHeight + kPast) + kStay + 0.5;  // freed
    expect.penetration = kDepth;
    expect.penetration_from = expect.stretch_from;
    return expect;
  };
  return made;
}

Case rolling_under() {
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {kTopLeft, kTopRight, kBottomLeft, kBottomRight});
    BallDescription rolling = ball({0, 0, 0}, 0.25, 0.3);
    // To and fro at 0.5 m/s, a little below the sheet, which it lifts by a tenth of a metre.
    rolling.path = {{0, {-0.5, -0.5, 0}}};
    for (int turn = 0; turn <= 30; ++turn) {
      rolling.path.push_back({1 + 2.0 * turn, {turn % 2 == 0 ? -0.5 : 0.5, -0.15, 0}});
    }
    made.balls = {rolling};
    return made;
  };
  Case made{
      "S20a", "ball rolls to and fro under a sheet held by its corners: none passes through", {{8, scene}}};
  made.nightly_seconds = 60;
  made.watch = nothing_passes;
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    // Lifts the sheet by 0.1 m a turn at most, and rubs at 0.3 of its weight along the way.
    const double seconds = 60;
    expect.input = mass_of(hung.cloths[0]) * 9.81 * (0.1 + 0.3 * 0.5) * seconds;
    expect.stretch = 0.1;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81);
    expect.rests = false;
    return expect;
  };
  return made;
}

Case resting_on() {
  constexpr double kMass = 1, kRadius = 0.2;
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {kTopLeft, kTopRight, kBottomLeft, kBottomRight});
    BallDescription dropped = ball({0, kRadius + 0.02, 0}, kRadius);
    dropped.motion = BallDescription::Motion::dynamic;
    dropped.mass = kMass;
    made.balls = {dropped};
    return made;
  };
  Case made{
      "S20b", "ball of 1 kg laid onto a sheet of 0.4 kg held by its corners, rests there", {{10, scene}}};
  made.watch = nothing_passes;
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    expect.stretch = 0.1;
    expect.excess = xpbd_excess(hung, setup, (kMass + mass_of(hung.cloths[0])) * 9.81 / 2);
    expect.stretch_from = 4;
    expect.rests = false;  // the ball itself is not damped
    return expect;
  };
  made.ending = [](const Simulation<float>& simulation, const Setup& setup) -> Complaint {
    const Ball& dropped = simulation.colliders().balls()[0];
    // A ball's velocity is that at a step's end, and gravity bears on it when the next one begins. Methods
    // that have the sheet bear on it all through the step leave it g dt / 2 upwards when it is at rest, its
    // mean over the step being 0.
    const bool all_through = setup.method != Method::backward_euler && setup.method != Method::bdf2;
    const Vec3 kick = simulation.gravity() * setup.time_step();
    const double speed = (all_through ? Vec3(dropped.velocity + kick / 2) : dropped.velocity).norm();
    if (dropped.position.y() > -kSize / 2 && speed < 0.5) return {};
    return "ball is at " + std::to_string(dropped.position.y()) + " m with " + std::to_string(speed) +
           " m/s; should rest on the sheet";
  };
  return made;
}

/// A tumbling box thrown at a sheet that hangs by an edge. The box's own energy is a part of what is bounded.
Case box_thrown(std::string name, std::string what, double mass) {
  constexpr double kSpeed = 20;  // m/s
  const Vec3 size(0.4, 0.3, 0.2), spin(3, 8, -5);
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
    ObstacleDescription box;
    box.shape = BoxDescription{size};
    box.position = {0.1, 0, 1};
    box.friction = 0.5;
    box.body = BodyDescription{mass, true, {0, 0, -kSpeed}, spin};
    made.obstacles = {box};
    return made;
  };
  Case made{std::move(name), std::move(what), {{4, scene}}};
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    // As the hung sheet of S8, by the box's largest shadow and its fastest corner.
    const double fastest = kSpeed + spin.norm() * size.norm() / 2;
    const double cell = kSize / (1 << setup.level), way = fastest * setup.time_step();
    const double struck = std::max(1.0, size.x() * size.norm() / (cell * cell));
    expect.input = struck * (4 * 5000 + 4 * 500) * way * way / 2;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * 9.81 / (1 << setup.level));
    expect.stretch_from = 2;
    expect.rests = false;  // the box falls for ever
    return expect;
  };
  made.ending = [=](const Simulation<float>& simulation, const Setup&) -> Complaint {
    const Vec3 velocity = simulation.colliders().obstacles()[0].body->velocity();
    if (velocity.z() > -kSpeed) return {};
    return "the box flies at " + std::to_string(-velocity.z()) + " m/s; should be slowed";
  };
  return made;
}

}  // namespace

std::vector<Case> ball_cases() {
  const auto second_ball = [](Simulation<float>& simulation) {
    simulation.add_ball(ball({kBallRadius, -kBallRadius, 0}, 0.2));
  };
  const auto twice_as_large = [](Simulation<float>& simulation) {
    simulation.remove_ball(simulation.colliders().balls()[0].id);
    simulation.add_ball(ball({0, 0, 0}, 2 * kBallRadius));
  };
  return {
      shot_through("S8a", "ball of 0.1 m at 100 m/s through the free sheet: no node passes", 100, false),
      shot_through("S8b", "ball of 0.1 m at 200 m/s through the free sheet", 200, false),
      shot_through("S8c", "ball of 0.1 m at 100 m/s through the hung sheet", 100, true),
      shot_through("S8d", "ball of 0.1 m at 200 m/s through the hung sheet", 200, true),
      torn_through(),
      pinched(
          "S9a", "ball presses the sheet 5 cm into a floor: no node deep in both, freed after",
          [](SimulationDescription& made) {
            made.obstacles = {{PlaneDescription{}, {0, 0, 0}, 0.5}};
          },
          0),
      pinched(
          "S9b", "the same onto a fixed ball",
          [](SimulationDescription& made) {
            made.balls.push_back(ball({0, 0, 0}, 0.3));
          },
          0.3),
      struck_drape("S10a", "ball put inside the resting drape: out within 3 steps, under 10 m/s", 0.2,
                   second_ball),
      struck_drape("S10b", "radius of the draped ball doubled in one step: the same", 2 * kBallRadius,
                   twice_as_large),
      rolling_under(),
      resting_on(),
      box_thrown("S45a", "tumbling box of 20 kg thrown at 20 m/s at a hung sheet of 0.4 kg", 20),
      box_thrown("S45b", "the same of 20 g", 0.02),
  };
}

}  // namespace weft::stability
