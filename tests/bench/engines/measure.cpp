#include "engines/measure.h"

#include <cmath>

#include "timing.h"

namespace weft::bench {
namespace {

/// Area that a node of the sheet stands for, relative to an inner one's.
double share(const SheetState& sheet, int r, int c) {
  const auto along = [&](int i) { return i == 0 || i == sheet.side - 1 ? 0.5 : 1.0; };
  return along(r) * along(c);
}

/// Kinetic and height energy, J; elastic energy is left out, since not every engine has one.
double energy(const SheetState& sheet) {
  const double cell = kSheetSide / (sheet.side - 1), mass = kDensity * cell * cell;
  double sum = 0;
  for (int r = 0; r < sheet.side; ++r) {
    for (int c = 0; c < sheet.side; ++c) {
      const auto i = static_cast<std::size_t>(r * sheet.side + c);
      sum += share(sheet, r, c) * mass *
             (0.5 * sheet.velocity[i].squaredNorm() - standard_gravity().dot(sheet.position[i]));
    }
  }
  return sum;
}

bool has_exploded(const SheetState& sheet) {
  constexpr double kLargestBox = 8.0;
  Eigen::AlignedBox3d box;
  for (const Vec3& position : sheet.position) {
    if (!position.allFinite()) return true;
    box.extend(position);
  }
  return box.sizes().maxCoeff() > kLargestBox;
}

double centre_height(const SheetState& sheet) {
  double sum = 0;
  for (const Vec3& position : sheet.position) sum += position.y();
  return sum / static_cast<double>(sheet.position.size());
}

}  // namespace

std::string Measurement::state() const {
  if (exploded) return "EXPLODED";
  if (!complete()) return "timed only";
  if (broken()) return "BROKEN";
  return lost ? "LOST BALL" : "ok";
}

void LastSecond::add(const SheetState& sheet) {
  for (int r = 0; r < sheet.side; ++r) {
    for (int c = 0; c < sheet.side; ++c) {
      const int node = r * sheet.side + c;
      if (c + 1 < sheet.side) add_edge(sheet, node, node + 1);
      if (r + 1 < sheet.side) add_edge(sheet, node, node + sheet.side);
      squared_speed_ += sheet.velocity[static_cast<std::size_t>(node)].squaredNorm();
      ++nodes_;
    }
  }
}

void LastSecond::add_edge(const SheetState& sheet, int a, int b) {
  const double rest = kSheetSide / (sheet.side - 1);
  const Vec3 edge = sheet.position[static_cast<std::size_t>(a)] - sheet.position[static_cast<std::size_t>(b)];
  const double strain = std::abs(edge.norm() - rest) / rest;
  max_ = std::max(max_, strain);
  sum_ += strain;
  ++edges_;
}

void LastSecond::report(Measurement& measurement) const {
  measurement.max_strain = max_;
  measurement.mean_strain = sum_ / edges_;
  measurement.rms_speed = std::sqrt(squared_speed_ / nodes_);
}

Trial::Trial(std::unique_ptr<Engine> engine, const EngineScene& scene, double budget)
    : engine_(std::move(engine)), scene_(scene), budget_(budget) {
  engine_->read(sheet_);
  start_energy_ = energy(sheet_);
}

void Trial::run(int frames) {
  for (int i = 0; i < frames && !finished_; ++i) step();
}

void Trial::step() {
  constexpr int kTrialFrames = 5;     // they tell how long the rest will take
  constexpr double kShortRun = 1000;  // ms
  const double begin = now();
  engine_->step();
  times_.push_back(now() - begin);
  spent_ += times_.back();
  engine_->read(sheet_);
  measured_.exploded = has_exploded(sheet_);
  measured_.energy.push_back(energy(sheet_) - start_energy_);
  measured_.frames = static_cast<int>(times_.size());
  if (measured_.frames > kFrames - kFramesPerSecond) last_second_.add(sheet_);
  const bool too_long = spent_ / measured_.frames * kFrames > 1e3 * budget_;
  finished_ = measured_.exploded || measured_.frames == kFrames ||
              (too_long && measured_.frames >= kTrialFrames && spent_ > kShortRun);
}

Measurement Trial::measurement() const {
  Measurement result = measured_;
  result.median_ms = median(times_);
  result.least_ms = *std::min_element(times_.begin(), times_.end());
  if (!result.complete()) return result;
  last_second_.report(result);
  result.lost = scene_.name == 'B' && centre_height(sheet_) < -kSheetSide;
  return result;
}

}  // namespace weft::bench
