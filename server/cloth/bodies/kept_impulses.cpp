#include "cloth/bodies/kept_impulses.h"

#include <algorithm>
#include <map>

namespace weft {
namespace {

/// Of the smaller inner radius: contacts no farther apart are the same.
constexpr double kSamePlace = 0.1;

/// Pinned nodes are none of the solids, and come and go.
bool is_between(const BodyContact& contact, const std::vector<Solid>& solids) {
  return static_cast<std::size_t>(contact.b) < solids.size();
}

Vec3 place_of(const BodyContact& contact, const Solid& a) { return a.rotation.transpose() * contact.arm_a; }

}  // namespace

void KeptImpulses::keep_sleeping(const std::vector<Solid>& solids) {
  std::map<ColliderId, bool> yields;
  for (const Solid& solid : solids) yields.emplace(solid.id, solid.yields());
  const auto still = [&](ColliderId id) {
    const auto solid = yields.find(id);
    return solid != yields.end() && !solid->second;
  };
  std::erase_if(kept_, [&](const Kept& kept) { return !still(kept.pair.first) || !still(kept.pair.second); });
}

void KeptImpulses::keep(const std::vector<BodyContact>& contacts, const std::vector<BodyImpulse>& impulses,
                        const std::vector<Solid>& solids, double dt) {
  keep_sleeping(solids);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const BodyContact& contact = contacts[i];
    const BodyImpulse& impulse = impulses[i];
    if (!is_between(contact, solids) || impulse.along == 0) continue;
    const Solid &a = solids[static_cast<std::size_t>(contact.a)],
                &b = solids[static_cast<std::size_t>(contact.b)];
    kept_.push_back({{a.id, b.id}, place_of(contact, a), impulse.along / dt, impulse.rubbing / dt});
  }
  std::stable_sort(kept_.begin(), kept_.end(), [](const Kept& p, const Kept& q) { return p.pair < q.pair; });
}

void KeptImpulses::start(std::vector<BodyContact>& contacts, const std::vector<Solid>& solids,
                         double dt) const {
  std::vector<char> told(kept_.size(), 0);
  for (BodyContact& contact : contacts) {
    if (!is_between(contact, solids)) continue;
    const Solid &a = solids[static_cast<std::size_t>(contact.a)],
                &b = solids[static_cast<std::size_t>(contact.b)];
    const Vec3 place = place_of(contact, a);
    const double same = kSamePlace * std::min(inner_radius(a.shape), inner_radius(b.shape));
    double nearest = same * same;
    const std::pair pair{a.id, b.id};
    const auto first = std::lower_bound(kept_.begin(), kept_.end(), pair,
                                        [](const Kept& kept, const auto& of) { return kept.pair < of; });
    std::size_t found = kept_.size();
    for (auto k = static_cast<std::size_t>(first - kept_.begin()); k < kept_.size() && kept_[k].pair == pair;
         ++k) {
      if (told[k] != 0) continue;
      const double apart = (kept_[k].place - place).squaredNorm();
      if (apart >= nearest) continue;
      nearest = apart;
      found = k;
    }
    if (found == kept_.size()) continue;
    told[found] = 1;
    const Vec3& rubbing = kept_[found].rubbing;
    contact.start = {kept_[found].along * dt, dt * (rubbing - rubbing.dot(contact.normal) * contact.normal)};
  }
}

}  // namespace weft
