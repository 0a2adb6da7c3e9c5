// Convex bodies and meshes: what OBJ files, lathes and hulls give, and files that are refused.
#include <cmath>
#include <numbers>
#include <sstream>

#include "cloth/shapes/triangle_mesh.h"
#include "fixtures.h"

namespace weft::scene::test {
namespace {

namespace fs = std::filesystem;

const TriangleMesh& surface(const Scene& scene, std::size_t obstacle) {
  return *std::get<MeshDescription>(scene.simulation.obstacles[obstacle].shape).surface;
}

double volume(const TriangleMesh& mesh) {
  double six_fold = 0;
  for (const auto& [a, b, c] : mesh.list().triangles) {
    const auto vertex = [&](int i) { return mesh.list().vertices[static_cast<std::size_t>(i)]; };
    six_fold += vertex(a).dot(vertex(b).cross(vertex(c)));
  }
  return six_fold / 6;
}

TEST(Surfaces, AreWhatTheSceneSays) {
  const Scene scene = good(load((fs::path(WEFT_SCENE_TEST_DATA) / "good/surfaces.json").string()));
  ASSERT_EQ(scene.simulation.obstacles.size(), 6u);
  const auto& box = std::get<MeshDescription>(scene.simulation.obstacles[0].shape);
  EXPECT_FALSE(box.convex);
  EXPECT_NEAR(box.orientation.w(), std::cos(std::numbers::pi / 4), 1e-15);
  EXPECT_EQ(scene.simulation.obstacles[0].friction, 0.3);
  EXPECT_EQ(scene.simulation.obstacles[0].position, Vec3(0, 1, 0));
  EXPECT_EQ(box.surface->list().triangles.size(), 12u);
  EXPECT_NEAR(volume(*box.surface), 0.5 * 1 * 1.5, 1e-12);  // of 1 x 2 x 3 m, half as large
  EXPECT_TRUE(box.surface->contains({0.2, 0.4, 0.7}));
  EXPECT_FALSE(box.surface->contains({0.3, 0.4, 0.7}));

  EXPECT_TRUE(std::get<MeshDescription>(scene.simulation.obstacles[1].shape).convex);
  EXPECT_EQ(scene.simulation.obstacles[1].path.size(), 2u);
  EXPECT_NEAR(volume(surface(scene, 1)), 6, 1e-12);
  EXPECT_EQ(surface(scene, 1).list().triangles.size(), 12u);  // each of its 6 faces cut in two

  EXPECT_EQ(surface(scene, 2).list().vertices.size(), 4u);  // the fifth is inside
  EXPECT_NEAR(volume(surface(scene, 2)), 1.0 / 6, 1e-15);
  EXPECT_NEAR(volume(surface(scene, 3)), 1.0 / 6, 1e-15);

  // A polygon of n corners has the area n/2 sin(2 pi / n) r^2.
  const double twelve = 6 * std::sin(std::numbers::pi / 6);
  EXPECT_NEAR(volume(surface(scene, 4)), twelve * (0.36 - 0.16) * 0.2, 1e-12);
  EXPECT_FALSE(surface(scene, 4).contains({0, 0, 0}));
  const double forty_eight = 24 * std::sin(std::numbers::pi / 24);
  EXPECT_NEAR(volume(surface(scene, 5)), forty_eight * 0.25 * 0.1, 1e-12);
  EXPECT_EQ(surface(scene, 5).list().vertices.size(), 96u);  // the axis' points are inside faces
}

/// A folder of its own, gone with the test.
class SurfaceFile : public testing::Test {
 protected:
  SurfaceFile() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "scenes/meshes");
  }
  ~SurfaceFile() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  /// Of a scene in scenes/ that has a mesh of this file.
  std::string problems(const std::string& file) const {
    const nlohmann::json scene = {
        {"cloths", {nlohmann::json::object()}},
        {"colliders", {{{"type", "mesh"}, {"position", {0, 0, 0}}, {"file", file}}}}};
    write("scenes/scene.json", scene.dump());
    return problems_of(load((folder_ / "scenes/scene.json").string()));
  }
  const fs::path folder_ =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::string box_ = read_file(fs::path(WEFT_SCENE_TEST_DATA) / "good/box.obj");
};

TEST_F(SurfaceFile, IsFoundBesideAndBelowTheScene) {
  write("scenes/box.obj", box_);
  write("scenes/meshes/box.obj", box_);
  EXPECT_EQ(problems("box.obj"), "");
  EXPECT_EQ(problems("./meshes/box.obj"), "");
}

TEST_F(SurfaceFile, MayNotLieOutsideTheScenesFolder) {
  write("box.obj", box_);
  fs::create_symlink("../box.obj", folder_ / "scenes/link.obj");
  const std::string refusal = "must be a path within the scene file's folder, without \"..\"\n";
  for (const std::string& file : {std::string("../box.obj"), std::string("meshes/../../box.obj"),
                                  (folder_ / "box.obj").string(), std::string()}) {
    EXPECT_EQ(problems(file), "/colliders/0/file: is \"" + file + "\", which " + refusal);
  }
  EXPECT_EQ(problems("link.obj"),
            "/colliders/0/file: is \"link.obj\", which is a link out of the scene file's folder\n");
}

