#pragma once
#include <vector>

#include "host/recorded_simulation.h"
#include "host/service_state.h"

namespace weft::host {

/// The balls and obstacles that viewers have put into a scene, and what they may cost: a step of a cloth
/// among them may take only so much work, counted so that it is the same on any machine.
class PutBodies {
 public:
  /// For so many steps of so many seconds who put what took too much may put nothing.
  static std::uint64_t pause(double time_step);

  /// The viewer of this Seat::number puts the body somewhere. To be called before it is there.
  void put(ColliderId body, std::uint64_t viewer, const Simulation<float>& simulation);
  /// Before a step: what it may take, if viewers' bodies are there.
  void limit_work(RecordedSimulation& recorded);
  /// After it: those that made it take more, to be taken away; they are no more among those put.
  std::vector<PutBody> take_costly(RecordedSimulation& recorded);
  /// Nobody has put anything.
  void begin_anew() { put_.clear(); }

  /// Its part of what is written down.
  void save(ServiceState& state) const;
  /// Goes on from there; who put something is nobody who is here.
  void load(const ServiceState& state);

 private:
  /// Takes those that are at this cloth out of put_, and adds them to `found`.
  void find_at(const Cloth<float>& cloth, const std::vector<Solid>& solids, std::vector<PutBody>& found);

  std::vector<PutBody> put_;
  std::vector<double> usual_work_;  ///< by cloth: of its last step without those, as if at level 0
};

}  // namespace weft::host
