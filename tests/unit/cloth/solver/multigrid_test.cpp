// The implicit step's linear system: its matrix and its solution against Eigen's, its preconditioner's
// symmetry.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "cloth/solver/attached_bodies.h"
#include "cloth/solver/conjugate_gradients.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

struct Case {
  const char* name;
  int rows, cols;
  double bending;
  bool blocks;
  int bodies = 0;       ///< attached
  double rigidity = 0;  ///< N m, of a plate
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

/// A rumpled sheet of 2 m, 5,000 N/m, held by two corners, with random masses; its system in Weft's arrays
/// and, put together spring by spring from springs.h's formula, in Eigen's.
class LinearSystem : public ::testing::TestWithParam<Case> {
 protected:
  LinearSystem()
      : grid_(Grid::with_nodes(GetParam().rows, GetParam().cols)),
        springs_(material(), Discretization::continuum, {2, 2}, grid_),
        plate_(plate()),
        system_(grid_, GetParam().bending > 0, plate_ ? &*plate_ : nullptr),
        unknowns_(3 * grid_.nodes()),
        vectors_(grid_, 9) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto position = vectors_.vector(0);
    each_node(grid_, [&](int r, int c) {
      const std::size_t i = grid_.index(r, c);
      position.x[i] = 2.0 * c / (grid_.cols - 1) + 0.01 * uniform(random);
      position.y[i] = 2.0 * r / (grid_.rows - 1) + 0.01 * uniform(random);
      position.z[i] = 0.01 * uniform(random);
    });
    auto& finest = system_.finest();
    finest.use_blocks(GetParam().blocks);
    springs_.linearise(grid_, position, finest.matrix.links);
    each_node(grid_, [&](int r, int c) {
      const std::size_t i = grid_.index(r, c);
      finest.diagonal()[i] = 1 + 0.5 * uniform(random);
      finest.free()[i] = fixed(r, c) ? 0 : 1;
      if (!GetParam().blocks) return;
      const Vec3 n(uniform(random), uniform(random), uniform(random));
      const Eigen::Matrix3d block = 100 * n * n.transpose();
      const auto& blocks = finest.matrix.blocks;
      blocks.xx[i] = block(0, 0);
      blocks.xy[i] = block(0, 1);
      blocks.xz[i] = block(0, 2);
      blocks.yy[i] = block(1, 1);
      blocks.yz[i] = block(1, 2);
      blocks.zz[i] = block(2, 2);
    });
    if (GetParam().bodies > 0) attach_bodies(random);
    system_.prepare();
    assemble(position);
  }