TEST_F(SurfaceFile, SaysWhatIsWrongWithIt) {
  const auto refusal = [&](const std::string& text) {
    write("scenes/bad.obj", text);
    const std::string begin = "/colliders/0/file: is \"bad.obj\", which ", all = problems("bad.obj");
    EXPECT_EQ(all.substr(0, begin.size()), begin);
    return all.substr(std::min(all.size(), begin.size()));
  };
  EXPECT_EQ(problems("none.obj"),
            "/colliders/0/file: is \"none.obj\", which cannot be read: No such file or directory\n");
  EXPECT_EQ(problems("meshes"), "/colliders/0/file: is \"meshes\", which is not a file\n");
  EXPECT_EQ(refusal(""), "has no triangles: \"f\" lines of an OBJ file\n");
  EXPECT_EQ(refusal("{\"cloths\": []}\n"), "has no triangles: \"f\" lines of an OBJ file\n");
  EXPECT_EQ(refusal(std::string("\x7f\x45\x4c\x46\0\0\0", 7)),
            "has no triangles: \"f\" lines of an OBJ file\n");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            "is no solid: the surface is not closed: 3 edges have one triangle, the first at [0, 0, 0]; a "
            "solid has "
            "an inside; \"fill_holes\": true closes it\n");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
            "is no solid: triangle 0 has corner 8; there are 3 vertices, counted from 0\n");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n"),
            "has a vertex beyond 10000 m of the origin, or not finite\n");
  std::string open = box_;
  open.resize(open.rfind("f "));
  EXPECT_EQ(refusal(open).substr(0, 62), "is no solid: the surface is not closed: 4 edges have one trian");
}

TEST_F(SurfaceFile, HolesAreFilledIfItIsToldTo) {
  std::string open = box_;
  open.resize(open.rfind("f "));
  write("scenes/open.obj", open);
  const auto read = [&](const char* fill) {
    write("scenes/filled.json", R"({"cloths": [{}], "colliders": [{"type": "mesh", "file": "open.obj",
                                    "position": [0, 0, 0], "fill_holes": )" +
                                    std::string(fill) + "}]}");
    return load((folder_ / "scenes/filled.json").string());
  };
  const Result filled = read("true");
  ASSERT_TRUE(std::holds_alternative<Scene>(filled));
  EXPECT_EQ(std::get<Scene>(filled).notes, (std::vector<std::string>{"/colliders/0/file: holes filled: 1"}));
  EXPECT_TRUE(std::holds_alternative<std::vector<Problem>>(read("false")));
  EXPECT_TRUE(std::holds_alternative<std::vector<Problem>>(read("1")));
}

TEST_F(SurfaceFile, LargerThanAllowedIsRefusedUnread) {
  write("scenes/large.obj", "");
  fs::resize_file(folder_ / "scenes/large.obj", (64u << 20) + 1);
  EXPECT_EQ(problems("large.obj"),
            "/colliders/0/file: is \"large.obj\", which has 67108865 bytes; at most 67108864 are allowed\n");
}

/// `count` corners on a circle, and a face of them all.
std::string polygon(int count, const char* line_end) {
  std::ostringstream text;
  for (int i = 0; i < count; ++i)
    text << "v " << std::cos(i * 6.28 / count) << ' ' << std::sin(i * 6.28 / count) << " 0" << line_end;
  text << " f";
  for (int i = 1; i <= count; ++i) text << "\t" << i << '/' << i;
  return text.str();
}

TEST_F(SurfaceFile, FacesOfManyCornersAreRefusedBeforeTheyAreCutSlow) {
  // The time to cut one into triangles grows with the square of its corners.
  for (const char* line_end : {"\n", "\r\n", "\r"}) {
    for (const int corners : {129, 1'000'000}) {
      write("scenes/face.obj", polygon(corners, line_end));
      EXPECT_EQ(problems("face.obj"), "/colliders/0/file: is \"face.obj\", which has a face of " +
                                          std::to_string(corners) + " corners in line " +
                                          std::to_string(corners + 1) + "; at most 128 are allowed\n");
    }
    write("scenes/face.obj", polygon(128, line_end));
    EXPECT_NE(problems("face.obj").find("is no solid: the surface is not closed: 128 edges"),
              std::string::npos);
  }
}

TEST_F(SurfaceFile, TrianglesAreCountedBeforeTheyAreRead) {
  std::string text = "v 0 0 0\n";
  for (int i = 0; i <= 500'000; ++i) text += "f 1 1 1 1\n";
  write("scenes/faces.obj", text);
  EXPECT_EQ(
      problems("faces.obj"),
      "/colliders/0/file: is \"faces.obj\", which has 1000002 triangles; at most 1000000 are allowed in a "
      "file\n");
}

TEST(Surfaces, OfAllBodiesTogetherAreBounded) {
  // A ring of 4 points and 25 sides has 2 * 4 * 25 triangles. One of 50 points and 1000 sides, 100,000, would
  // fit alone. It is refused before it is baked, which would take seconds.
  const auto ring = [](int points, int sides) {
    nlohmann::json made = {{"type", "mesh"}, {"position", {0, 0, 0}}};
    for (int i = 0; i < points; ++i) {
      const double angle = 2 * std::numbers::pi * i / points;
      made["lathe"]["outline"].push_back({2 + std::cos(angle), std::sin(angle)});
    }
    made["lathe"]["sides"] = sides;
    return made;
  };
  const nlohmann::json small = ring(4, 25), large = ring(50, 1000);
  const nlohmann::json scene = {{"cloths", {nlohmann::json::object()}}, {"colliders", {small, large, small}}};
  EXPECT_EQ(problems_of(from_json(scene, "rings")),
            "/colliders/1/lathe: has 100000 triangles; at most 100000 are allowed in all of a scene, of "
            "which 99800 "
            "are left\n");
}

}  // namespace
}  // namespace weft::scene::test
