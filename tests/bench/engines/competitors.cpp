#include "engines/competitors.h"

#include "engines/baseline_engine.h"
#include "engines/bullet_engine.h"
#include "engines/weft_engine.h"

namespace weft::bench {
namespace {

Competitor weft(const std::string& setting, double structural, const IntegratorDescription& integrator) {
  const std::string name = std::visit([](const auto& d) { return std::string(d.kName); }, integrator);
  return {"Weft " + name, setting, structural, [=](const EngineScene& scene) {
            return std::make_unique<WeftEngine<float>>(describe(scene, structural, integrator));
          }};
}

/// An implicit method's description with some parameters changed.
template <class Description>
Description with(ImplicitParameters parameters) {
  return Description{parameters};
}

Competitor paper(double structural) {
  return {"baseline", "stable substeps", structural,
          [=](const EngineScene& scene) { return std::make_unique<BaselineEngine>(scene, structural); }};
}

Competitor bullet(int iterations, int substeps) {
  return {
      "Bullet", std::to_string(iterations) + " x " + std::to_string(substeps), 0,
      [=](const EngineScene& scene) { return std::make_unique<BulletEngine>(scene, iterations, substeps); }};
}

}  // namespace

std::vector<Competitor> competitors() {
  using Bdf2 = Bdf2Description;
  std::vector<Competitor> all{weft("default", kStiff, Bdf2{}),
                              weft("1 Newton and 1 linear iteration", kStiff,
                                   with<Bdf2>({.newton_iterations = 1, .linear_iterations = 1})),
                              weft("tolerance 0.2", kStiff, with<Bdf2>({.tolerance = 0.2})),
                              weft("1 Newton iteration, tolerance 0.2", kStiff,
                                   with<Bdf2>({.tolerance = 0.2, .newton_iterations = 1})),
                              weft("1 Newton iteration, tolerance 0.05", kStiff,
                                   with<Bdf2>({.tolerance = 0.05, .newton_iterations = 1})),
                              weft("1 Newton iteration", kStiff, with<Bdf2>({.newton_iterations = 1})),
                              weft("tolerance 0.005", kStiff, with<Bdf2>({.tolerance = 0.005})),
                              weft("2 substeps", kStiff, with<Bdf2>({.substeps = 2})),
                              weft("4 substeps", kStiff, with<Bdf2>({.substeps = 4})),
                              weft("8 substeps", kStiff, with<Bdf2>({.substeps = 8})),
                              weft("16 substeps", kStiff, with<Bdf2>({.substeps = 16})),
                              weft("default", kStiff, BackwardEulerDescription{}),
                              weft("4 substeps", kStiff, with<BackwardEulerDescription>({.substeps = 4}))};
  for (const int substeps : {5, 10, 20, 40, 80}) {
    all.push_back(weft(std::to_string(substeps) + " substeps", kStiff, XpbdDescription{substeps}));
  }
  all.push_back(weft("stable substeps", kStiff, SymplecticEulerDescription{}));
  all.push_back(weft("default", kStiffest, Bdf2{}));
  all.push_back(weft("default", kSoft, Bdf2{}));
  all.push_back(weft("1 Newton iteration, tolerance 0.05", kSoft,
                     with<Bdf2>({.tolerance = 0.05, .newton_iterations = 1})));
  all.push_back(weft("4 substeps", kSoft, with<Bdf2>({.substeps = 4})));
  all.push_back(weft("8 substeps", kSoft, with<Bdf2>({.substeps = 8})));
  all.push_back(weft("default", kSoft, BackwardEulerDescription{}));
  all.push_back(weft("20 substeps", kSoft, XpbdDescription{20}));
  all.push_back(weft("stable substeps", kSoft, SymplecticEulerDescription{}));
  all.push_back(paper(kStiff));
  all.push_back(paper(kSoft));
  for (const auto& [iterations, substeps] : {std::pair{1, 1}, std::pair{5, 1}, std::pair{1, 5},
                                             std::pair{1, 20}, std::pair{5, 10}, std::pair{1, 40}}) {
    all.push_back(bullet(iterations, substeps));
  }
  return all;
}

std::unique_ptr<Engine> make_reference(const EngineScene& scene, int substeps) {
  const ImplicitParameters converged{
      .substeps = substeps, .tolerance = 1e-4, .newton_iterations = 3, .linear_iterations = 200};
  return std::make_unique<WeftEngine<double>>(describe(scene, kStiff, with<Bdf2Description>(converged)));
}

}  // namespace weft::bench
