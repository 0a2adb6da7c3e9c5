#include "cloth/contact/ball_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/kernels/contact_kernels.h"

namespace weft {
namespace {

/// Projections onto one ball after another before a node between overlapping balls is led straight out of all
/// of them.
constexpr int kProjections = 4;

/// A ball where it is at the end of the substep.
struct PlacedBall {
  Vec3 centre;
  double radius;
  double squared_radius;
};

/// One node's state while it is resolved.
template <class Real>
class Node {
 public:
  Node(Particles<Real>& particles, int row, int col)
      : particles_(particles), row_(row), col_(col), position_(particles.position_at(row, col)) {}

  std::size_t index() const { return particles_.grid().index(row_, col_); }
  const Vec3& position() const { return position_; }
  bool inside(const PlacedBall& ball) const {
    return (position_ - ball.centre).squaredNorm() < ball.squared_radius;
  }

  /// To from + distance * direction, and beyond it by what rounding may take back, so that it ends up
  /// outside.
  void put_outside(const PlacedBall& ball, const Vec3& from, const Vec3& direction, double distance) {
    double margin =
        (from.cwiseAbs().sum() + distance + ball.radius) * double(std::numeric_limits<Real>::epsilon()) / 2;
    do {
      set_position(from + (distance + margin) * direction);
      margin *= 2;
    } while (inside(ball));
  }

  /// Takes away the velocity, relative to the ball's, that points against `normal`, and what friction then
  /// takes of the rest, with its way in the substep's seconds; `impulse` gets the momentum if the ball is
  /// dynamic. True if friction moved it.
  bool stop_inward_velocity(const Ball& ball, const Vec3& normal, double seconds, Vec3& impulse) {
    const Vec3 velocity = particles_.velocity_at(row_, col_);
    const Vec3 relative = velocity - ball.velocity;
    const double inward = relative.dot(normal);
    if (!(inward < 0)) return false;
    Vec3 lost = inward * normal;
    const Vec3 sliding = relative - lost;
    const double speed = ball.friction > 0 ? sliding.norm() : 0.0;
    if (speed > 0) {
      const Vec3 held = std::min(1.0, -ball.friction * inward / speed) * sliding;
      set_position(position_ - seconds * held);
      lost += held;
    }
    const Vec3 stopped = velocity - lost;
    particles_.velocity.x.at(row_, col_) = static_cast<Real>(stopped.x());
    particles_.velocity.y.at(row_, col_) = static_cast<Real>(stopped.y());
    particles_.velocity.z.at(row_, col_) = static_cast<Real>(stopped.z());
    if (ball.motion == BallDescription::Motion::dynamic) {
      impulse += double(particles_.mass.at(row_, col_)) * lost;
    }
    return speed > 0;
  }

 private:
  void set_position(const Vec3& target) {
    particles_.position.x.at(row_, col_) = static_cast<Real>(target.x());
    particles_.position.y.at(row_, col_) = static_cast<Real>(target.y());
    particles_.position.z.at(row_, col_) = static_cast<Real>(target.z());
    position_ = particles_.position_at(row_, col_);
  }