  /// Each hangs on a patch of 4 x 4 nodes that overlaps with the one before, and on a point between four of
  /// them; the first is light and hangs by its centre, the next ones are heavy and hang by arms of up to half
  /// a metre, so that they turn.
  template <class Random>
  void attach_bodies(Random& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&] {
      const double x = uniform(random), y = uniform(random), z = uniform(random);
      return Vec3(x, y, z);
    };
    AttachedBodies<double>& bodies = system_.bodies();
    const int count = 6 * GetParam().bodies;
    coupling_ = Eigen::MatrixXd::Zero(count, unknowns_);
    own_ = Eigen::MatrixXd::Zero(count, count);
    pull_ = Eigen::VectorXd::Zero(count);
    for (int body = 0; body < GetParam().bodies; ++body) {
      const double inertia = body == 0 ? 1e-3 : 1e3;
      const Vec3 n = vector();
      const Eigen::Matrix3d turning = 100 * (n * n.transpose() + Eigen::Matrix3d::Identity());
      bodies.add(inertia, turning);
      own_.block<3, 3>(6 * body, 6 * body) += inertia * Eigen::Matrix3d::Identity();
      own_.block<3, 3>(6 * body + 3, 6 * body + 3) += turning;
    }
    Particles<double> particles(grid_);
    particles.mass.fill(1);
    particles.inverse_mass.fill(1);
    between_ = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    bodies.detach();
    for (int body = 0; body < GetParam().bodies; ++body) {
      for (int spring = 0; spring < 17; ++spring) {
        const bool between = spring == 16;
        const int r = 3 + spring % 16 / 4, c = 4 + 2 * body + spring % 4;
        const PointId id{grid_.index(r, c), static_cast<std::uint8_t>(between ? 2 * kCellParts + 5 : 0)};
        const ClothPoint<double> point(id, particles);
        const Vec3 n = vector().normalized(), force = vector();
        const Eigen::Matrix3d k = 80 * n * n.transpose() + 20 * Eigen::Matrix3d::Identity();
        const Vec3 arm = body == 0 ? Vec3(0, 0, 0) : Vec3(0.5 * vector());
        bodies.attach(body, point, arm, k, force);
        Eigen::Matrix<double, 3, 6> moves;  // of what is there: shift + turn x arm
        moves << Eigen::Matrix3d::Identity(), turn_to_move(arm);
        own_.block<6, 6>(6 * body, 6 * body) += moves.transpose() * k * moves;
        pull_.segment<6>(6 * body) -= moves.transpose() * force;
        // (1 - u)(1 - v) and so on, at u = 5/8 and v = 2/8 of the cell.
        Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(3, unknowns_);
        const auto weigh = [&](int row, int col, double w) {
          weights.middleCols<3>(3 * (row * grid_.cols + col)) = w * Eigen::Matrix3d::Identity();
        };
        weigh(r, c, between ? 0.375 * 0.75 : 1);
        if (between) {
          weigh(r, c + 1, 0.625 * 0.75);
          weigh(r + 1, c, 0.375 * 0.25);
          weigh(r + 1, c + 1, 0.625 * 0.25);
          between_ += weights.transpose() * k * weights;
          system_.couplings().add({point.nodes(), point.moves(), k});
        }
        coupling_.middleRows<6>(6 * body) += moves.transpose() * k * weights;
        if (between) continue;
        const auto& blocks = system_.finest().matrix.blocks;
        const std::size_t i = grid_.index(r, c);
        blocks.xx[i] += k(0, 0);
        blocks.xy[i] += k(0, 1);
        blocks.xz[i] += k(0, 2);
        blocks.yy[i] += k(1, 1);
        blocks.yz[i] += k(1, 2);
        blocks.zz[i] += k(2, 2);
      }
    }
    bodies.eliminate(vectors_.vector(3));
  }

  /// Times a turn: turn x arm.
  static Eigen::Matrix3d turn_to_move(const Vec3& arm) {
    Eigen::Matrix3d columns;
    for (int axis = 0; axis < 3; ++axis) columns.col(axis) = Vec3::Unit(axis).cross(arm);
    return columns;
  }

  static Material material() {
    Material material;
    material.bending = GetParam().bending;
    return material;
  }
  std::optional<Plate<double>> plate() const {
    if (GetParam().rigidity == 0) return {};
    Field<double> inverse_mass(grid_);
    each_node(grid_, [&](int r, int c) { inverse_mass.at(r, c) = fixed(r, c) ? 0 : 1; });
    const double b = GetParam().rigidity;
    return Plate<double>({b, b / 2, b / 3}, {2, 2}, inverse_mass);
  }
  bool fixed(int r, int c) const { return r == 0 && (c == 0 || c == grid_.cols - 1); }

  void assemble(const kernels::Components<double>& position) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    const auto at = [&](int r, int c) {
      const std::size_t i = grid_.index(r, c);
      return Vec3(position.x[i], position.y[i], position.z[i]);
    };
    for (const test::ListedSpring& spring : test::list_springs(springs_.families(), grid_)) {
      const Vec3 d = at(spring.r0, spring.c0) - at(spring.r1, spring.c1);
      // A compressed spring's sideways push, which would make the matrix indefinite, is left out.
      const double rest_length = std::min(spring.rest_length, d.norm());
      const Eigen::Matrix3d k = spring_stiffness(d, rest_length, spring.stiffness);
      const int i = 3 * (spring.r0 * grid_.cols + spring.c0), j = 3 * (spring.r1 * grid_.cols + spring.c1);
      dense.block<3, 3>(i, i) += k;
      dense.block<3, 3>(j, j) += k;
      dense.block<3, 3>(i, j) -= k;
      dense.block<3, 3>(j, i) -= k;
    }
    if (plate_) {
      plate_->for_each_stencil([&](double stiffness, const auto& nodes) {
        for (const auto& one : nodes) {
          for (const auto& two : nodes) {
            const int i = 3 * (one.row * grid_.cols + one.col), j = 3 * (two.row * grid_.cols + two.col);
            dense.block<3, 3>(i, j) += stiffness * one.weight * two.weight * Eigen::Matrix3d::Identity();
          }
        }
      });
    }
    const auto& finest = system_.finest();
    each_node(grid_, [&](int r, int c) {
      const std::size_t i = grid_.index(r, c);
      const int k = 3 * (r * grid_.cols + c);
      dense.block<3, 3>(k, k) += finest.matrix.diagonal[i] * Eigen::Matrix3d::Identity();
      if (GetParam().blocks) {
        const auto& b = finest.matrix.blocks;
        dense.block<3, 3>(k, k) += Eigen::Matrix3d{
            {b.xx[i], b.xy[i], b.xz[i]}, {b.xy[i], b.yy[i], b.yz[i]}, {b.xz[i], b.yz[i], b.zz[i]}};
      }
      if (!fixed(r, c)) return;
      dense.middleRows(k, 3).setZero();
      dense.middleCols(k, 3).setZero();
    });
    if (GetParam().bodies > 0) dense += between_;
    nodes_alone_ = reference_ = dense;
    if (GetParam().bodies > 0) reference_ -= coupling_.transpose() * own_.inverse() * coupling_;
  }

  /// Random, 0 at the fixed nodes.
  Eigen::VectorXd random_vector(unsigned seed) const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::VectorXd values(unknowns_);
    for (double& value : values) value = uniform(random);
    each_node(grid_, [&](int r, int c) {
      if (fixed(r, c)) values.segment<3>(3 * (r * grid_.cols + c)).setZero();
    });
    return values;
  }
  void put(const Eigen::VectorXd& values, const kernels::Components<double>& field) const {
    each_node(grid_, [&](int r, int c) {
      const std::size_t i = grid_.index(r, c);
      const int k = 3 * (r * grid_.cols + c);
      field.x[i] = values[k];
      field.y[i] = values[k + 1];
      field.z[i] = values[k + 2];
    });
  }
  Eigen::VectorXd take(const kernels::Components<double>& field) const {
    Eigen::VectorXd values(unknowns_);
    each_node(grid_, [&](int r, int c) {
      const std::size_t i = grid_.index(r, c);
      values.segment<3>(3 * (r * grid_.cols + c)) << field.x[i], field.y[i], field.z[i];
    });
    return values;
  }
  Eigen::VectorXd preconditioned(const Eigen::VectorXd& r) {
    put(r, vectors_.vector(3));
    system_.precondition(vectors_.vector(3), vectors_.vector(6));
    return take(vectors_.vector(6));
  }

  Grid grid_;
  Springs<double> springs_;
  std::optional<Plate<double>> plate_;
  Multigrid<double> system_;
  int unknowns_;
  NodeArrays<double> vectors_;
  Eigen::MatrixXd reference_;                     ///< of the nodes, the bodies eliminated
  Eigen::MatrixXd nodes_alone_, coupling_, own_;  ///< the whole: [nodes_alone, -coupling^T; -coupling, own]
  Eigen::VectorXd pull_;                          ///< on the bodies
  Eigen::MatrixXd between_;                       ///< of the points between nodes
};

