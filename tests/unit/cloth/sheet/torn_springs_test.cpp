// Springs that are cut, and which ones break.
#include <gtest/gtest.h>

#include "cloth/kernels/implicit_kernels.h"
#include "cloth/sheet/tear/tearing.h"
#include "cloth/sheet/tear/walls.h"
#include "cloth/solver/multigrid.h"
#include "fixtures.h"
#include "tears.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;
using test::some_links;

constexpr BaseCells kSheetBase = test::kTornBase;

struct TornSheet {
  Walls walls{kSheetBase, 3};
  std::shared_ptr<const TornLinks> torn;
  VectorField<double> position{kSheetBase.at(3)};

  TornSheet() {
    for (const Link& link : some_links(3, 60, 3)) walls.add(3, link);
    torn = std::make_shared<const TornLinks>(walls.at(3));
    test::randomise(position, -1, 1, 5);
  }
  Springs<double> springs(double damping_time, bool limited) const {
    Springs<double> made(test::stiffnesses(500, 200, 50), Discretization::continuum, {1, 2}, position.grid(),
                         damping_time, limited);
    made.tear(torn);
    return made;
  }
  bool is_cut(const test::ListedSpring& s) const { return torn->torn(s.r0, s.c0, s.r1 - s.r0, s.c1 - s.c0); }
};

TEST(TornSprings, DoNotCountAsMoving) {
  const TornSheet sheet;
  Particles<double> particles(sheet.position.grid());
  particles.position = sheet.position;
  test::randomise(particles.velocity, -5, 5, 6);
  for (const bool torn : {false, true}) {
    Springs<double> springs = sheet.springs(0, false);
    if (!torn) springs.tear(nullptr);
    kernels::SpringMotion expected;
    for (const SpringFamily& family : springs.families()) {
      if (std::max(std::abs(family.rows), std::abs(family.cols)) == 2) continue;  // bending
      for (const auto& s : test::list_springs({family}, particles.grid())) {
        if (torn && sheet.is_cut(s)) continue;
        const double length =
            (get(particles.position, s.r0, s.c0) - get(particles.position, s.r1, s.c1)).norm();
        const double speed =
            (get(particles.velocity, s.r0, s.c0) - get(particles.velocity, s.r1, s.c1)).norm();
        expected.strain = std::max(expected.strain, std::abs(length - s.rest_length) / s.rest_length);
        expected.speed = std::max(expected.speed, speed / s.rest_length);
      }
    }
    const kernels::SpringMotion found = springs.motion(particles);
    EXPECT_NEAR(found.strain, expected.strain, 1e-13 * expected.strain) << torn;
    EXPECT_NEAR(found.speed, expected.speed, 1e-13 * expected.speed) << torn;
  }
}

TEST(TornSprings, PushAndHoldWhatTheOthersDo) {
  const TornSheet sheet;
  for (const bool limited : {false, true}) {
    const Springs<double> springs = sheet.springs(0, limited);
    VectorField<double> force(sheet.position.grid()), expected(sheet.position.grid());
    springs.add_forces(sheet.position, force);
    double energy = 0;
    int cut = 0;
    for (const SpringFamily& family : springs.families()) {
      for (const auto& s : test::list_springs({family}, sheet.position.grid())) {
        cut += sheet.is_cut(s) ? 1 : 0;
        if (sheet.is_cut(s)) continue;
        const Vec3 d = get(sheet.position, s.r0, s.c0) - get(sheet.position, s.r1, s.c1);
        const Vec3 f = spring_force(d, s.rest_length, s.stiffness, family.limit);
        set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + f);
        set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - f);
        energy += spring_energy(d, s.rest_length, s.stiffness, family.limit);
      }
    }
    EXPECT_GT(cut, 100);
    EXPECT_LT(test::largest_difference(force, expected), 1e-9);
    EXPECT_NEAR(springs.energy(sheet.position), energy, 1e-9 * energy);
  }
}

TEST(TornSprings, AreDampedWhereTheyAreWhole) {
  const TornSheet sheet;
  const Springs<double> springs = sheet.springs(0.01, false);
  VectorField<double> change(sheet.position.grid()), force(sheet.position.grid()),
      expected(sheet.position.grid());
  test::randomise(change, -1, 1, 9);
  springs.add_damping(sheet.position, kernels::components(std::as_const(change)), force);
  for (const auto& s : test::list_springs(springs.families(), sheet.position.grid())) {
    if (sheet.is_cut(s)) continue;
    const Vec3 n = (get(sheet.position, s.r0, s.c0) - get(sheet.position, s.r1, s.c1)).normalized();
    const Vec3 f = -0.01 * s.stiffness * n * n.dot(get(change, s.r0, s.c0) - get(change, s.r1, s.c1));
    set(expected, s.r0, s.c0, get(expected, s.r0, s.c0) + f);
    set(expected, s.r1, s.c1, get(expected, s.r1, s.c1) - f);
  }
  EXPECT_LT(test::largest_difference(force, expected), 1e-9);
}

