// .obj, .csv, .pc2, .mdd and .usda byte by byte for a mesh of one cell, and what happens when the level
// changes.
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "fixtures.h"

namespace weft::cli::test {
namespace {

class SceneWriterTest : public OutputTest {};

/// 3 x 3 nodes: the middle raised by 8.
MeshFrame peak() {
  MeshFrame frame{7, 0.5, 3, 3, {}, {}};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      frame.positions.insert(frame.positions.end(), {float(c), float(-r), r == 1 && c == 1 ? 8.0f : 0.0f});
    }
  }
  return frame;
}

/// One triangle in its own x-y plane.
BodyMesh triangle() {
  return {"obstacle-0", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 1, 0, 0, 1}, {0, 1, 2}};
}

TEST_F(SceneWriterTest, ObjIsNumberedAndHasQuadsThatFaceTheNormal) {
  write("mesh.obj", {one_cell(0, 0, 0.5f), one_cell(12, 0.2, -2)});
  const std::string rest =
      "vt 0 1\nvt 1 1\nvt 0 0\nvt 1 0\n"
      "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n"
      "f 1/1/1 3/3/3 4/4/4 2/2/2\n";  // counter-clockwise seen from +z
  EXPECT_EQ(bytes("mesh_0000.obj"), "o cloth\nv 0 0 0.5\nv 1 0 0.5\nv 0 -1 0.5\nv 1 -1 0.5\n" + rest);
  EXPECT_EQ(bytes("mesh_0012.obj"), "o cloth\nv 0 0 -2\nv 1 0 -2\nv 0 -1 -2\nv 1 -1 -2\n" + rest);
}

// A quarter turn about y takes x to -z and z to x.
TEST_F(SceneWriterTest, ObjHasEachBodyAsAnObjectWhereItIs) {
  const Pose turned{Vec3(5, 6, 7), Quaternion(Eigen::AngleAxisd(std::acos(-1.0) / 2, Vec3(0, 1, 0)))};
  write("body.obj", {one_cell(0, 0, 0)}, {triangle()}, {turned});
  const std::string file = bytes("body_0000.obj");
  const std::size_t begin = file.find("o obstacle-0\n");
  ASSERT_NE(begin, std::string::npos);
  std::istringstream lines(file.substr(begin));
  std::vector<double> numbers;
  std::string keyword, faces;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    words >> keyword;
    for (double number = 0; keyword[0] == 'v' && words >> number;) numbers.push_back(number);
    if (keyword == "f") faces += line;
  }
  const std::vector<double> expected{5, 6, 7, 5, 6, 6, 5, 7, 7, 1, 0, 0, 1, 0, 0, 1, 0, 0};
  ASSERT_EQ(numbers.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-6) << i;
  EXPECT_EQ(faces, "f 5//5 6//6 7//7");  // after the cloth's four nodes
}

TEST_F(SceneWriterTest, ObjLeavesTornFacesOut) {
  MeshFrame torn = peak();
  torn.torn_faces = {0, 3};
  write("torn.obj", {torn});
  const std::string file = bytes("torn_0007.obj");
  EXPECT_NE(file.find("f 2/2/2 5/5/5 6/6/6 3/3/3\nf 4/4/4 7/7/7 8/8/8 5/5/5\n"),
            std::string::npos);  // faces 1 and 2
  EXPECT_EQ(std::count(file.begin(), file.end(), 'f'), 2);
}

TEST_F(SceneWriterTest, CsvHasALineForEachNode) {
  MeshFrame without_velocities = one_cell(1, 1.0 / 60, 0.1f);
  without_velocities.velocities.clear();
  write("mesh.csv", {one_cell(0, 0, 0), without_velocities});
  EXPECT_EQ(bytes("mesh.csv"),
            "frame,time,row,col,x,y,z,vx,vy,vz\n"
            "0,0,0,0,0,0,0,0,0,1\n"
            "0,0,0,1,1,0,0,0,0,2\n"
            "0,0,1,0,0,-1,0,0,0,3\n"
            "0,0,1,1,1,-1,0,0.5,-0.25,4\n"
            "1,0.016666666666666666,0,0,0,0,0.1,,,\n"
            "1,0.016666666666666666,0,1,1,0,0.1,,,\n"
            "1,0.016666666666666666,1,0,0,-1,0.1,,,\n"
            "1,0.016666666666666666,1,1,1,-1,0.1,,,\n");
}

