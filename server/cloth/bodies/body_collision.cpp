#include "cloth/bodies/body_collision.h"

#include <algorithm>
#include <span>
#include <utility>

#include "cloth/bodies/body_geometry.h"
#include "cloth/bodies/body_meeting.h"
#include "cloth/shapes/box_tree.h"

namespace weft {
namespace {

using Pair = std::pair<int, int>;

/// Of two solids' contacts these are enough to hold them.
constexpr std::size_t kMostContacts = 8;
/// Of a body's outer radius: how strongly a surface must be curved for its nearest points to be kept, not its
/// farthest. A ball's is 1, a face has none.
constexpr double kRoundness = 2;

Eigen::AlignedBox3d swept_box(const Solid& solid) {
  Eigen::AlignedBox3d box = solid.placed(1).bounds().merged(solid.placed(0).bounds());
  double more = kBodyMargin * inner_radius(solid.shape);
  if (solid.turns()) more += solid.turn.norm() * outer_radius(solid.shape);
  return {box.min() - Vec3::Constant(more), box.max() + Vec3::Constant(more)};
}

bool add_overlap(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* pairs) {
  static_cast<std::vector<Pair>*>(pairs)->emplace_back(BoxTree::index_of(a), BoxTree::index_of(b));
  return false;  // go on
}

/// Of the contacts from `first` on keeps the deepest and then, again and again, the one that is farthest from
/// all that is kept: of squared distance counts what is more than `width`, m, times what its gap is wider
/// than the deepest's. With none a face is held at its corners, with one what is round by what is right below
/// it.
void thin_out(std::vector<BodyContact>& contacts, std::size_t first, double width) {
  const auto begin = contacts.begin() + static_cast<std::ptrdiff_t>(first);
  if (contacts.size() - first <= kMostContacts) return;
  const auto deepest = std::min_element(
      begin, contacts.end(), [](const BodyContact& p, const BodyContact& q) { return p.gap < q.gap; });
  std::iter_swap(begin, deepest);
  for (std::size_t kept = 1; kept < kMostContacts; ++kept) {
    const auto end = begin + static_cast<std::ptrdiff_t>(kept);
    const auto worth = [&](const BodyContact& c) {
      double nearest = (c.arm_a - begin->arm_a).squaredNorm();
      for (auto k = begin; k != end; ++k) nearest = std::min(nearest, (c.arm_a - k->arm_a).squaredNorm());
      return nearest - width * (c.gap - begin->gap);
    };
    std::iter_swap(end, std::max_element(end, contacts.end(),
                                         [&](const auto& p, const auto& q) { return worth(p) < worth(q); }));
  }
  contacts.resize(first + kMostContacts);
}

}  // namespace

struct BodyCollision::Impl {
  /// The pairs that may meet, one of each yields, a half-space or a pinned node second, in the order of
  /// `find`.
  bool find_pairs(const std::vector<Solid>& solids, const std::vector<PinnedNode>& pins) {
    pairs.clear();
    bounded.clear();
    for (std::size_t i = 0; i < solids.size(); ++i) {
      if (is_half_space(solids[i])) continue;
      const Eigen::AlignedBox3d box = swept_box(solids[i]);
      if (!box.min().allFinite() || !box.max().allFinite()) return false;
      bounded.push_back(static_cast<int>(i));
    }
    tree.resize(bounded.size());
    for (std::size_t i = 0; i < bounded.size(); ++i) {
      tree.set(i, swept_box(solids[static_cast<std::size_t>(bounded[i])]));
    }
    tree.update();
    tree.manager().collide(&pairs, add_overlap);
    for (Pair& pair : pairs) {
      pair = std::minmax(bounded[static_cast<std::size_t>(pair.first)],
                         bounded[static_cast<std::size_t>(pair.second)]);
    }
    for (const int i : bounded) {
      for (std::size_t j = 0; j < solids.size(); ++j) {
        if (is_half_space(solids[j])) pairs.emplace_back(i, static_cast<int>(j));
      }
    }
    for (std::size_t i = 0; i < pins.size(); ++i) {
      pairs.emplace_back(static_cast<int>(pins[i].solid), static_cast<int>(solids.size() + i));
    }
    const auto solid = [&](int i) -> const Solid& { return of(i, solids, pins); };
    std::erase_if(pairs,
                  [&](const Pair& p) { return !solid(p.first).yields() && !solid(p.second).yields(); });
    const auto firmness = [&](const Pair& p) {
      const Solid &a = solid(p.first), &b = solid(p.second);
      return is_firm(a, b) ? 2 : a.yields() && b.yields() ? 0 : 1;
    };
    std::sort(pairs.begin(), pairs.end(), [&](const Pair& p, const Pair& q) {
      return std::make_pair(firmness(p), p) < std::make_pair(firmness(q), q);
    });
    return true;
  }

  static const Solid& of(int index, const std::vector<Solid>& solids, const std::vector<PinnedNode>& pins) {
    const auto i = static_cast<std::size_t>(index);
    return i < solids.size() ? solids[i] : pins[i - solids.size()].node;
  }

  BoxTree tree;
  std::vector<int> bounded;  ///< solids in the tree
  std::vector<Pair> pairs;
  BodyGeometry geometry;
  std::vector<BodyContact> contacts;
};

BodyCollision::BodyCollision() : impl_(std::make_unique<Impl>()) {}
BodyCollision::~BodyCollision() = default;

const std::vector<BodyContact>& BodyCollision::found() const { return impl_->contacts; }

const std::vector<BodyContact>& BodyCollision::find(const std::vector<Solid>& solids, double dt,
                                                    const std::vector<PinnedNode>& pins) {
  std::vector<BodyContact>& contacts = impl_->contacts;
  contacts.clear();
  if (!impl_->find_pairs(solids, pins)) return contacts;
  // All pinned nodes beside a body are one thing that holds it.
  const auto same = [&](const Pair& p, const Pair& q) {
    const int count = static_cast<int>(solids.size());
    return p.first == q.first && std::min(p.second, count) == std::min(q.second, count);
  };
  for (auto begin = impl_->pairs.begin(), end = begin; begin != impl_->pairs.end(); begin = end) {
    end = std::find_if(begin, impl_->pairs.end(), [&](const Pair& p) { return !same(*begin, p); });
    const std::size_t first = contacts.size();
    const Solid& a = solids[static_cast<std::size_t>(begin->first)];
    for (const Pair& pair : std::span(begin, end)) {
      add_contacts(a, Impl::of(pair.second, solids, pins), pair, dt, impl_->geometry, contacts);
    }
    const bool pinned = is_pinned_node(Impl::of(begin->second, solids, pins));
    thin_out(contacts, first, pinned ? kRoundness * 2 * outer_radius(a.shape) : 0);
  }
  return contacts;
}

}  // namespace weft