TEST(TornSprings, AreNoPartOfTheLinearisation) {
  const TornSheet sheet;
  const Grid& grid = sheet.position.grid();
  Multigrid<double> system(grid, true);
  auto& links = system.finest().matrix.links;
  NodeArrays<double> fields(grid, 3);
  const auto position = fields.vector(0);
  std::copy_n(sheet.position.x.row(0), grid.size(), position.x);
  std::copy_n(sheet.position.y.row(0), grid.size(), position.y);
  std::copy_n(sheet.position.z.row(0), grid.size(), position.z);
  sheet.springs(0, false).linearise(grid, position, links);
  const auto stiff = [&](const kernels::SpringLinks<double>& link, std::size_t i) {
    return std::abs(link.a[i]) + std::abs(link.x[i]) + std::abs(link.y[i]) + std::abs(link.z[i]);
  };
  each_node(grid, [&](int r, int c) {
    const auto check = [&](const kernels::SpringLinks<double>& link, int rows, int cols) {
      if (r + rows >= grid.rows || c + cols >= grid.cols || c + cols < 0) return;
      EXPECT_EQ(stiff(link, grid.index(r, c)) == 0, sheet.torn->torn(r, c, rows, cols)) << r << ' ' << c;
    };
    check(links.along_u, 0, 1);
    check(links.along_v, 1, 0);
    check(links.falling, 1, 1);
    check(links.rising, 1, -1);
    check(links.bending_u, 0, 2);
    check(links.bending_v, 2, 0);
  });
}

// --- What breaks ---

TEST(LinkLoads, AreTheTensionPerMetreOfAnEvenlyStretchedSheet) {
  // 1 m x 2 m, stretched by 2 % along v alone: structural springs Y e, a diagonal at 45 degrees e / 2 longer
  // with k = G, two a cell, sin^2 45 of each per metre across: G e / 2 ... to second order in e.
  constexpr double kStretch = 1e-4, kStiff = 500, kShear = 200;
  VectorField<double> position(kSheetBase.at(3));
  each_node(position.grid(), [&](int r, int c) {
    set(position, r, c, {c / 8.0, -r / 8.0 * (1 + kStretch), 0});
  });
  const Springs<double> springs(test::stiffnesses(kStiff, kShear, 0), Discretization::continuum, {1, 2},
                                position.grid());
  TearingEffect tearing;
  tearing.warp = 2;
  tearing.weft = 4;
  const LinkLoads loads = link_loads(springs, position, tearing);
  // Per cell of width h: 2 diagonals, each of force k (d e / 2) with k = G, d = sqrt(2) h, cos 45 of it along
  // either way: G e h, that is G e per metre both along v and, as nothing gives, along u.
  each_node(position.grid(), [&](int r, int c) {
    const auto node = static_cast<std::size_t>(r * 9 + c);
    if (r + 1 < position.grid().rows) {
      EXPECT_NEAR(loads.v[node] * 4, (kStiff + kShear) * kStretch, 2e-4 * kStretch * kStiff);
    }
    if (c + 1 < position.grid().cols) {
      EXPECT_NEAR(loads.u[node] * 2, kShear * kStretch, 2e-4 * kStretch * kStiff);
    }
  });
}

