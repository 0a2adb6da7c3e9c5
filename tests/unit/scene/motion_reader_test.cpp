// What goes with a skeleton's node in a scene: colliders and pins; and motions that are refused.
#include <numbers>

#include "cloth/world/simulation.h"
#include "fixtures.h"
#include "scene/motion/bvh_file.h"
#include "scene/motion/motion_files.h"
#include "scene/motion/node_path.h"

namespace weft::scene::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A folder of its own with a scene and a motion, gone with the test: "arm", which is 2 m up, turns about z
/// by 90 degrees in 1 s, in 10 steps, around the root, which stands.
class MotionScene : public testing::Test {
 protected:
  MotionScene() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::string text =
        "HIERARCHY ROOT root\n{ OFFSET 0 0 0 CHANNELS 0 JOINT arm\n{ OFFSET 0 2 0 CHANNELS 1 Zrotation } }\n"
        "MOTION Frames: 11 Frame Time: 0.1\n";
    for (int i = 0; i <= 10; ++i) text += std::to_string(9 * i) + "\n";
    write("turn.bvh", text);
  }
  ~MotionScene() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Result read(const json& scene) const {
    write("scene.json", scene.dump());
    return load((folder_ / "scene.json").string());
  }
  /// Problems of a scene with a box of this motion.
  std::string problems(const json& motion) const {
    return problems_of(read({{"cloths", {json::object()}},
                             {"colliders", {{{"type", "box"}, {"size", {1, 1, 1}}, {"motion", motion}}}}}));
  }
  const fs::path folder_ =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

const json kTurn = {{"file", "turn.bvh"}, {"node", "arm"}};

