// --stats: the header, and figures that follow from the scene by hand.
#include <sstream>

#include "cli/stats_writer.h"
#include "fixtures.h"

namespace weft::cli::test {
namespace {

using Row = std::vector<std::string>;

std::vector<Row> rows_of(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    auto& row = rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
  }
  return rows;
}

using StatsWriterTest = OutputTest;

// A free sheet of 2 m x 2 m, 0.1 kg/m2, one step of 1/60 s in one substep: symplectic Euler gives
// v = g dt and, with n = 1, drops g dt2: v = 0.1635 m/s, y = -0.002725 m. Springs so soft that one substep is
// stable: 8 k / m dt2 = 2.3 of the 4 of the limit.
TEST_F(StatsWriterTest, OneStepOfFreeFall) {
  SimulationDescription description;
  Material& material = description.cloths.emplace_back().material;
  material.structural = 0.1;
  material.shear = material.bending = 0;
  description.effects.emplace_back(GravityEffect{});
  description.integrator = SymplecticEulerDescription{1, 0.9};
  Simulation<float> simulation(description);
  StatsWriter writer(path("stats.csv"), false);
  writer.write(0, simulation);
  simulation.step();
  writer.write(1, simulation);
  writer.finish();
  const std::vector<Row> rows = rows_of(bytes("stats.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0],
            (Row{"frame", "time", "level", "substeps", "milliseconds", "kinetic_energy", "potential_energy",
                 "max_strain", "max_compression", "mean_strain", "nodes_in_contact", "energy_lost",
                 "energy_given_back", "effects_work", "contact_took"}));
  ASSERT_EQ(rows[1].size(), 15u);
  EXPECT_EQ(rows[1][0], "0");
  EXPECT_EQ(rows[1][1], "0");
  EXPECT_EQ(rows[1][2], "6");
  EXPECT_EQ(rows[1][5], "0");
  EXPECT_EQ(rows[2][0], "1");
  EXPECT_EQ(rows[2][1], "0.016666666666666666");
  EXPECT_EQ(rows[2][3], "1");
  EXPECT_GT(std::stod(rows[2][4]), 0);
  EXPECT_NEAR(std::stod(rows[2][5]), 0.5 * 0.4 * 0.1635 * 0.1635, 1e-7);  // m v2 / 2
  EXPECT_NEAR(std::stod(rows[2][6]), -0.4 * 9.81 * 0.002725, 1e-5);       // m g y; float positions
  EXPECT_NEAR(std::stod(rows[2][7]), 0, 1e-5);
  EXPECT_EQ(rows[2][10], "0");
  EXPECT_EQ(rows[2][11], "0") << "not counted of explicit methods";
}

// 2 m x 2 m in 8 x 8 cells of 0.25 m, a corner moved along its row by 0.05 m out, then in: that row's last
// spring is 0.3 m, then 0.2 m long. The last one of the column is sqrt(0.0625 + 0.0025) m = 0.25495 m long
// either way, stretched by 0.0198.
TEST_F(StatsWriterTest, StretchAndCompressionAreTwoColumns) {
  SimulationDescription description;
  ClothDescription& cloth = description.cloths.emplace_back();
  cloth.min_level = cloth.initial_level = 3;
  Simulation<float> simulation(description);
  StatsWriter writer(path("stats.csv"), false);
  for (const float offset : {0.05F, -0.1F}) {
    simulation.cloths()[0].particles().position.x.at(8, 8) += offset;
    writer.write(0, simulation);
  }
  writer.finish();
  const std::vector<Row> rows = rows_of(bytes("stats.csv"));
  EXPECT_NEAR(std::stod(rows[1][7]), 0.2, 1e-6);
  EXPECT_NEAR(std::stod(rows[1][8]), 0, 1e-6);
  EXPECT_NEAR(std::stod(rows[2][7]), 0.0198, 1e-4);
  EXPECT_NEAR(std::stod(rows[2][8]), 0.2, 1e-6);
}

TEST_F(StatsWriterTest, SeveralClothsHaveALastColumnWithTheirNames) {
  SimulationDescription description;
  description.cloths.resize(2);
  description.cloths[0].name = "left";
  description.cloths[1].name = "right";
  description.cloths[1].initial_level = 4;
  const Simulation<float> simulation(description);
  StatsWriter writer(path("stats.csv"), true);
  writer.write(0, simulation);
  writer.finish();
  const std::vector<Row> rows = rows_of(bytes("stats.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].back(), "cloth");
  EXPECT_EQ(rows[1].back(), "left");
  EXPECT_EQ(rows[2].back(), "right");
  EXPECT_EQ(rows[2][2], "4");
}

}  // namespace
}  // namespace weft::cli::test