TEST(LinkLoads, OfALineAddUpToTheForceAcrossIt) {
  const TornSheet sheet;
  const Springs<double> springs = sheet.springs(0, true);
  // Flat and stretched, so that all links of a line point the same way.
  VectorField<double> position(kSheetBase.at(3));
  each_node(position.grid(), [&](int r, int c) {
    set(position, r, c, {c * 0.13, -r * (0.12 + 0.002 * r), 0});
  });
  const LinkLoads loads = link_loads(springs, position, TearingEffect{1, 1});
  for (int r = 0; r + 1 < position.grid().rows; ++r) {
    double sum = 0, expected = 0;
    for (int c = 0; c < 9; ++c) {
      sum += loads.v[static_cast<std::size_t>(r * 9 + c)] / 8 * (c == 0 || c == 8 ? 0.5 : 1);
    }
    for (const SpringFamily& family : springs.families()) {
      if (family.rows != 1) continue;
      for (const auto& s : test::list_springs({family}, position.grid())) {
        if (s.r0 != r || sheet.is_cut(s)) continue;
        // A diagonal's share counts where one of the two links beside it is there to carry it.
        const Vec3 d = get(position, s.r0, s.c0) - get(position, s.r1, s.c1);
        const double force = -spring_force(d, s.rest_length, s.stiffness, family.limit).y();
        double share = 1;
        if (family.cols != 0) {
          share = 0.5 * (sheet.torn->torn(Link{r, s.c0, false}) ? 0 : 1) +
                  0.5 * (sheet.torn->torn(Link{r, s.c1, false}) ? 0 : 1);
        }
        expected += share * force;
      }
    }
    EXPECT_NEAR(sum, expected, 1e-9 * std::abs(expected)) << r;
  }
}

TEST(SurelyHolds, NeverWhereALinkIsLoadedBeyondItsStrength) {
  // Sheets stretched along both ways and sheared, by more and more: it must say no before the first link is
  // loaded beyond its strength, and yes while they are hardly stretched.
  const Springs<double> springs(test::stiffnesses(500, 200, 50), Discretization::continuum, {1, 2},
                                kSheetBase.at(3));
  const TearingEffect tearing{10, 20};
  for (const double shear : {0.0, 0.5, -1.0}) {
    bool beyond = false;
    for (int i = 0; i < 40; ++i) {
      const double stretch = 0.001 * i;
      VectorField<double> position(kSheetBase.at(3));
      each_node(position.grid(), [&](int r, int c) {
        set(position, r, c,
            {(c + shear * stretch * r) / 8.0 * (1 + stretch), -r / 8.0 * (1 + stretch / 2), 0});
      });
      const LinkLoads loads = link_loads(springs, position, tearing);
      const double most = std::max(*std::max_element(loads.u.begin(), loads.u.end()),
                                   *std::max_element(loads.v.begin(), loads.v.end()));
      beyond = beyond || most > 1;
      const bool holds = surely_holds(springs, position, tearing);
      EXPECT_FALSE(holds && most > 1) << stretch;
      EXPECT_TRUE(holds || i >= 5) << stretch;
    }
    EXPECT_TRUE(beyond);
  }
}

LinkLoads even_loads(const Grid& grid, double u, double v) {
  const auto nodes = static_cast<std::size_t>(grid.nodes());
  return {grid, std::vector<double>(nodes, u), std::vector<double>(nodes, v)};
}

TEST(LinksToBreak, NoneWithinTheStrength) {
  const Grid grid = kSheetBase.at(3);
  EXPECT_TRUE(links_to_break(even_loads(grid, 1, 1), nullptr).empty());
}

TEST(LinksToBreak, ATearBeginsAtTheOneThatIsLoadedMost) {
  LinkLoads loads = even_loads(kSheetBase.at(3), 1.2, 1.1);
  loads.v[5 * 9 + 4] = 1.3;
  EXPECT_EQ(links_to_break(loads, nullptr), (std::vector<Link>{{5, 4, false}}));
}

TEST(LinksToBreak, ATearRunsAtBothItsEndsAndNoOtherBegins) {
  LinkLoads loads = even_loads(kSheetBase.at(3), 0, 1.2);
  loads.v[5 * 9 + 3] = loads.v[5 * 9 + 5] = 1.5;
  loads.v[9 * 9 + 1] = 1.9;
  loads.v[5 * 9 + 4] = 0;
  TornLinks torn(kSheetBase.at(3));
  torn.cut({5, 4, false});
  EXPECT_EQ(links_to_break(loads, &torn), (std::vector<Link>{{5, 3, false}, {5, 5, false}}));
}

TEST(LinksToBreak, OverloadNeedsNoTearBesideItButIsTheMostOfItsThread) {
  LinkLoads loads = even_loads(kSheetBase.at(3), 0, 0.5);
  loads.v[4 * 9 + 2] = 2.5;
  loads.v[5 * 9 + 2] = 3;  // the next link of the same thread
  loads.v[9 * 9 + 7] = 2.1;
  loads.v[12 * 9 + 1] = 1.9;
  EXPECT_EQ(links_to_break(loads, nullptr), (std::vector<Link>{{5, 2, false}, {9, 7, false}}));
}

}  // namespace
}  // namespace weft
