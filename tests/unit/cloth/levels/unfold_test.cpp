// Starts that no sheet can have are unfolded before the first step, others are left alone.
#include "cloth/levels/unfold.h"

#include <gtest/gtest.h>

#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

constexpr int kLevel = 5, kNodes = 33;

struct FoldedSheet {
  ClothDescription cloth;
  Particles<double> particles;
  Springs<double> springs;

  FoldedSheet()
      : particles(test::flat_sheet<double>(kNodes, kNodes, cloth.size)),
        springs(cloth.material, cloth.discretization, cloth.size, particles.grid()) {
    test::share_mass(particles, 0.4, Discretization::continuum);
  }
  void place(const std::function<Vec3(const Vec3& flat)>& at) {
    each_node(particles.grid(),
              [&](int r, int c) { set(particles.position, r, c, at(particles.position_at(r, c))); });
  }
  bool tangled() const { return is_tangled(particles, springs); }
  void unfold() { weft::unfold(particles, cloth, kLevel); }
  double strain() const {
    const StructuralStrain strain = springs.structural_strain(particles.position);
    return std::max(strain.max, strain.max_compression);
  }
  Vec3 centre_of_mass() const {
    Vec3 sum(0, 0, 0);
    each_node(particles.grid(),
              [&](int r, int c) { sum += particles.mass.at(r, c) / 0.4 * particles.position_at(r, c); });
    return sum;
  }
};

TEST(Unfold, ASheetThatIsBentGatheredOrPulledIsNotTangled) {
  FoldedSheet flat, rolled, gathered, pulled;
  rolled.place(
      [](const Vec3& p) { return Vec3(0.2 * std::sin(p.x() / 0.2), p.y(), 0.2 * std::cos(p.x() / 0.2)); });
  gathered.place([](const Vec3& p) { return Vec3(p.x() / 2, p.y(), 0); });  // mean strain 0.25
  pulled.place([](const Vec3& p) -> Vec3 { return 1.3 * p; });              // 0.3
  for (const FoldedSheet* sheet : {&flat, &rolled, &gathered, &pulled}) EXPECT_FALSE(sheet->tangled());
}

TEST(Unfold, NodesOnALineOrAPointOrAnywhereAre) {
  FoldedSheet line, point, anywhere;
  line.place([](const Vec3& p) { return Vec3(p.x(), 0, 0); });  // half of the springs have no length: 0.5
  point.place([](const Vec3&) { return Vec3(0, 0, 0); });       // 1
  test::randomise(anywhere.particles.position, -1, 1, 1);
  for (const FoldedSheet* sheet : {&line, &point, &anywhere}) EXPECT_TRUE(sheet->tangled());
}

TEST(Unfold, WhereverTheNodesAreTheSheetIsHardlyStrainedAfterwards) {
  // The hard cases' limit, 5 %, without the three seconds that they leave.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    FoldedSheet sheet;
    test::randomise(sheet.particles.position, -1, 1, seed);
    sheet.unfold();
    EXPECT_LT(sheet.strain(), 0.05) << seed;
  }
  FoldedSheet line, point;
  line.place([](const Vec3& p) { return Vec3(p.x(), 0, 0); });
  point.place([](const Vec3&) { return Vec3(0, 0, 0); });
  for (FoldedSheet* sheet : {&line, &point}) {
    sheet->unfold();
    EXPECT_LT(sheet->strain(), 0.05);
  }
}

TEST(Unfold, AFreeSheetsCentreOfMassAndItsVelocitiesStay) {
  FoldedSheet sheet;
  test::randomise(sheet.particles.position, -1, 1, 1);
  test::randomise(sheet.particles.velocity, -1, 1, 2);
  const Vec3 before = sheet.centre_of_mass();
  const Particles<double> start = sheet.particles;
  sheet.unfold();
  EXPECT_LT((sheet.centre_of_mass() - before).norm(), 1e-12);  // rounding
  EXPECT_TRUE(test::same_bits(sheet.particles.velocity, start.velocity));
}

TEST(Unfold, HeldNodesStayWhereTheyAre) {
  // One of them is a node of the finest level alone.
  FoldedSheet sheet;
  test::randomise(sheet.particles.position, -1, 1, 1);
  const int held[][2] = {{0, 0}, {0, kNodes - 1}, {17, 5}};
  for (const auto& [r, c] : held) sheet.particles.inverse_mass.at(r, c) = 0;
  const Particles<double> start = sheet.particles;
  sheet.unfold();
  for (const auto& [r, c] : held) {
    EXPECT_EQ(get(sheet.particles.position, r, c), get(start.position, r, c));
  }
}

TEST(Unfold, OnlyBeforeTheFirstStep) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.initial_level = cloth.min_level = 4;
  constexpr std::size_t kAll = std::size_t{17} * 17;
  cloth.nodes.assign(kAll, Vec3(0, 0, 0));
  scene.cloths = {cloth};
  scene.integrator = BackwardEulerDescription{};  // remembers no motion
  Simulation<double> simulation(scene);
  EXPECT_EQ(simulation.cloths()[0].particles().position_at(3, 4), Vec3(0, 0, 0));  // frame 0 is the start
  simulation.step();
  const auto strain = [&] {
    const Cloth<double>& now = simulation.cloths()[0];
    return now.springs().structural_strain(now.particles().position).mean;
  };
  EXPECT_LT(strain(), 0.05);
  simulation.cloths()[0].particles().position.fill(0);
  simulation.cloths()[0].particles().velocity.fill(0);
  simulation.step();
  EXPECT_NEAR(strain(), 1, 1e-12);  // coincident nodes have no direction to leave in
}

}  // namespace
}  // namespace weft
