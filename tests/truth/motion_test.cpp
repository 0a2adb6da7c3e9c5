// Falls (T1, T2, T16), the limit of stability (T5), momentum (T15), friction (T14) for every method.
#include <tuple>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "meshes.h"
#include "methods.h"

namespace weft::test {
namespace {

using Motion = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Motion, ::testing::ValuesIn(kMethods), name_of_case);

/// A sheet that lies face down, without springs.
Rig<double> falling_sheet(Method method, int substeps, const std::vector<EffectDescription>& effects,
                          double damping = 0) {
  Particles<double> sheet = flat_sheet<double>(9, 9, {2, 2});
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 p = get(sheet.position, r, c);
    set(sheet.position, r, c, {p.x(), 0, p.y()});
  });
  share_mass(sheet, 0.4, Discretization::continuum);
  Material material = without_springs();
  material.damping = damping;
  return {std::move(sheet), {2, 2}, material, Discretization::continuum, effects, stepping(method, substeps)};
}

// T1: 1 s in 60 steps falls -g/2; methods of first order, whose speeds are exact, fall g h^2 n (n+1) / 2.
TEST_P(Motion, FreeFall) {
  Rig<double> rig = falling_sheet(GetParam(), 1, {GravityEffect{}});
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  EXPECT_NEAR(get(rig.particles.velocity, 4, 4).y(), -9.81, 1e-10);
  const double y = get(rig.particles.position, 4, 4).y();
  if (GetParam() == Method::bdf2) {
    EXPECT_NEAR(
        y, -4.905,
        9.81 * kFrame * kFrame);  // its first step is backward Euler's: an error of g h^2 / 2, carried on
  } else {
    EXPECT_NEAR(y, -4.98675, 1e-10);
  }
}

// T2: v(t) = -(g/c) (1 - exp(-c t)) with c = k/m = 3 /s.
TEST_P(Motion, DampedFall) {
  Rig<double> rig = falling_sheet(GetParam(), 20, {GravityEffect{}, DampingEffect{}}, 0.3);
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  const double h = kFrame / 20, expected = -9.81 / 3 * (1 - std::exp(-3.0));
  // First order: c h / 2 of what has not yet died away, c t exp(-c t) of the limit.
  EXPECT_NEAR(get(rig.particles.velocity, 4, 4).y(), expected, 9.81 / 3 * (3 * std::exp(-3.0)) * 3 * h);
}

// T16: face on, drag coefficient 1.2: sqrt(2 rho g / (rho_air C)).
TEST_P(Motion, TerminalSpeed) {
  const double expected = std::sqrt(2 * 0.1 * 9.81 / (1.225 * 1.2));
  EXPECT_NEAR(expected, 1.155290, 1e-6);
  Rig<double> rig = falling_sheet(GetParam(), 8, {GravityEffect{}, AerodynamicsEffect{}});
  for (int step = 0; step < 200; ++step) rig.advance(step * kFrame, kFrame);
  EXPECT_NEAR(get(rig.particles.velocity, 4, 4).y(), -expected, 1e-6);
}

// T5: symplectic Euler is stable for w h < 2, its energy bounded without drift; the others are stable for any
// step.
TEST(StabilityLimit, IsAtTwo) {
  const auto amplitude = [](Method method, double wh, int steps) {
    Particles<double> sheet = flat_sheet<double>(2, 3, {2, 1});
    for (int r : {0, 1}) {
      for (int c : {0, 2}) sheet.inverse_mass.at(r, c) = 0;
      set(sheet.position, r, 1, get(sheet.position, r, 1) + Vec3(1e-3, 0, 0));
    }
    Rig<double> rig(std::move(sheet), {2, 1}, strands(0.5), Discretization::paper, {},
                    stepping(method, 1));  // w = 1
    double most = 0;
    for (int step = 0; step < steps; ++step) {
      rig.advance(step * wh, wh);
      most = std::max(most, std::abs(get(rig.particles.position, 0, 1).x()));
    }
    return most;
  };
  // Below 2 the amplitude is at most that of the invariant v^2 - w^2 h x v + w^2 x^2: 1 / sqrt(1 - (w h)^2 /
  // 4).
  EXPECT_LT(amplitude(Method::symplectic_euler, 1.9, 100000), 1e-3 * 1.001 / std::sqrt(1 - 1.9 * 1.9 / 4));
  EXPECT_GT(amplitude(Method::symplectic_euler, 2.01, 1000), 1.0);
  for (const Method method : {Method::backward_euler, Method::bdf2, Method::xpbd}) {
    EXPECT_LE(amplitude(method, 100, 1000), 1e-3) << name_of(method);
  }
}

// T15: internal forces cancel. Angular momentum is kept by symplectic Euler alone; the others' lets their
// order's share go.
TEST_P(Motion, FreeClothKeepsItsMomentum) {
  Rig<double> rig =
      sheet_rig<double>(9, 9, stepping(GetParam(), GetParam() == Method::symplectic_euler ? 0 : 1));
  randomise(rig.particles.velocity, -1, 1, 3);
  const Vec3 linear = linear_momentum(rig.particles), angular = angular_momentum(rig.particles);
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  // The solves end at 1e-12 of the energy's root; the others round: 1e-16 of 5,000 N/m a step.
  EXPECT_LT((linear_momentum(rig.particles) - linear).norm(), 1e-9);
  if (GetParam() == Method::symplectic_euler) {
    EXPECT_LT((angular_momentum(rig.particles) - angular).norm(), 1e-9);
  }
}

