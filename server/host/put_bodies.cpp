#include "host/put_bodies.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cloth/sheet/diagnostics.h"

namespace weft::host {
namespace {

/// Times the work of the cloth's last step before viewers put anything, and at least so much (a quarter of a
/// second or so): a ball dragged through a flag at level 6 takes a third of it, one that swallows the flag's
/// pole passes it in its first step.
constexpr double kMostTimes = 8, kLeastWork = 1.2e7;
/// Of the bodies at a cloth those put within so many steps before the newest answer for it.
constexpr std::uint64_t kTogether = 60;

/// For so long, s of the scene, who put them may put nothing.
constexpr double kPause = 10;

/// How the work of a step grows with the level: four times the nodes, in twice the substeps.
double scale_of(int level) { return std::exp2(3 * level); }

bool meets(const Solid& solid, const BoundingSphere& cloth) {
  if (std::holds_alternative<HalfSpace>(solid.shape)) return true;
  return (solid.position - cloth.centre).norm() <= outer_radius(solid.shape) + cloth.radius;
}

}  // namespace

std::uint64_t PutBodies::pause(double time_step) {
  return static_cast<std::uint64_t>(std::ceil(kPause / time_step));
}

void PutBodies::put(ColliderId body, std::uint64_t viewer, const Simulation<float>& simulation) {
  const auto known = std::find_if(put_.begin(), put_.end(), [&](const PutBody& b) { return b.id == body; });
  PutBody& put = known == put_.end() ? put_.emplace_back() : *known;
  if (put.id == 0 && body >= kFirstObstacle)
    put.before = simulation.colliders().obstacles()[body - kFirstObstacle].pose;
  put.id = body;
  put.viewer = viewer;
  put.step = simulation.step_count();
}

void PutBodies::limit_work(RecordedSimulation& recorded) {
  const Simulation<float>& simulation = recorded.simulation();
  std::erase_if(put_, [&](const PutBody& body) {
    return body.id < kFirstObstacle && simulation.colliders().find(body.id) == nullptr;
  });
  usual_work_.resize(simulation.cloths().size(), 0);
  for (std::size_t i = 0; i < usual_work_.size(); ++i) {
    const Cloth<float>& cloth = simulation.cloths()[i];
    const double usual = usual_work_[i] * scale_of(cloth.level());
    const double most = put_.empty() ? WorkLimit::kNone : std::max(kLeastWork, kMostTimes * usual);
    if (cloth.most_work() != most) recorded.run(command::SetMostWork{i, most});
  }
}

std::vector<PutBody> PutBodies::take_costly(RecordedSimulation& recorded) {
  const Simulation<float>& simulation = recorded.simulation();
  std::vector<PutBody> guilty;
  for (std::size_t i = 0; i < usual_work_.size(); ++i) {
    const Cloth<float>& cloth = simulation.cloths()[i];
    if (put_.empty() && cloth.work() > 0) usual_work_[i] = cloth.work() / scale_of(cloth.level());
    if (!cloth.cost_too_much()) continue;
    recorded.run(command::TryAgain{i});
    const std::size_t before = guilty.size();
    find_at(cloth, simulation.colliders().solids(), guilty);
    // It takes so much without them, by another command.
    if (guilty.size() == before) usual_work_[i] = cloth.work() / scale_of(cloth.level());
  }
  std::uint64_t newest = 0;
  for (const PutBody& body : guilty) newest = std::max(newest, body.step);
  const auto innocent = [&](const PutBody& body) { return body.step + kTogether < newest; };
  std::copy_if(guilty.begin(), guilty.end(), std::back_inserter(put_), innocent);
  std::erase_if(guilty, innocent);
  return guilty;
}

void PutBodies::find_at(const Cloth<float>& cloth, const std::vector<Solid>& solids,
                        std::vector<PutBody>& found) {
  const BoundingSphere bounds = bounding_sphere(cloth.particles());
  for (const Solid& solid : solids) {
    const auto put =
        std::find_if(put_.begin(), put_.end(), [&](const PutBody& body) { return body.id == solid.id; });
    if (put == put_.end() || !meets(solid, bounds)) continue;
    found.push_back(*put);
    put_.erase(put);
  }
}

void PutBodies::save(ServiceState& state) const {
  state.put = put_;
  state.usual_work = usual_work_;
}

void PutBodies::load(const ServiceState& state) {
  put_ = state.put;
  for (PutBody& body : put_) body.viewer = 0;
  usual_work_ = state.usual_work;
}

}  // namespace weft::host
