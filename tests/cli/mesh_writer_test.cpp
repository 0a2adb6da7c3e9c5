// .obj, .csv and .pc2 byte by byte for a mesh of one cell, and what happens when the level changes.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "fixtures.h"

namespace weft::cli::test {
namespace {

class MeshWriterTest : public OutputTest {
 protected:
  void write(const std::string& name, const std::vector<MeshFrame>& frames) {
    const auto writer = MeshWriter::open(path(name));
    for (const MeshFrame& frame : frames) writer->write(frame);
    writer->finish();
  }
};

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

TEST_F(MeshWriterTest, ObjIsNumberedAndHasQuadsThatFaceTheNormal) {
  write("mesh.obj", {one_cell(0, 0, 0.5f), one_cell(12, 0.2, -2)});
  const std::string rest =
      "vt 0 1\nvt 1 1\nvt 0 0\nvt 1 0\n"
      "f 1/1 3/3 4/4 2/2\n";  // counter-clockwise seen from +z
  EXPECT_EQ(bytes("mesh_0000.obj"), "v 0 0 0.5\nv 1 0 0.5\nv 0 -1 0.5\nv 1 -1 0.5\n" + rest);
  EXPECT_EQ(bytes("mesh_0012.obj"), "v 0 0 -2\nv 1 0 -2\nv 0 -1 -2\nv 1 -1 -2\n" + rest);
}

TEST_F(MeshWriterTest, ObjLeavesTornFacesOut) {
  MeshFrame torn = peak();
  torn.torn_faces = {0, 3};
  write("torn.obj", {torn});
  const std::string file = bytes("torn_0007.obj");
  EXPECT_NE(file.find("f 2/2 5/5 6/6 3/3\nf 4/4 7/7 8/8 5/5\n"), std::string::npos);  // faces 1 and 2
  EXPECT_EQ(std::count(file.begin(), file.end(), 'f'), 2);
}

TEST_F(MeshWriterTest, CsvHasALineForEachNode) {
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
TEST_F(MeshWriterTest, Pc2HasItsHeaderAndAllPoints) {
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

TEST_F(MeshWriterTest, Pc2KeepsTheFirstFramesGrid) {
  write("fine.pc2", {peak(), one_cell(8, 1, 2)});
  const std::string file = bytes("fine.pc2");
  ASSERT_EQ(file.size(), 32u + 2 * 9 * 3 * 4);
  float nodes[27];
  std::memcpy(nodes, file.data() + 32 + sizeof nodes, sizeof nodes);
  EXPECT_EQ(std::vector<float>(nodes + 12, nodes + 15),
            (std::vector<float>{0.5f, -0.5f, 2}));  // Eq. 8: a cell's middle
}

// A float has 1 mm there: a fiftieth of a millimetre is not lost, and comes as short as before where it is 0.
TEST_F(MeshWriterTest, CoordinatesAreTheWorldsAsExactAsSimulated) {
  MeshFrame far = one_cell(0, 0, 2e-5f);
  far.place = {10000, -4, 10000};
  write("far.obj", {far});
  write("far.csv", {far});
  EXPECT_TRUE(bytes("far_0000.obj").starts_with("v 10000 -4 10000.00002"));
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

TEST(OnGrid, OtherClothsAreRefused) {
  EXPECT_THROW(on_grid(peak(), 4, 4), std::invalid_argument);
  EXPECT_THROW(on_grid(peak(), 3, 5), std::invalid_argument);
  EXPECT_THROW(on_grid(peak(), 2, 3), std::invalid_argument);
}

TEST_F(MeshWriterTest, PathsThatCannotBeWrittenAreRefusedAtOnce) {
  for (const std::string extension : {".obj", ".csv", ".pc2", ".glb"}) {
    EXPECT_THROW(MeshWriter::open(path("no/such/folder/mesh" + extension)), std::runtime_error) << extension;
  }
  try {
    MeshWriter::open(path("mesh.stl"));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(),
              path("mesh.stl") + ": unknown extension; .obj, .pc2, .csv and .glb can be written");
  }
}

TEST_F(MeshWriterTest, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  std::filesystem::create_symlink("/dev/full", path("mesh.csv"));
  const auto writer = MeshWriter::open(path("mesh.csv"));
  writer->write(one_cell(0, 0, 0));
  EXPECT_THROW(writer->finish(), std::runtime_error);
}

TEST(MeshWriterPath, NamesTheCloth) {
  EXPECT_EQ(MeshWriter::path_for_cloth("out.csv", "sail"), "out-sail.csv");
  EXPECT_EQ(MeshWriter::path_for_cloth("a/b.c/out.glb", "sail"), "a/b.c/out-sail.glb");
}

}  // namespace
}  // namespace weft::cli::test
