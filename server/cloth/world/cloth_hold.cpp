/// What holds a cloth: hands and pins.
#include <algorithm>
#include <utility>

#include "cloth/levels/lift_nodes.h"
#include "cloth/world/cloth.h"

namespace weft {

template <class Real>
void Cloth<Real>::grab(const Grab& grab) {
  if (grabs_ == nullptr) {
    auto grabs = std::make_unique<Grabs<Real>>();
    grabs_ = grabs.get();
    effects_.push_back(std::move(grabs));
  }
  grabs_->add(grab);
  wake();
}

template <class Real>
bool Cloth<Real>::move_grab(GrabId id, const Vec3& hand) {
  if (grabs_ == nullptr || !grabs_->move(id, hand)) return false;
  wake();
  return true;
}

template <class Real>
bool Cloth<Real>::release(GrabId id) {
  if (grabs_ == nullptr || !grabs_->release(id)) return false;
  if (grabs_->empty()) {
    std::erase_if(effects_, [&](const auto& effect) { return effect.get() == grabs_; });
    grabs_ = nullptr;
  }
  wake();
  return true;
}

template <class Real>
const std::vector<Grab>& Cloth<Real>::grabs() const {
  static const std::vector<Grab> none;
  return grabs_ == nullptr ? none : grabs_->all();
}

template <class Real>
void Cloth<Real>::pin(const Vec2& at) {
  description_.pins.push_back({at.x(), at.x(), at.y(), at.y()});
  set_pins();
}

template <class Real>
bool Cloth<Real>::unpin(const Vec2& at) {
  std::vector<PinRegion>& pins = description_.pins;
  if (pins.empty()) return false;
  const auto distance = [&](const PinRegion& pin) {
    const Vec2 nearest(std::clamp(at.x(), pin.u_min, pin.u_max), std::clamp(at.y(), pin.v_min, pin.v_max));
    return (nearest - at).cwiseProduct(description_.size).norm();
  };
  const auto nearest =
      std::min_element(pins.begin(), pins.end(),
                       [&](const PinRegion& a, const PinRegion& b) { return distance(a) < distance(b); });
  pins.erase(nearest);
  set_pins();
  return true;
}

template <class Real>
void Cloth<Real>::change_pins(double time) {
  if (time < next_pins_) return;
  time_ = time;
  set_pins();
}

template <class Real>
void Cloth<Real>::lift_new_pins(const std::vector<Solid>& solids) {
  if (splits_ == 0 || description_.pins.empty() || solids.empty()) return;
  const double elastic = elastic_energy(), of_nodes = energy_of_nodes();
  if (!weft::lift_new_pins(splits_, seen(solids), particles_)) return;
  if (bag_) bag_->join(particles_);
  // Stretched from chords onto a surface, what is between pins keeps that energy: no motion is to pay for it.
  held_ += elastic_energy() - elastic;
  had_ += elastic_energy() - elastic + energy_of_nodes() - of_nodes;
  hold();
  hand_to_guard();
}

template <class Real>
void Cloth<Real>::hold() {
  const std::vector<PinRegion>& pins = description_.pins;
  pins_ = Pins<Real>(acting(pins, time_, false), time_, particles_, seam());
  next_pins_ = next_change(pins, time_);
  const std::vector<PinRegion> soft = acting(pins, time_, true);
  auto made = soft.empty() ? nullptr : std::make_unique<SoftPins<Real>>(soft, time_, particles_, soft_pins_);
  std::erase_if(effects_, [&](const auto& effect) { return effect.get() == soft_pins_; });
  soft_pins_ = made.get();
  if (made) effects_.insert(effects_.begin() + static_cast<std::ptrdiff_t>(composed_), std::move(made));
}

template <class Real>
void Cloth<Real>::set_pins() {
  guard_.repair(particles_);
  hold();
  make_sheet();  // a plate is clamped where it is held
  integrator_->restart();
  hand_to_guard();
  wake();
}

template void Cloth<float>::grab(const Grab&);
template bool Cloth<float>::move_grab(GrabId, const Vec3&);
template bool Cloth<float>::release(GrabId);
template const std::vector<Grab>& Cloth<float>::grabs() const;
template void Cloth<float>::pin(const Vec2&);
template bool Cloth<float>::unpin(const Vec2&);
template void Cloth<float>::change_pins(double);
template void Cloth<float>::lift_new_pins(const std::vector<Solid>&);
template void Cloth<float>::hold();
template void Cloth<float>::set_pins();
template void Cloth<double>::grab(const Grab&);
template bool Cloth<double>::move_grab(GrabId, const Vec3&);
template bool Cloth<double>::release(GrabId);
template const std::vector<Grab>& Cloth<double>::grabs() const;
template void Cloth<double>::pin(const Vec2&);
template bool Cloth<double>::unpin(const Vec2&);
template void Cloth<double>::change_pins(double);
template void Cloth<double>::lift_new_pins(const std::vector<Solid>&);
template void Cloth<double>::hold();
template void Cloth<double>::set_pins();

}  // namespace weft