TEST_P(LinearSystem, MatrixIsTheSpringsOwn) {
  const Eigen::VectorXd x = random_vector(1);
  put(x, vectors_.vector(3));
  const double product = system_.multiply(vectors_.vector(3), vectors_.vector(6));
  const Eigen::VectorXd expected = reference_ * x;
  // Rounding: sums of about 20 terms of size 2e4 in double.
  EXPECT_LT((take(vectors_.vector(6)) - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(product, x.dot(expected), 1e-12 * std::abs(x.dot(expected)));
}

TEST_P(LinearSystem, SolutionIsThatOfSparseCholesky) {
  const Eigen::VectorXd b = random_vector(2);
  Eigen::MatrixXd regular = reference_;
  for (int k = 0; k < unknowns_; ++k) regular(k, k) += regular(k, k) == 0 ? 1 : 0;  // fixed: 1 x = 0
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(regular.sparseView());
  const Eigen::VectorXd expected = factors.solve(b);

  put(b, vectors_.vector(3));
  put(Eigen::VectorXd::Zero(unknowns_), vectors_.vector(6));
  ConjugateGradients<double> solver(grid_);
  const SystemPart<double> part{&solver, &system_, vectors_.vector(3), vectors_.vector(6)};
  const LinearSolveReport report = ConjugateGradients<double>::solve({&part, 1}, {}, {.least = 1e-24}, 500);
  EXPECT_TRUE(report.converged);
  // The last step's energy 1e-24 J on a matrix of at least 0.5 N/m leaves an error of about 1e-12 m, times
  // what the preconditioner's convergence (about 0.7 an iteration) still had to go.
  EXPECT_LT((take(vectors_.vector(6)) - expected).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_P(LinearSystem, PreconditionerIsSymmetricAndPositive) {
  const Eigen::VectorXd a = random_vector(3), b = random_vector(4);
  const Eigen::VectorXd pa = preconditioned(a), pb = preconditioned(b);
  EXPECT_NEAR(a.dot(pb), b.dot(pa), 1e-12 * std::abs(a.dot(pa)));
  EXPECT_GT(a.dot(pa), 0);
  EXPECT_GT(b.dot(pb), 0);
}

// Wherever conjugate gradients stop, the energy x.Ax/2 - b.x is not above that of x = 0, whatever the guess
// was.
TEST_P(LinearSystem, UnfinishedSolutionLosesEnergy) {
  const Eigen::VectorXd b = random_vector(5);
  put(b, vectors_.vector(3));
  ConjugateGradients<double> solver(grid_);
  const SystemPart<double> part{&solver, &system_, vectors_.vector(3), vectors_.vector(6)};
  for (const int iterations : {0, 1, 2, 5}) {
    put(1000 * random_vector(6), vectors_.vector(6));
    ConjugateGradients<double>::solve({&part, 1}, {}, {}, iterations);
    const Eigen::VectorXd x = take(vectors_.vector(6));
    EXPECT_LE(0.5 * x.dot(reference_ * x) - b.dot(x), 0) << iterations;
  }
}

// Nodes and bodies together, by LU of the whole system.
TEST_P(LinearSystem, BodiesMoveAsTheWholeSystemSays) {
  const int count = 6 * GetParam().bodies;
  const int all = unknowns_ + count;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(all, all);
  whole.topLeftCorner(unknowns_, unknowns_) = nodes_alone_;
  if (count > 0) {
    whole.topRightCorner(unknowns_, count) = -coupling_.transpose();
    whole.bottomLeftCorner(count, unknowns_) = -coupling_;
    whole.bottomRightCorner(count, count) = own_;
  }
  for (int k = 0; k < unknowns_; ++k) whole(k, k) += whole(k, k) == 0 ? 1 : 0;  // fixed: 1 x = 0
  Eigen::VectorXd right(all);
  right.head(unknowns_) = random_vector(8);
  if (count > 0) right.tail(count) = pull_;
  const Eigen::VectorXd expected = whole.partialPivLu().solve(right);

  AttachedBodies<double>& bodies = system_.bodies();
  const auto b = vectors_.vector(3), x = vectors_.vector(6);
  put(right.head(unknowns_), b);
  put(Eigen::VectorXd::Zero(unknowns_), x);
  bodies.eliminate(b);
  ConjugateGradients<double> solver(grid_);
  const SystemPart<double> part{&solver, &system_, b, x};
  const LinearSolveReport report = ConjugateGradients<double>::solve({&part, 1}, {}, {.least = 1e-24}, 500);
  const double decrease = report.decrease + bodies.find_changes(x);
  EXPECT_TRUE(report.converged);
  // As above for the nodes alone; the light body's moves are as large as its nodes', of about 0.1 m.
  EXPECT_LT((take(x) - expected.head(unknowns_)).cwiseAbs().maxCoeff(), 1e-10);
  bodies.take_changes();
  for (int body = 0; body < GetParam().bodies; ++body) {
    EXPECT_LT((bodies.move(body) - expected.segment<3>(unknowns_ + 6 * body)).norm(), 1e-10) << body;
    EXPECT_LT((bodies.turn(body) - expected.segment<3>(unknowns_ + 6 * body + 3)).norm(), 1e-10) << body;
  }
  EXPECT_NEAR(decrease, right.dot(expected) / 2, 1e-9 * decrease);
}

INSTANTIATE_TEST_SUITE_P(Grids, LinearSystem,
                         ::testing::Values(Case{"square", 17, 17, 0, false},
                                           Case{"bending", 17, 17, 50, false},
                                           Case{"blocks", 17, 17, 50, true}, Case{"wide", 9, 33, 50, true},
                                           Case{"odd", 13, 25, 0, false}, Case{"tall", 33, 5, 50, false},
                                           Case{"cannot_coarsen", 8, 6, 0, true},
                                           Case{"bodies", 17, 17, 50, true, 2},
                                           Case{"plate", 17, 17, 0, false, 0, 1.0},
                                           Case{"plate_and_all", 17, 33, 50, true, 2, 0.01},
                                           Case{"small_plate", 8, 6, 0, false, 0, 1.0}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace weft
