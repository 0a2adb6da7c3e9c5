#include "cloth/integrators/integrator.h"

#include "cloth/integrators/implicit.h"
#include "cloth/integrators/symplectic_euler.h"
#include "cloth/integrators/xpbd.h"

namespace weft {

AdvanceReport& AdvanceReport::operator+=(const AdvanceReport& next) {
  substeps += next.substeps;
  nodes_in_contact = next.nodes_in_contact;
  linear_iterations += next.linear_iterations;
  forces_seconds += next.forces_seconds;
  contact_seconds += next.contact_seconds;
  check_seconds += next.check_seconds;
  energy_lost += next.energy_lost;
  energy_given_back += next.energy_given_back;
  effects_work += next.effects_work;
  contact_took += next.contact_took;
  gained += next.gained;
  could_give += next.could_give;
  sound = sound && next.sound;
  return *this;
}
namespace {

/// Which class follows which description.
template <class Real>
struct IntegratorMaker {
  using Made = std::unique_ptr<Integrator<Real>>;
  Made operator()(const SymplecticEulerDescription& d) const {
    return std::make_unique<SymplecticEuler<Real>>(d);
  }
  Made operator()(const BackwardEulerDescription& d) const {
    return std::make_unique<Implicit<Real>>(d.kName, d, false);
  }
  Made operator()(const Bdf2Description& d) const {
    return std::make_unique<Implicit<Real>>(d.kName, d, true);
  }
  Made operator()(const XpbdDescription& d) const { return std::make_unique<Xpbd<Real>>(d); }
};

}  // namespace

template <class Real>
std::unique_ptr<Integrator<Real>> make_integrator(const IntegratorDescription& description) {
  return std::visit(IntegratorMaker<Real>{}, description);
}

template std::unique_ptr<Integrator<float>> make_integrator<float>(const IntegratorDescription&);
template std::unique_ptr<Integrator<double>> make_integrator<double>(const IntegratorDescription&);

}  // namespace weft
