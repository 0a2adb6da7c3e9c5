// Fields arrive where they belong; what is left out has the defaults of cloth/description.h.
#include <cmath>
#include <limits>

#include "cloth/shapes/triangle_mesh.h"
#include "fixtures.h"

namespace weft::scene::test {
namespace {

Scene read_good(const std::string& name) {
  return good(
      parse(read_file(std::filesystem::path(WEFT_SCENE_TEST_DATA) / "good" / (name + ".json")), name));
}

bool is(const PinRegion& pin, double u_min, double u_max, double v_min, double v_max) {
  return pin.u_min == u_min && pin.u_max == u_max && pin.v_min == v_min && pin.v_max == v_max;
}

TEST(Reader, DefaultsAreThoseOfTheDescription) {
  const Scene scene = read_good("least");
  EXPECT_EQ(scene.name, "least");
  EXPECT_EQ(scene.title, "least");
  EXPECT_EQ(scene.camera_distance, 5);
  EXPECT_EQ(scene.camera_eye, Vec3(0, 0, 5));
  const SimulationDescription& simulation = scene.simulation;
  ASSERT_EQ(simulation.cloths.size(), 1u);
  const ClothDescription& cloth = simulation.cloths[0];
  EXPECT_EQ(cloth.name, "cloth");
  EXPECT_EQ(cloth.size, Vec2(2, 2));
  EXPECT_EQ(cloth.base_cells, (BaseCells{1, 1}));
  EXPECT_EQ(cloth.min_level, 4);
  EXPECT_EQ(cloth.max_level, 6);
  EXPECT_EQ(cloth.initial_level, 6);
  EXPECT_EQ(cloth.material, Material{});
  EXPECT_EQ(cloth.discretization, Discretization::continuum);
  EXPECT_TRUE(cloth.nodes.empty());
  EXPECT_TRUE(cloth.pins.empty());
  EXPECT_TRUE(simulation.balls.empty());
  EXPECT_TRUE(simulation.effects.empty());
  EXPECT_EQ(simulation.time_step, 1.0 / 60);
  EXPECT_EQ(simulation.sleep_speed, 1e-4);
  EXPECT_EQ(simulation.seed, 1u);
  EXPECT_EQ(simulation.level_policy.thresholds, (std::vector<double>{1, 10}));
  EXPECT_EQ(simulation.level_policy.levels, (std::vector<int>{6, 5, 4}));
  const auto& bdf2 = std::get<Bdf2Description>(simulation.integrator);
  EXPECT_EQ(bdf2.substeps, 1);
  EXPECT_EQ(bdf2.tolerance, 0.1);
  EXPECT_EQ(bdf2.newton_iterations, 2);
}

TEST(Reader, ClothFields) {
  const Scene scene = read_good("everything");
  EXPECT_EQ(scene.title, "All there is");
  EXPECT_EQ(scene.notes, (std::vector<std::string>{"one", "two"}));
  ASSERT_EQ(scene.simulation.cloths.size(), 3u);
  const ClothDescription& cloth = scene.simulation.cloths[0];
  EXPECT_EQ(cloth.name, "left_sail-1");
  EXPECT_EQ(cloth.size, Vec2(3, 1.5));
  EXPECT_EQ(cloth.base_cells, (BaseCells{2, 1}));
  EXPECT_EQ(cloth.position, Vec3(1, 2, 3));
  EXPECT_EQ(cloth.velocity, Vec3(0.5, 0, -0.5));
  EXPECT_EQ(cloth.perturbation, 0.01);
  EXPECT_EQ(cloth.min_level, 3);
  EXPECT_EQ(cloth.max_level, 6);
  EXPECT_EQ(cloth.initial_level, 5);
  EXPECT_EQ(cloth.discretization, Discretization::paper);
  // A quarter turn about y takes the sheet's x axis to -z; the axis need not be of length 1.
  EXPECT_LT((cloth.orientation * Vec3::UnitX() - Vec3(0, 0, -1)).norm(), 1e-15);
  ASSERT_EQ(cloth.pins.size(), 5u);
  EXPECT_TRUE(is(cloth.pins[0], 0, 0, 0, 0));  // top_left
  EXPECT_TRUE(is(cloth.pins[1], 1, 1, 0, 1));  // right
  EXPECT_TRUE(is(cloth.pins[2], 0.25, 0.25, 0.75, 0.75));
  EXPECT_TRUE(is(cloth.pins[3], 0.25, 0.5, 0, 1));
  EXPECT_TRUE(scene.simulation.cloths[1].orientation.isApprox(Quaternion::Identity()));
}

TEST(Reader, Relevance) {
  const auto cloths = read_good("everything").simulation.cloths;
  EXPECT_EQ(cloths.at(0).relevance.unseen, Relevance::Unseen::step);
  EXPECT_EQ(cloths.at(0).relevance.far, std::numeric_limits<double>::infinity());
  EXPECT_EQ(cloths.at(1).relevance.unseen, Relevance::Unseen::sleep);
  EXPECT_EQ(cloths.at(1).relevance.far, 25);
  EXPECT_EQ(cloths.at(2).relevance.unseen, Relevance::Unseen::coarse);
  const Scene scene = good(parse(R"({"cloths":[{"relevance":{"unseen":"step"}}]})", "step"));
  EXPECT_EQ(scene.simulation.cloths.at(0).relevance.unseen, Relevance::Unseen::step);
}

TEST(Reader, MaterialsByNameByNameWithChangesAndRaw) {
  const auto cloths = read_good("everything").simulation.cloths;
  Material silk = find_fabric("silk")->material;
  silk.damping = 0.25;
  silk.rigidity = {2e-6, 2e-6, 2e-6};  // one number for all three
  silk.limit = {0.02, 0.03, 0.2, 50};
  EXPECT_EQ(cloths.at(0).material, silk);
  EXPECT_EQ(cloths.at(1).material, find_fabric("denim")->material);
  EXPECT_EQ(cloths.at(2).material, (Material{0.2, 1000, 0, 0, 0, {2e-5, 1e-5, 0}}));
}

TEST(Reader, WarpAndWeftMayDifferInStiffness) {
  const Scene scene = good(parse(R"({"cloths":[
      {"name":"a","material":{"fabric":"silk","structural":[774,1790]}},
      {"name":"b","material":{"structural":300}}]})",
                                 "uneven"));
  EXPECT_EQ(scene.simulation.cloths.at(0).material.structural, Stiffness(774, 1790));
  EXPECT_EQ(scene.simulation.cloths.at(0).material.shear, find_fabric("silk")->material.shear);
  EXPECT_EQ(scene.simulation.cloths.at(1).material.structural, Stiffness(300, 300));
}