// The capsule is 1 m from the arm along its x axis, and turned by a quarter about z as seen from it.
TEST_F(MotionScene, CarriesColliders) {
  const Scene scene =
      good(read({{"cloths", {json::object()}},
                 {"colliders",
                  {{{"type", "capsule"},
                    {"radius", 0.1},
                    {"length", 1},
                    {"position", {1, 0, 0}},
                    {"orientation", {{"axis", {0, 0, 1}}, {"degrees", 90}}},
                    {"motion", kTurn}},
                   {{"type", "ball"}, {"radius", 0.1}, {"position", {1, 0, 0}}, {"motion", kTurn}},
                   {{"type", "box"}, {"size", {1, 1, 1}}, {"mass", 2}, {"motion", kTurn}}}}}));
  const ObstacleDescription& capsule = scene.simulation.obstacles[0];
  ASSERT_EQ(capsule.path.size(), 11u);
  EXPECT_LT((capsule.path[0].pose.position - Vec3(1, 2, 0)).norm(), 1e-12);
  EXPECT_LT((capsule.path[10].pose.position - Vec3(0, 3, 0)).norm(), 1e-12);
  const Quaternion half_turn(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
  EXPECT_LT(capsule.path[10].pose.orientation.angularDistance(half_turn), 1e-7);
  EXPECT_DOUBLE_EQ(capsule.path[10].time, 1);
  const BallDescription& ball = scene.simulation.balls[0];
  ASSERT_EQ(ball.path.size(), 11u);
  EXPECT_LT((ball.path[10].position - Vec3(0, 3, 0)).norm(), 1e-12);
  EXPECT_EQ(ball.motion, BallDescription::Motion::kinematic);
  EXPECT_TRUE(scene.simulation.obstacles[1].body.has_value());  // it can be thrown
  EXPECT_LT((scene.simulation.obstacles[1].position - Vec3(0, 2, 0)).norm(), 1e-12);
}

// A corner at (1, 1, 0), 1 m right of and 1 m below the arm at (0, 2, 0), is 1 m right of and 1 m above it
// once that has turned by a quarter; halfway it is straight right of it by the square root of 2.
TEST_F(MotionScene, CarriesPins) {
  Scene scene = good(read({{"cloths",
                            {{{"size", {2, 2}},
                              {"levels", {{"min", 3}, {"max", 3}}},
                              {"pins", {{{"u", 1}, {"v", 0}, {"motion", kTurn}}}}}}}}));
  for (const IntegratorDescription& method :
       {IntegratorDescription(Bdf2Description{}), IntegratorDescription(BackwardEulerDescription{}),
        IntegratorDescription(XpbdDescription{}), IntegratorDescription(SymplecticEulerDescription{})}) {
    scene.simulation.integrator = method;
    Simulation<double> simulation(scene.simulation);
    const auto corner = [&] { return simulation.cloths()[0].particles().position_at(0, 8); };
    EXPECT_LT((corner() - Vec3(1, 1, 0)).norm(), 1e-12);
    for (int step = 0; step < 30; ++step) simulation.step();
    EXPECT_LT((corner() - Vec3(std::sqrt(2.0), 2, 0)).norm(), 1e-6);
    for (int step = 0; step < 60; ++step) simulation.step();
    EXPECT_LT((corner() - Vec3(1, 3, 0)).norm(), 1e-6);
  }
}

TEST_F(MotionScene, SaysWhatIsWrong) {
  EXPECT_EQ(problems({{"file", "turn.bvh"}, {"node", "ram"}}),
            "/colliders/0/motion/file: is \"turn.bvh\", which has no node \"ram\"; did you mean \"arm\"?\n");
  EXPECT_EQ(problems({{"file", "turn.bvh"}}),
            "/colliders/0/motion/node: is missing; must be a node's name\n");
  EXPECT_EQ(problems({{"node", "arm"}}),
            "/colliders/0/motion/file: must be given, or builtin, and not both\n");
  EXPECT_EQ(problems({{"file", "turn.bvh"}, {"builtin", "walk"}, {"node", "arm"}}),
            "/colliders/0/motion/file: must be given, or builtin, and not both\n");
  EXPECT_EQ(problems({{"builtin", "run"}, {"node", "arm"}}),
            "/colliders/0/motion/builtin: is \"run\", which must be one of \"walk\"\n");
  EXPECT_EQ(problems({{"file", "turn.bvh"}, {"node", "arm"}, {"animation", "wave"}}),
            "/colliders/0/motion/file: is \"turn.bvh\", which has no animation \"wave\"\n");
  EXPECT_EQ(
      problems({{"file", "turn.bvh"}, {"node", "arm"}, {"loop", true}}),
      "/colliders/0/motion/file: is \"turn.bvh\", which does not end where it begins: 0 m and 90 degrees "
      "apart, which cannot loop\n");
  EXPECT_EQ(
      problems({{"file", "../turn.bvh"}, {"node", "arm"}}),
      "/colliders/0/motion/file: is \"../turn.bvh\", which must be a path within the scene file's folder, "
      "without \"..\"\n");
  EXPECT_EQ(problems({{"file", "scene.json"}, {"node", "arm"}}),
            "/colliders/0/motion/file: is \"scene.json\", which must be a .bvh, .gltf or .glb file\n");
  write("bad.bvh", "HIERARCHY\nTREE");
  EXPECT_EQ(problems({{"file", "bad.bvh"}, {"node", "arm"}}),
            "/colliders/0/motion/file: is \"bad.bvh\", which has \"TREE\" in line 2; must be \"ROOT\"\n");
  write("bad.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "../turn.bvh"}]})");
  EXPECT_EQ(problems({{"file", "bad.gltf"}, {"node", "arm"}}),
            "/colliders/0/motion/file: is \"bad.gltf\", which has a buffer in \"../turn.bvh\", which must be "
            "a path "
            "within the scene file's folder, without \"..\"\n");
}

TEST_F(MotionScene, RefusesWhatWouldMoveItOtherwise) {
  EXPECT_EQ(
      problems_of(read({{"cloths", {{{"pins", {{{"u", 0}, {"v", 0}, {"obstacle", 0}, {"motion", kTurn}}}}}}},
                        {"colliders",
                         {{{"type", "ball"}, {"radius", 1}, {"velocity", {1, 0, 0}}, {"motion", kTurn}},
                          {{"type", "plane"}, {"position", {0, 0, 0}}}}}})),
      "/cloths/0/pins/0/obstacle: is given beside motion, which says where it goes\n"
      "/colliders/0/velocity: is given beside a motion's file, which says where it goes\n");
}

// A quarter of 2 kg / (0.02 s)^2 is 1250 N/m.
TEST(PinOnABody, IsSoftEnough) {
  const auto problems = [](const json& pin) {
    const json scene = {
        {"cloths", {{{"pins", {pin}}}}},
        {"time_step", 0.02},
        {"colliders",
         {{{"type", "ball"}, {"radius", 1}, {"position", {0, 0, 0}}, {"motion", "dynamic"}, {"mass", 2}},
          {{"type", "box"}, {"size", {1, 1, 1}}, {"position", {0, 0, 0}}, {"mass", 0.5}}}}};
    return problems_of(parse(scene.dump(), "sent"));
  };
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"ball", 0}, {"stiffness", 1250}}), "");
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"ball", 0}, {"stiffness", 1251}}),
            "/cloths/0/pins/0/ball: is 0; that one has 2.0 kg, and all pins on it a stiffness of 1251.0 N/m; "
            "at most "
            "1250.0 N/m are allowed, a quarter of mass / time_step^2\n");
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"ball", 0}}),
            "/cloths/0/pins/0/ball: is 0; that one may fly, and a pin on it needs a stiffness\n");
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"obstacle", 0}}),
            "/cloths/0/pins/0/obstacle: is 0; that one may fly, and a pin on it needs a stiffness\n");
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"ball", 1}, {"stiffness", 1}}),
            "/cloths/0/pins/0/ball: is 1; the scene has 1 balls, counted from 0\n");
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"ball", 0}, {"obstacle", 0}, {"stiffness", 1}}),
            "/cloths/0/pins/0/obstacle: is given beside ball, which says where it goes\n");
  EXPECT_EQ(problems({{"u", 0}, {"v", 0}, {"from", 2}, {"until", 1}}),
            "/cloths/0/pins/0/until: is 1; must be later than from, 2.0 s\n");
}

