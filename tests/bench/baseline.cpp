#include "baseline.h"

#include <cmath>
#include <stdexcept>

namespace weft::bench {
namespace {

template <class Real>
Vector<Real> operator+(Vector<Real> a, Vector<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
Vector<Real> operator-(Vector<Real> a, Vector<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
Vector<Real> operator*(Real s, Vector<Real> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
Real dot(Vector<Real> a, Vector<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
Vector<Real> vector(const Vec3& v) {
  return {static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z())};
}

}  // namespace

template <class Real>
Baseline<Real>::Baseline(const Simulation<Real>& simulation, int substeps)
    : colliders_(simulation.colliders()),
      substeps_(substeps),
      time_(simulation.time()),
      time_step_(simulation.description().time_step),
      ball_gravity_(simulation.gravity()),
      gravity_(vector<Real>(simulation.gravity())) {
  if (simulation.cloths().size() != 1) throw std::invalid_argument("the baseline steps one cloth");
  const Cloth<Real>& cloth = simulation.cloths().front();
  const ClothDescription& description = cloth.description();
  if (description.discretization != Discretization::paper) {
    throw std::invalid_argument("the baseline has the paper's discretization only");
  }
  for (const EffectDescription& effect : simulation.description().effects) {
    if (std::holds_alternative<DampingEffect>(effect)) {
      damping_ = static_cast<Real>(description.material.damping);
    } else if (const auto* wind = std::get_if<PaperWindEffect>(&effect);
               wind != nullptr && !wind->along_normal) {
      wind_force_ = vector<Real>(wind->factor * simulation.wind().velocity());
    } else if (!std::holds_alternative<GravityEffect>(effect)) {
      throw std::invalid_argument("the baseline has the paper's effects only");
    }
  }
  const Particles<Real>& state = cloth.particles();
  const int rows = state.grid().rows, cols = state.grid().cols;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      Particle<Real> particle;
      particle.position = vector<Real>(state.position_at(r, c));
      particle.velocity = vector<Real>(state.velocity_at(r, c));
      particle.mass = state.mass.at(r, c);
      particle.pinned = state.inverse_mass.at(r, c) == Real(0);
      particles_.push_back(particle);
    }
  }
  connect(rows, cols, description);
}

/// Fig. 1: structural springs to the next particle, shear springs along the diagonals, bending springs to the
/// second.
template <class Real>
void Baseline<Real>::connect(int rows, int cols, const ClothDescription& cloth) {
  const double width = cloth.size.x() / (cols - 1), height = cloth.size.y() / (rows - 1);
  const auto add = [&](int r, int c, int dr, int dc, double stiffness) {
    const int r2 = r + dr, c2 = c + dc;
    if (r2 < 0 || r2 >= rows || c2 < 0 || c2 >= cols || stiffness == 0) return;
    springs_.push_back({static_cast<std::size_t>(r * cols + c), static_cast<std::size_t>(r2 * cols + c2),
                        static_cast<Real>(std::hypot(dr * height, dc * width)),
                        static_cast<Real>(stiffness)});
  };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      add(r, c, 0, 1, cloth.material.structural.warp);
      add(r, c, 1, 0, cloth.material.structural.weft);
      add(r, c, 1, 1, cloth.material.shear);
      add(r, c, 1, -1, cloth.material.shear);
      add(r, c, 0, 2, cloth.material.bending);
      add(r, c, 2, 0, cloth.material.bending);
    }
  }
}

template <class Real>
void Baseline<Real>::step() {
  colliders_.begin_step(time_, time_step_, ball_gravity_);
  for (int s = 0; s < substeps_; ++s) {
    clear_forces();
    add_spring_forces();
    add_other_forces();
    integrate(static_cast<Real>(time_step_ / substeps_));
    collide(static_cast<double>(s + 1) / substeps_);
  }
  colliders_.end_step();
  time_ += time_step_;
}

template <class Real>
void Baseline<Real>::clear_forces() {
  for (Particle<Real>& particle : particles_) particle.force = {};
}

/// Eq. 1.
template <class Real>
void Baseline<Real>::add_spring_forces() {
  for (const Spring<Real>& spring : springs_) {
    Particle<Real>& a = particles_[spring.a];
    Particle<Real>& b = particles_[spring.b];
    const Vector<Real> d = a.position - b.position;
    const Real length = std::sqrt(dot(d, d));
    if (length == Real(0)) continue;
    const Vector<Real> force = (-spring.stiffness * (length - spring.rest_length) / length) * d;
    a.force = a.force + force;
    b.force = b.force - force;
  }
}

/// Eqs. 2, 3 and 4, summed as Eq. 5 says.
template <class Real>
void Baseline<Real>::add_other_forces() {
  for (Particle<Real>& particle : particles_) {
    particle.force = particle.force + particle.mass * gravity_ - damping_ * particle.velocity + wind_force_;
  }
}

/// Eq. 6.
template <class Real>
void Baseline<Real>::integrate(Real h) {
  for (Particle<Real>& particle : particles_) {
    if (particle.pinned) continue;
    particle.acceleration = (Real(1) / particle.mass) * particle.force;
    particle.velocity = particle.velocity + h * particle.acceleration;
    particle.position = particle.position + h * particle.velocity;
  }
}

/// Section 2.4 without its boxes: every particle against every ball, where it is at `fraction` of the step.
template <class Real>
void Baseline<Real>::collide(double fraction) {
  for (const Ball& ball : colliders_.balls()) {
    const Vector<Real> centre = vector<Real>(ball.solid().at(fraction)),
                       velocity = vector<Real>(ball.velocity);
    const Real radius = static_cast<Real>(ball.radius);
    for (Particle<Real>& particle : particles_) {
      if (particle.pinned) continue;
      const Vector<Real> offset = particle.position - centre;
      const Real distance = std::sqrt(dot(offset, offset));
      if (distance >= radius) continue;
      const Vector<Real> normal = distance > 0 ? (Real(1) / distance) * offset : Vector<Real>{0, 1, 0};
      particle.position = centre + radius * normal;
      const Real inward = dot(particle.velocity - velocity, normal);
      if (inward < 0) particle.velocity = particle.velocity - inward * normal;
    }
  }
}

template class Baseline<float>;
template class Baseline<double>;

}  // namespace weft::bench