TEST(Reader, EveryNamedPin) {
  const Scene scene = good(parse(R"({"cloths":[{"pins":["top_left","top_right","bottom_left","bottom_right",
      "top","bottom","left","right"]}]})",
                                 "pins"));
  const auto& pins = scene.simulation.cloths.at(0).pins;
  ASSERT_EQ(pins.size(), 8u);
  EXPECT_TRUE(is(pins[0], 0, 0, 0, 0));
  EXPECT_TRUE(is(pins[1], 1, 1, 0, 0));
  EXPECT_TRUE(is(pins[2], 0, 0, 1, 1));
  EXPECT_TRUE(is(pins[3], 1, 1, 1, 1));
  EXPECT_TRUE(is(pins[4], 0, 1, 0, 0));
  EXPECT_TRUE(is(pins[5], 0, 1, 1, 1));
  EXPECT_TRUE(is(pins[6], 0, 0, 0, 1));
  EXPECT_TRUE(is(pins[7], 1, 1, 0, 1));
}

TEST(Reader, BallFields) {
  const auto balls = read_good("everything").simulation.balls;
  ASSERT_EQ(balls.size(), 2u);
  EXPECT_EQ(balls[0].motion, BallDescription::Motion::dynamic);
  EXPECT_EQ(balls[0].position, Vec3(0, 1, 0));
  EXPECT_EQ(balls[0].radius, 0.3);
  EXPECT_EQ(balls[0].velocity, Vec3(0, -2, 0));
  EXPECT_EQ(balls[0].mass, 2.5);
  EXPECT_EQ(balls[1].motion, BallDescription::Motion::kinematic);
  ASSERT_EQ(balls[1].path.size(), 2u);
  EXPECT_EQ(balls[1].path[0].time, 0.5);
  EXPECT_EQ(balls[1].path[1].position, Vec3(0, 0, 0));
  EXPECT_EQ(balls[1].position, Vec3(4, 5, 6));  // where the path begins
}

