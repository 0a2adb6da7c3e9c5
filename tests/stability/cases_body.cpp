// Bodies that meet each other and what stands in their way, over cloth.
#include <algorithm>

#include "case.h"

namespace weft::stability {
namespace {

/// A sheet that lies on the floor, which all solids are over.
SimulationDescription sheet_on_floor(const Setup& setup) {
  SimulationDescription made = level_sheet(setup, {});
  made.cloths[0].position = {0, 0.01, 0};
  made.obstacles = {{PlaneDescription{}, {0, 0, 0}, 0.5}};
  return made;
}

ObstacleDescription body(const decltype(ObstacleDescription::shape)& shape, const Vec3& position) {
  ObstacleDescription made;
  made.shape = shape;
  made.position = position;
  made.friction = 0.5;
  made.body = BodyDescription{};
  return made;
}

/// The lowest point of anything that flies, m.
double lowest(const Simulation<float>& simulation) {
  double least = 0;
  for (const Ball& ball : simulation.colliders().balls()) {
    least = std::min(least, ball.position.y() - ball.radius);
  }
  for (const Obstacle& obstacle : simulation.colliders().obstacles()) {
    if (obstacle.flies()) least = std::min(least, obstacle.solid.placed(1).bounds().min().y());
  }
  return least;
}

Watch stays_over_the_floor(double deepest) {
  return [deepest](const Simulation<float>& simulation, double) -> Complaint {
    const double depth = -lowest(simulation);
    if (depth <= deepest) return {};
    return "a body is " + std::to_string(depth) + " m deep in the floor";
  };
}

Case pile() {
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = sheet_on_floor(setup);
    for (int i = 0; i < 10; ++i) {
      const Vec3 place(0.06 * (i % 3), 0.4 + 0.45 * i, 0.05 * (i % 2));
      const Quaternion turned(Eigen::AngleAxisd(0.7 * i, Vec3(1, 0.3 * i, 0.5).normalized()));
      if (i % 3 == 0) {
        made.balls.push_back(ball(place, 0.2));
        made.balls.back().motion = BallDescription::Motion::dynamic;
      } else if (i % 3 == 1) {
        made.obstacles.push_back(body(BoxDescription{{0.3, 0.3, 0.4}, turned}, place));
      } else {
        made.obstacles.push_back(body(CapsuleDescription{0.1, 0.4, turned}, place));
      }
    }
    return made;
  };
  Case made{"S50",
            "ten balls, boxes and capsules fall in a pile onto a sheet on the floor: none sinks in",
            {{5, scene}}};
  made.watch = [](const Setup& setup) {
    // Contact is linear in a step: of what turns it leaves a depth of the second order, (w h)^2 r / 2, of an
    // edge of 0.2 m at 10 rad/s.
    const double turn = 10 * setup.time_step();
    return stays_over_the_floor(std::max(2e-3, turn * turn * 0.2 / 2));
  };
  made.expect = [scene](const Setup& setup) {
    Expectation expect;
    // 45 kg m of height fall on the sheet, which may be caught between them.
    expect.stretch = 1;
    expect.excess = xpbd_excess(scene(setup), setup, 10 * kGravity);
    expect.penetration = 0.02;
    expect.rests = false;  // balls roll on
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> body_cases() { return {pile()}; }

}  // namespace weft::stability