// A cube of 0.2 m and 1 kg has the inertia 0.04 / 6 kg m2. Pulled at a sheet's corner, 1.5 m from its centre,
// it gives way as one of 1 / (1 + 2.25 * 6 / 0.04) kg: 0.875 * 3600 / 338.5 = 9.31 N/m are as much as
// explicit methods bear at 60 Hz.
TEST(PinOnABody, IsSofterFarFromItsCentreByExplicitMethods) {
  const auto problems = [](const std::string& integrator, double stiffness) {
    const json scene = {
        {"cloths", {{{"pins", {{{"u", 0}, {"v", 0}, {"obstacle", 0}, {"stiffness", stiffness}}}}}}},
        {"integrator", {{"type", integrator}}},
        {"time_step", 1.0 / 60},
        {"colliders",
         {{{"type", "box"}, {"size", {0.2, 0.2, 0.2}}, {"position", {-1, -0.5, 0}}, {"mass", 1}}}}};
    return problems_of(parse(scene.dump(), "sent"));
  };
  for (const char* integrator : {"xpbd", "symplectic_euler"}) {
    EXPECT_EQ(problems(integrator, 9.3), "");
    const std::string told =
        "/cloths/0/pins/0/obstacle: is 0; that one is pulled up to 1.5 m from its centre, by 9.4 N/m in all; "
        "with \"" +
        std::string(integrator) + "\" at most 9.3";
    EXPECT_EQ(problems(integrator, 9.4).find(told), 0U) << problems(integrator, 9.4);
  }
  EXPECT_EQ(problems("bdf2", 800), "");
}

// As with meshes: what a client sends names no files, but built-in motions.
TEST(SentScene, NamesNoMotionFiles) {
  const auto sent = [](const json& motion) {
    const json scene = {{"cloths", {json::object()}},
                        {"colliders", {{{"type", "box"}, {"size", {1, 1, 1}}, {"motion", motion}}}}};
    return problems_of(parse(scene.dump(), "sent"));
  };
  EXPECT_EQ(
      sent({{"file", "turn.bvh"}, {"node", "arm"}}),
      "/colliders/0/motion/file: is \"turn.bvh\", which is given by a scene that is not a file itself\n");
  EXPECT_EQ(sent({{"builtin", "walk"}, {"node", "Chest"}, {"scale", 0.01}, {"loop", true}}), "");
}

TEST(MotionFiles, AreBounded) {
  MotionFiles files({});
  files.count(MotionFiles::kMaxPoints);
  EXPECT_THROW(files.count(1), std::invalid_argument);
}

// The feet of the built-in walk stand on the ground in turn: in each frame an ankle is 8 cm high, or as much
// as the hips' lean of 3 degrees over 3 cm makes of that.
TEST(BuiltinMotion, WalksOnTheGround) {
  const Skeleton skeleton = read_builtin_motion("walk");
  const Skeleton::Clip& clip = skeleton.clips[0];
  for (double time = 0; time <= clip.duration; time += clip.interval) {
    const auto ankle = [&](const char* name) {
      return pose_at(skeleton, &clip, find_node(skeleton, name), time).position.y();
    };
    EXPECT_NEAR(std::min(ankle("LeftFoot"), ankle("RightFoot")), 8, 2) << time;
  }
  Placement loop;
  loop.loop = true;
  for (std::size_t node = 0; node < skeleton.nodes.size(); ++node)
    EXPECT_NO_THROW(path_of(skeleton, clip, node, loop));
}

}  // namespace
}  // namespace weft::scene::test