enum class Incline { ball, plane, box, capsule, convex, mesh };
void PrintTo(Incline incline, std::ostream* out) {
  constexpr std::array kNames{"ball", "plane", "box", "capsule", "convex", "mesh"};
  *out << kNames[static_cast<std::size_t>(incline)];
}

/// Under the plane y = 0, hollow below: strips of triangles that the sheet slides across, 0.15 m apart.
TriangleList trough() {
  constexpr std::array<std::array<double, 2>, 8> kSection{
      {{0, -1.5}, {0, -0.75}, {0, 0}, {0, 0.75}, {0, 1.5}, {-1, 1.5}, {-0.7, 0}, {-1, -1.5}}};
  return revolved(40, kSection.size(), false, [&](double u, double v) {
    if (u == 0 || u == 1) return Vec3(6 * u - 3, -0.35, 0);
    const auto& [y, z] = kSection[static_cast<std::size_t>(std::lround(v * double(kSection.size())))];
    return Vec3(6 * u - 3, y, z);
  });
}

constexpr double kRadius = 1000;  // m, of what is round: 0.2 m are level to 5 um on it

/// Adds a solid whose surface at the origin is a plane, or nearly one, that falls by `angle` along +x.
void add_incline(SimulationDescription& scene, Incline incline, double angle, double friction) {
  const Vec3 normal(std::sin(angle), std::cos(angle), 0);
  const Quaternion fall(Eigen::AngleAxisd(-angle, Vec3::UnitZ()));
  if (incline == Incline::ball) {
    BallDescription ball;
    ball.position = -kRadius * normal;
    ball.radius = kRadius;
    ball.friction = friction;
    scene.balls = {ball};
    return;
  }
  ObstacleDescription obstacle;
  obstacle.friction = friction;
  if (incline == Incline::plane) {
    obstacle.shape = PlaneDescription{normal};
  } else if (incline == Incline::box) {
    obstacle.shape = BoxDescription{{6, 2, 3}, fall};
    obstacle.position = -normal;
  } else if (incline == Incline::capsule) {  // down along its side
    obstacle.shape = CapsuleDescription{
        kRadius, 6, fall * Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()))};
    obstacle.position = -kRadius * normal;
  } else {
    const bool convex = incline == Incline::convex;
    obstacle.shape = MeshDescription{
        std::make_shared<const TriangleMesh>(convex ? box_mesh({3, 1, 1.5}) : trough()), fall, convex};
    if (convex) obstacle.position = -normal;
  }
  scene.obstacles = {obstacle};
}

/// Of an acceleration what is missing of a way of 1 s that begins a step and a half late: (1 - (1 - 1.5 /
/// 60)^2) / 2.
constexpr double kLate = 0.0247;

/// How far, m, a 0.2 m sheet slides down an incline from one time to another.
double slide(Method method, Incline incline, double degrees, double friction, double from, double to) {
  const double angle = degrees * std::numbers::pi / 180;
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {0.2, 0.2};
  cloth.min_level = cloth.max_level = cloth.initial_level = 3;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-angle, Vec3::UnitZ())) *
                      Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.position = 1e-9 * Vec3(std::sin(angle), std::cos(angle), 0);
  cloth.material.structural = 500;  // soft, so that explicit substeps are few
  cloth.material.shear = 50;
  cloth.material.bending = 0.5;
  scene.cloths = {cloth};
  add_incline(scene, incline, angle, friction);
  scene.effects = {GravityEffect{}};
  scene.sleep_speed = 0;  // creep is what is measured
  scene.integrator = stepping(method, method == Method::symplectic_euler ? 0
                                      : method == Method::xpbd           ? 10
                                                                         : 1);
  Simulation<double> simulation(scene);
  const auto run_to = [&](double seconds) {
    while (simulation.time() < seconds - kFrame / 2) simulation.step();
    return simulation.centre(0);
  };
  const Vec3 begin = run_to(from);
  return (run_to(to) - begin).dot(Vec3(std::cos(angle), -std::sin(angle), 0));
}

class Slide : public ::testing::TestWithParam<std::tuple<Method, Incline>> {};
INSTANTIATE_TEST_SUITE_P(Methods, Slide,
                         ::testing::Combine(::testing::ValuesIn(kMethods),
                                            ::testing::Values(Incline::ball, Incline::plane, Incline::box,
                                                              Incline::capsule, Incline::convex,
                                                              Incline::mesh)),
                         [](const auto& tested) {
                           return name_of(std::get<0>(tested.param)) + "_on_" +
                                  ::testing::PrintToString(std::get<1>(tested.param));
                         });

// T14: slides iff tan(angle) > mu, at g (sin - mu cos). At rest it does not creep, to rounding, whatever
// holds it. An implicit step finds the slip of what begins to slide over its first steps: within a step and a
// half.
TEST_P(Slide, SheetOnAnInclineRestsOrSlides) {
  const auto [method, incline] = GetParam();
  EXPECT_LT(std::abs(slide(method, incline, 15, 0.3, 3.0, 4.0)), 1e-9);
  EXPECT_NEAR(slide(method, incline, 20, 0.3, 0, 1), 0.589702 / 2, kLate * 0.589702);
  EXPECT_NEAR(slide(method, incline, 30, 0.5, 0, 1), 0.657145 / 2, kLate * 0.657145);
  EXPECT_NEAR(slide(method, incline, 20, 0, 0, 1), 3.355218 / 2, kLate * 3.355218);
}

}  // namespace
}  // namespace weft::test