// The format as Blender reads it: char[12] "POINTCACHE2\0", int32 version 1, int32 points, float32 start
// frame, float32 sample rate, int32 samples, then float32 x, y, z; all little endian.
TEST_F(SceneWriterTest, Pc2HasItsHeaderAndAllPoints) {
  write("mesh.pc2", {one_cell(3, 0, 0), one_cell(4, 0.1, 1)});
  const std::string file = bytes("mesh.pc2");
  const std::string header("POINTCACHE2\0\1\0\0\0\4\0\0\0\0\0\x40\x40\0\0\x80\x3f\2\0\0\0",
                           32);  // 0x40400000: 3.0f
  ASSERT_EQ(file.size(), 32u + 2 * 4 * 3 * 4);
  EXPECT_EQ(file.substr(0, 32), header);
  float second[12];
  std::memcpy(second, file.data() + 32 + 48, sizeof second);
  EXPECT_EQ(std::vector<float>(second, second + 12), one_cell(4, 0.1, 1).positions);
}

TEST_F(SceneWriterTest, Pc2KeepsTheFirstFramesGrid) {
  write("fine.pc2", {peak(), one_cell(8, 1, 2)});
  const std::string file = bytes("fine.pc2");
  ASSERT_EQ(file.size(), 32u + 2 * 9 * 3 * 4);
  float nodes[27];
  std::memcpy(nodes, file.data() + 32 + sizeof nodes, sizeof nodes);
  EXPECT_EQ(std::vector<float>(nodes + 12, nodes + 15),
            (std::vector<float>{0.5f, -0.5f, 2}));  // Eq. 8: a cell's middle
}

// As LightWave and Blender have it: int32 samples, int32 points, float32 times, then float32 x, y, z; all big
// endian.
TEST_F(SceneWriterTest, MddHasTimesAndAllPointsBigEndian) {
  write("mesh.mdd", {one_cell(3, 0, 0), one_cell(4, 0.5, 1)});
  const std::string file = bytes("mesh.mdd");
  ASSERT_EQ(file.size(), 8u + 2 * 4 + 2 * 4 * 3 * 4);
  EXPECT_EQ(file.substr(0, 16), std::string("\0\0\0\2\0\0\0\4\0\0\0\0\x3f\0\0\0", 16));  // 0x3f000000: 0.5f
  std::vector<float> second;
  for (std::size_t at = 16 + 48; at < file.size(); at += 4) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word = word << 8 | static_cast<unsigned char>(file[at + i]);
    second.push_back(std::bit_cast<float>(word));
  }
  EXPECT_EQ(second, one_cell(4, 0.5, 1).positions);
}

// A scene that begins anew goes on in the file when it is past what the file has.
TEST_F(SceneWriterTest, MddTimesAscend) {
  write("reset.mdd",
        {one_cell(3, 0, 0), one_cell(4, 0.5, 1), one_cell(0, 0, 2), one_cell(4, 0.5, 3), one_cell(5, 1, 4)});
  const std::string file = bytes("reset.mdd");
  ASSERT_EQ(file.size(), 8u + 3 * 4 + 3 * 4 * 3 * 4);
  EXPECT_EQ(file.substr(0, 20),
            std::string("\0\0\0\3\0\0\0\4\0\0\0\0\x3f\0\0\0\x3f\x80\0\0", 20));  // 0, 0.5, 1
}

TEST_F(SceneWriterTest, NothingThatIsBesideAFileIsLost) {
  for (const std::string name : {"a.mdd", "a.glb", "a.usda"}) {
    const std::string other = path(name + ".spill");
    std::ofstream(other) << "mine";
    write(name, {one_cell(0, 0, 0), one_cell(1, 0.5, 1)});
    EXPECT_EQ(bytes(name + ".spill"), "mine");
  }
}