  Particles<Real>& particles_;
  int row_, col_;
  Vec3 position_;
};

/// From the centre to the point; upwards at the very centre.
Vec3 outwards(const Vec3& centre, const Vec3& point) {
  const Vec3 offset = point - centre;
  const double length = offset.norm();
  return length > 0 ? Vec3(offset / length) : Vec3(0, 1, 0);
}

/// Where the ray from `origin`, which lies in the ball, leaves it: the distance along the unit `direction`.
double way_out(const PlacedBall& ball, const Vec3& origin, const Vec3& direction) {
  const Vec3 offset = origin - ball.centre;
  const double along = offset.dot(direction);
  return -along + std::sqrt(std::max(0.0, along * along - offset.squaredNorm() + ball.squared_radius));
}

/// Brings a node that is inside some ball out of all of them; false if it is in none.
template <class Real>
bool resolve_node(Node<Real>& node, const std::vector<Ball>& balls, const std::vector<PlacedBall>& placed,
                  double seconds, std::vector<Vec3>& impulses, std::vector<Touch>& touches) {
  Vec3 middle(0, 0, 0);  // of the balls it was found in
  int found = 0;
  for (int round = 0; round < kProjections; ++round) {
    bool moved = false;
    for (std::size_t b = 0; b < placed.size(); ++b) {
      if (!node.inside(placed[b])) continue;
      Vec3 normal = outwards(placed[b].centre, node.position());
      const bool held = node.stop_inward_velocity(balls[b], normal, seconds, impulses[b]);
      if (held) normal = outwards(placed[b].centre, node.position());
      node.put_outside(placed[b], placed[b].centre, normal, placed[b].radius);
      if (round == 0) touches.push_back({node.index(), balls[b].id});
      middle += placed[b].centre;
      ++found;
      moved = true;
    }
    if (!moved || placed.size() == 1) return found > 0;  // outside the only ball there is
  }
  // Overlapping balls hand it to each other. Along a ray away from them no ball is entered twice.
  middle /= found;
  const Vec3 direction = outwards(middle, node.position());
  for (bool moved = true; moved;) {
    moved = false;
    for (const PlacedBall& ball : placed) {
      if (!node.inside(ball)) continue;
      const Vec3 origin = node.position();
      node.put_outside(ball, origin, direction, way_out(ball, origin, direction));
      moved = true;
    }
  }
  return true;
}

}  // namespace

template <class Real>
int BallContact<Real>::resolve(Particles<Real>& particles, const std::vector<Ball>& balls,
                               const Substep& substep) {
  touches_.clear();
  const std::vector<TileBallPair>& pairs =
      broad_phase_.find_pairs(particles.position, balls, substep.from, substep.to);
  if (pairs.empty()) return 0;
  std::vector<PlacedBall> placed;
  placed.reserve(balls.size());
  for (const Ball& ball : balls)
    placed.push_back({ball.at(substep.to), ball.radius, ball.radius * ball.radius});

  const Grid& grid = particles.grid();
  const kernels::Components<const Real> position = kernels::components(particles.position);
  int in_contact = 0;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].tile == pairs[begin].tile) ++end;
    const Tile& tile = broad_phase_.tiles()[static_cast<std::size_t>(pairs[begin].tile)];
    ++counters_.tiles_examined;
    // A border node that two tiles share is looked at in the one below or to the right, whose box holds it as
    // well.
    const int rows = (tile.row_end == grid.rows ? tile.row_end : tile.row_end - 1) - tile.row_begin;
    const int cols = (tile.col_end == grid.cols ? tile.col_end : tile.col_end - 1) - tile.col_begin;
    const std::size_t first = grid.index(tile.row_begin, tile.col_begin);
    const kernels::Components<const Real> corner{position.x + first, position.y + first, position.z + first};
    std::uint32_t struck = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const PlacedBall& ball = placed[static_cast<std::size_t>(pairs[i].ball)];
      struck |=
          kernels::rows_inside(corner, rows, grid.stride, cols,
                               {ball.centre.x(), ball.centre.y(), ball.centre.z(), ball.squared_radius});
    }
    counters_.nodes_tested += static_cast<std::uint64_t>(rows * cols);
    for (int r = 0; r < rows; ++r) {
      if ((struck >> r & 1U) == 0) continue;
      for (int c = 0; c < cols; ++c) {
        if (particles.inverse_mass.at(tile.row_begin + r, tile.col_begin + c) == Real(0)) continue;
        Node<Real> node(particles, tile.row_begin + r, tile.col_begin + c);
        if (resolve_node(node, balls, placed, substep.seconds, impulses_, touches_)) ++in_contact;
      }
    }
  }
  counters_.nodes_in_contact += static_cast<std::uint64_t>(in_contact);
  return in_contact;
}

template class BallContact<float>;
template class BallContact<double>;

}  // namespace weft