TEST(Reader, ReadsObstacles) {
  const auto obstacles = read_good("everything").simulation.obstacles;
  ASSERT_EQ(obstacles.size(), 8u);
  ASSERT_TRUE(std::holds_alternative<PlaneDescription>(obstacles[0].shape));
  EXPECT_LT((std::get<PlaneDescription>(obstacles[0].shape).normal - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(obstacles[0].position, Vec3(0, -1, 0));
  EXPECT_EQ(obstacles[0].friction, 0.5);
  ASSERT_TRUE(std::holds_alternative<BoxDescription>(obstacles[3].shape));
  const auto& box = std::get<BoxDescription>(obstacles[3].shape);
  EXPECT_EQ(box.size, Vec3(1, 2, 4));
  EXPECT_LT((box.orientation * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_EQ(obstacles[3].friction, 0);
  EXPECT_TRUE(obstacles[3].path.empty());
  ASSERT_TRUE(std::holds_alternative<CapsuleDescription>(obstacles[4].shape));
  const auto& capsule = std::get<CapsuleDescription>(obstacles[4].shape);
  EXPECT_EQ(capsule.radius, 0.05);
  EXPECT_EQ(capsule.length, 1.5);
  EXPECT_LT((capsule.orientation * Vec3(0, 1, 0) - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(obstacles[4].position, Vec3(1, 2, 3));
  EXPECT_EQ(obstacles[4].friction, 0.25);
}

TEST(Reader, ReadsBodies) {
  const auto obstacles = read_good("everything").simulation.obstacles;
  EXPECT_FALSE(obstacles[4].body);
  ASSERT_TRUE(obstacles[5].body);
  EXPECT_TRUE(obstacles[5].body->dynamic);
  EXPECT_EQ(obstacles[5].body->mass, 2.5);
  EXPECT_EQ(obstacles[5].body->velocity, Vec3(1, 2, 3));
  EXPECT_EQ(obstacles[5].body->spin, Vec3(0, -4, 5));
  ASSERT_TRUE(obstacles[6].body);
  EXPECT_FALSE(obstacles[6].body->dynamic);
  EXPECT_EQ(obstacles[6].body->mass, 3);
  // The tetrahedron's centre of mass, (1, 1, 1) / 4 of its own, is its origin; turned by a quarter about z
  // it is at (-1, 1, 1) / 4 of where it was put.
  ASSERT_TRUE(obstacles[7].body);
  EXPECT_EQ(obstacles[7].body->mass, 1);
  EXPECT_LT((obstacles[7].position - Vec3(0.75, 2.25, 3.25)).norm(), 1e-14);
  const TriangleList& hull = std::get<MeshDescription>(obstacles[7].shape).surface->list();
  Vec3 sum(0, 0, 0);
  for (const Vec3& corner : hull.vertices) sum += corner;
  EXPECT_LT(sum.norm(), 1e-14);
  EXPECT_TRUE(hull.convex);
}

TEST(Reader, PathsOfObstacles) {
  const auto simulation = read_good("everything").simulation;
  EXPECT_TRUE(simulation.cloths[0].pins[3].loop);
  EXPECT_FALSE(simulation.cloths[0].pins[2].loop);
  EXPECT_FALSE(simulation.cloths[0].pins[3].obstacle);
  EXPECT_EQ(simulation.cloths[0].pins[4].obstacle, 2);
  const ObstacleDescription& box = simulation.obstacles[1];
  EXPECT_EQ(box.position, Vec3(0, 1, 0));  // where the path begins
  EXPECT_TRUE(box.loop);
  ASSERT_EQ(box.path.size(), 3u);
  EXPECT_EQ(box.path[1].time, 2);
  EXPECT_EQ(box.path[1].pose.position, Vec3(0, 2, 0));
  EXPECT_LT((box.path[1].pose.orientation * Vec3(1, 0, 0) - Vec3(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((box.path[2].pose.orientation * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);  // its own
  const ObstacleDescription& plane = simulation.obstacles[2];
  EXPECT_EQ(plane.path.at(1).pose.position, Vec3(0, -2, 0));
  EXPECT_FALSE(plane.loop);
}

TEST(Reader, StrengthIsOneNumberOrTwo) {
  const auto tearing = [](const char* strength) {
    const std::string text =
        std::string(R"({"cloths": [{}], "effects": [{"type": "tearing")") + strength + "}]}";
    return std::get<TearingEffect>(good(parse(text, "torn")).simulation.effects.at(0));
  };
  EXPECT_EQ(tearing("").warp, 1000);
  EXPECT_EQ(tearing("").weft, 1000);
  EXPECT_EQ(tearing(R"(, "strength": 250)").warp, 250);
  EXPECT_EQ(tearing(R"(, "strength": 250)").weft, 250);
  EXPECT_EQ(tearing(R"(, "strength": [300, 200.5])").warp, 300);
  EXPECT_EQ(tearing(R"(, "strength": [300, 200.5])").weft, 200.5);
}

TEST(Reader, ReadsASewnClothAndItsGas) {
  const SimulationDescription simulation = read_good("sewn").simulation;
  EXPECT_TRUE(simulation.cloths[0].sewn);
  EXPECT_EQ(std::get<InflationEffect>(simulation.effects[0]), (InflationEffect{-250, 0.125, 0.5}));
  const SimulationDescription other = read_good("everything").simulation;
  EXPECT_FALSE(other.cloths[0].sewn);
  EXPECT_FALSE(std::get<InflationEffect>(other.effects[8]).volume);
}

TEST(Reader, EffectsWindAndStepping) {
  const SimulationDescription simulation = read_good("everything").simulation;
  ASSERT_EQ(simulation.effects.size(), 9u);
  EXPECT_EQ(std::get<GravityEffect>(simulation.effects[0]).acceleration, Vec3(0, 0, -1.62));
  EXPECT_TRUE(std::holds_alternative<DampingEffect>(simulation.effects[1]));
  EXPECT_EQ(std::get<PaperWindEffect>(simulation.effects[2]).factor, 2);
  EXPECT_TRUE(std::get<PaperWindEffect>(simulation.effects[2]).along_normal);
  EXPECT_EQ(std::get<AerodynamicsEffect>(simulation.effects[3]).air_density, 1);
  EXPECT_EQ(std::get<AerodynamicsEffect>(simulation.effects[3]).drag, 1.5);
  EXPECT_EQ(std::get<AerodynamicsEffect>(simulation.effects[3]).lift, 0.5);
  EXPECT_EQ(std::get<StrainDampingEffect>(simulation.effects[4]).time, 0.005);
  EXPECT_TRUE(std::holds_alternative<PlateBendingEffect>(simulation.effects[5]));
  EXPECT_TRUE(std::holds_alternative<StrainLimitEffect>(simulation.effects[6]));
  EXPECT_EQ(std::get<ClothContactEffect>(simulation.effects[7]).thickness, 0.003);
  EXPECT_EQ(std::get<ClothContactEffect>(simulation.effects[7]).friction, 0.5);
  EXPECT_EQ(std::get<InflationEffect>(simulation.effects[8]).pressure, 250);
  EXPECT_LT((simulation.wind.direction - Vec3(0.6, 0, -0.8)).norm(), 1e-15);  // 3, 4, 5
  EXPECT_EQ(simulation.wind.speed, 7);
  EXPECT_EQ(simulation.wind.gusts.intensity, 0.25);
  EXPECT_EQ(simulation.wind.gusts.time_scale, 4);
  EXPECT_EQ(simulation.wind.turbulence.intensity, 0.125);
  EXPECT_EQ(simulation.wind.turbulence.length_scale, 0.75);
  ASSERT_EQ(simulation.wind.zones.size(), 2u);
  const auto& zone_box = std::get<BoxZone>(simulation.wind.zones[0].shape);
  EXPECT_EQ(zone_box.size, Vec3(1, 2, 4));
  EXPECT_LT((zone_box.orientation * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_EQ(simulation.wind.zones[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(simulation.wind.zones[0].velocity, Vec3(0, 0, -6));
  EXPECT_EQ(simulation.wind.zones[0].edge, 0.5);
  EXPECT_EQ(std::get<SphereZone>(simulation.wind.zones[1].shape).radius, 1.5);
  EXPECT_EQ(simulation.wind.zones[1].edge, 0.1);  // the default
  EXPECT_EQ(std::get<SymplecticEulerDescription>(simulation.integrator).substeps, 40);
  EXPECT_EQ(std::get<SymplecticEulerDescription>(simulation.integrator).safety, 0.5);
  EXPECT_EQ(simulation.time_step, 0.01);
  EXPECT_EQ(simulation.sleep_speed, 0.001);
  EXPECT_EQ(simulation.level_policy.thresholds, (std::vector<double>{1, 2, 4, 8, 16}));
  EXPECT_EQ(simulation.level_policy.levels, (std::vector<int>{8, 7, 6, 5, 4, 3}));
  EXPECT_EQ(simulation.level_policy.hysteresis, 0.2);
  EXPECT_EQ(simulation.seed, 9007199254740991u);
}

TEST(Reader, XpbdFields) {
  const auto integrator = [](const char* scene) {
    return std::get<XpbdDescription>(read_good(scene).simulation.integrator);
  };
  EXPECT_EQ(integrator("xpbd").substeps, 10000);
  EXPECT_EQ(integrator("xpbd_auto").substeps, 0);
  EXPECT_EQ(integrator("xpbd_auto").longest_substep, 0.001);
}

TEST(Reader, ImplicitFields) {
  const Scene scene = read_good("implicit");
  const auto& bdf2 = std::get<Bdf2Description>(scene.simulation.integrator);
  EXPECT_EQ(bdf2.substeps, 3);
  EXPECT_EQ(bdf2.tolerance, 0.001);
  EXPECT_EQ(bdf2.newton_iterations, 2);
  EXPECT_EQ(bdf2.linear_iterations, 200);
  EXPECT_EQ(bdf2.liveliness, 0.5);
}

TEST(Reader, ExtremesAreAllowed) {
  const Scene scene = read_good("extremes");
  ASSERT_EQ(scene.simulation.cloths.size(), 3u);
  EXPECT_EQ(scene.simulation.cloths[1].max_level, 8);  // 257 x 257 nodes, the most there may be
  EXPECT_EQ(scene.simulation.cloths[2].nodes, std::vector<Vec3>(81, Vec3(0, 0, 0)));
  EXPECT_EQ(scene.camera_distance, 1e6);  // the eye's
}

TEST(Reader, CameraEyeAndDistanceFollowEachOther) {
  const Scene eye = good(parse(R"({"cloths":[{}],"camera":{"eye":[3,4,1],"target":[0,0,1]}})", "a"));
  EXPECT_DOUBLE_EQ(eye.camera_distance, 5);  // 3, 4, 5
  const Scene distance = good(parse(R"({"cloths":[{}],"camera":{"distance":7,"target":[1,2,3]}})", "b"));
  EXPECT_EQ(distance.camera_eye, Vec3(1, 2, 10));
  const Scene both = read_good("everything");
  EXPECT_EQ(both.camera_distance, 4);
  EXPECT_EQ(both.camera_eye, Vec3(1, 2, 3));
}

TEST(Reader, QualityIsOneOfErrorAndTime) {
  EXPECT_FALSE(read_good("least").quality.asks());
  const Quality error = read_good("everything").quality;
  EXPECT_EQ(error.max_error, 0.01);
  EXPECT_FALSE(error.max_ms);
  const Quality time = good(parse(R"({"cloths":[{}],"quality":{"max_ms":2}})", "b")).quality;
  EXPECT_EQ(time.max_ms, 2);
  EXPECT_FALSE(time.max_error);
}

TEST(Reader, AFilesNameBecomesTheScenesName) {
  const auto file = std::filesystem::path(testing::TempDir()) / "My Scene_2.v1.json";
  std::ofstream(file) << R"({"cloths":[{}]})";
  EXPECT_EQ(good(load(file.string())).name, "my-scene-2-v1");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace weft::scene::test