// USD's text format, attributes as UsdGeomMesh and UsdGeomXformable name them.
TEST_F(SceneWriterTest, UsdaHasSamplesOfCloths) {
  write("mesh.usda", {one_cell(0, 0, 0), one_cell(2, 2.0 / 60, 0.5f)});
  const std::string file = bytes("mesh.usda");
  const std::string version =
      file.substr(file.find("Weft "), file.find("\"\n    endTime") - file.find("Weft "));
  EXPECT_EQ(file, R"(#usda 1.0
(
    defaultPrim = "scene"
    doc = ")" + version +
                      R"("
    endTimeCode = 2
    framesPerSecond = 60
    metersPerUnit = 1
    startTimeCode = 0
    timeCodesPerSecond = 60
    upAxis = "Y"
)

def Xform "scene"
{
    def Mesh "cloth"
    {
        uniform bool doubleSided = 1
        float3[] extent = [(0, -1, 0), (1, 0, 0)]
        float3[] extent.timeSamples = {
            0: [(0, -1, 0), (1, 0, 0)],
            2: [(0, -1, 0.5), (1, 0, 0.5)],
        }
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 2, 3, 1]
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (
            interpolation = "vertex"
        )
        normal3f[] normals.timeSamples = {
            0: [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)],
            2: [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)],
        }
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, -1, 0), (1, -1, 0)]
        point3f[] points.timeSamples = {
            0: [(0, 0, 0), (1, 0, 0), (0, -1, 0), (1, -1, 0)],
            2: [(0, 0, 0.5), (1, 0, 0.5), (0, -1, 0.5), (1, -1, 0.5)],
        }
        texCoord2f[] primvars:st = [(0, 1), (1, 1), (0, 0), (1, 0)] (
            interpolation = "vertex"
        )
        uniform token subdivisionScheme = "none"
        double3 xformOp:translate = (0, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
}
)");
}

TEST_F(SceneWriterTest, UsdaHasTheWayOfABody) {
  const Pose here{Vec3(0.5, 0, 0), Quaternion::Identity()}, there{Vec3(0.5, 1, 0), Quaternion::Identity()};
  write("body.usda", {one_cell(0, 0, 0), one_cell(1, 1, 0), one_cell(2, 2, 0), one_cell(3, 3, 0)},
        {triangle()}, {here, here, here, there});
  const std::string file = bytes("body.usda");
  EXPECT_NE(file.find(R"(
    def Mesh "obstacle_0"
    {
        float3[] extent = [(0, 0, 0), (1, 1, 0)]
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1)] (
            interpolation = "vertex"
        )
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        uniform token subdivisionScheme = "none"
        quatf xformOp:orient = (1, 0, 0, 0)
        double3 xformOp:translate.timeSamples = {
            0: (0.5, 0, 0),
            2: (0.5, 0, 0),
            3: (0.5, 1, 0),
        }
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]
    }
)"),
            std::string::npos)
      << file;
}

TEST_F(SceneWriterTest, UsdaHasSamplesOfFacesWhereTheyTear) {
  MeshFrame first = peak(), torn = peak();
  torn.frame = 8;
  torn.torn_faces = {1, 3};
  write("torn.usda", {first, torn});
  const std::string file = bytes("torn.usda");
  EXPECT_NE(file.find("int[] faceVertexCounts.timeSamples = {\n"
                      "            7: [4, 4, 4, 4],\n            8: [4, 4],\n        }\n"),
            std::string::npos);
  EXPECT_NE(file.find("8: [0, 3, 4, 1, 3, 6, 7, 4],\n"), std::string::npos);
}

// The mean of what is around a node, by area: the peak's middle is symmetric, its corners lie on one face.
TEST(Normals, AreMeansOfFacesByArea) {
  const std::vector<float> normals = normals_of(peak());
  EXPECT_EQ(std::vector<float>(normals.begin() + 12, normals.begin() + 15), (std::vector<float>{0, 0, 1}));
  // Face 0 has (0, 0, 0), (0, -1, 0), (1, -1, 8), (1, 0, 0): half of (1, -1, 8) x (1, 1, 0) = (-8, 8, 2).
  const double length = std::sqrt(8.0 * 8 + 8 * 8 + 2 * 2);
  const std::vector<double> corner{-8 / length, 8 / length, 2 / length};
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(normals[axis], corner[axis], 1e-6);
}

TEST(Normals, TornFacesCountForNothing) {
  MeshFrame torn = peak();
  torn.torn_faces = {0, 1, 2, 3};
  const std::vector<float> normals = normals_of(torn);
  for (std::size_t i = 0; i < normals.size(); i += 3) EXPECT_EQ(normals[i + 1], 1.0f) << i;
}

TEST(BodyMeshes, AreClosedAndFaceOutwards) {
  const double pi = std::acos(-1.0);
  struct Case {
    Shape shape;
    double volume, tolerance;
  };
  // Round ones lie within what they stand for: 32 segments lack 1.6 %.
  for (const Case& each : {Case{Sphere{0.5}, 4 * pi / 3 * 0.125, 0.02}, Case{Box{Vec3(1, 2, 3)}, 48, 1e-6},
                           Case{Capsule{1, 0.5}, pi * 0.25 * 2 + 4 * pi / 3 * 0.125, 0.02}}) {
    const BodyMesh mesh = body_mesh("body", each.shape);
    const auto at = [&](std::size_t corner) {
      const float* vertex = &mesh.positions[std::size_t{3} * mesh.triangles[corner]];
      return Vec3(vertex[0], vertex[1], vertex[2]);
    };
    double volume = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
      volume += at(i).cross(at(i + 1)).dot(at(i + 2)) / 6;
    EXPECT_NEAR(volume / each.volume, 1, each.tolerance) << each.shape.index();
    for (std::size_t i = 0; i < mesh.normals.size(); i += 3) {
      const Vec3 normal(mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]);
      EXPECT_NEAR(normal.norm(), 1, 1e-6);
      EXPECT_GT(normal.dot(Vec3(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2])), 0);
    }
  }
}

// A float has 1 mm there: a fiftieth of a millimetre is not lost, and comes as short as before where it is 0.
TEST_F(SceneWriterTest, CoordinatesAreTheWorldsAsExactAsSimulated) {
  MeshFrame far = one_cell(0, 0, 2e-5f);
  far.place = {10000, -4, 10000};
  write("far.obj", {far});
  write("far.csv", {far});
  EXPECT_TRUE(bytes("far_0000.obj").starts_with("o cloth\nv 10000 -4 10000.00002"));
  EXPECT_NE(bytes("far.csv").find("\n0,0,1,0,10000,-5,10000.00002"), std::string::npos);
  const MeshFrame coarse = on_grid(on_grid(far, 3, 3), 2, 2);
  EXPECT_EQ(coarse.place, far.place);
}

TEST(OnGrid, FinerByEq8) {
  const MeshFrame fine = on_grid(one_cell(0, 0, 1), 3, 3);
  EXPECT_EQ(fine.rows, 3);
  EXPECT_EQ(fine.cols, 3);
  EXPECT_EQ(fine.positions, (std::vector<float>{0, 0,     1, 0.5f, 0,     1, 1, 0,     1,  //
                                                0, -0.5f, 1, 0.5f, -0.5f, 1, 1, -0.5f, 1,  //
                                                0, -1,    1, 0.5f, -1,    1, 1, -1,    1}));
  EXPECT_EQ(fine.velocities[3 * 4 + 2], (1.0f + 2 + 3 + 4) / 4);
}

TEST(OnGrid, CoarserKeepsSharedNodes) {
  EXPECT_EQ(on_grid(peak(), 2, 2).positions, (std::vector<float>{0, 0, 0, 2, 0, 0, 0, -2, 0, 2, -2, 0}));
  EXPECT_EQ(on_grid(on_grid(peak(), 9, 9), 3, 3).positions, peak().positions);
}

TEST(OnGrid, TornFacesAreThoseThatLieInOneOrHaveOne) {
  MeshFrame torn = peak();
  torn.torn_faces = {1};  // above right of four
  EXPECT_EQ(on_grid(torn, 5, 5).torn_faces, (std::vector<std::uint32_t>{2, 3, 6, 7}));
  EXPECT_EQ(on_grid(torn, 2, 2).torn_faces, (std::vector<std::uint32_t>{0}));
}

TEST(OnGrid, OtherClothsAreRefused) {
  EXPECT_THROW(on_grid(peak(), 4, 4), std::invalid_argument);
  EXPECT_THROW(on_grid(peak(), 3, 5), std::invalid_argument);
  EXPECT_THROW(on_grid(peak(), 2, 3), std::invalid_argument);
}

TEST_F(SceneWriterTest, PathsThatCannotBeWrittenAreRefusedAtOnce) {
  for (const std::string extension : {".obj", ".csv", ".pc2", ".mdd", ".glb", ".usda"}) {
    EXPECT_THROW(SceneWriter::open(path("no/such/folder/mesh" + extension), {"scene", {"cloth"}, {}}),
                 std::runtime_error)
        << extension;
  }
  try {
    SceneWriter::open(path("mesh.stl"), {"scene", {"cloth"}, {}});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path("mesh.stl") +
                                ": unknown extension; .obj, .glb, .usda, .pc2, .mdd and .csv can be written");
  }
}

TEST_F(SceneWriterTest, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  std::filesystem::create_symlink("/dev/full", path("mesh.csv"));
  EXPECT_THROW(write("mesh.csv", {one_cell(0, 0, 0)}), std::runtime_error);
}

TEST(MeshWriterPath, NamesTheCloth) {
  EXPECT_EQ(MeshWriter::path_for_cloth("out.csv", "sail"), "out-sail.csv");
  EXPECT_EQ(MeshWriter::path_for_cloth("a/b.c/out.glb", "sail"), "a/b.c/out-sail.glb");
}

}  // namespace
}  // namespace weft::cli::test
