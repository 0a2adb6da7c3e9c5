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

/// Collects strain and speed over frames.
class LastSecond {
 public:
  void add(const SheetState& sheet) {
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
  void report(Measurement& measurement) const {
    measurement.max_strain = max_;
    measurement.mean_strain = sum_ / edges_;
    measurement.rms_speed = std::sqrt(squared_speed_ / nodes_);
  }

 private:
  void add_edge(const SheetState& sheet, int a, int b) {
    const double rest = kSheetSide / (sheet.side - 1);
    const Vec3 edge =
        sheet.position[static_cast<std::size_t>(a)] - sheet.position[static_cast<std::size_t>(b)];
    const double strain = std::abs(edge.norm() - rest) / rest;
    max_ = std::max(max_, strain);
    sum_ += strain;
    ++edges_;
  }

  double max_ = 0, sum_ = 0, squared_speed_ = 0;
  double edges_ = 0, nodes_ = 0;
};

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

Measurement measure(Engine& engine, const EngineScene& scene, double budget) {
  constexpr int kTrial = 5;           // frames that tell how long the rest will take
  constexpr double kShortRun = 1000;  // ms
  Measurement measurement;
  SheetState sheet;
  engine.read(sheet);
  const double start_energy = energy(sheet);
  LastSecond last_second;
  std::vector<double> times;
  double spent = 0;
  bool short_run = false;
  while (measurement.frames < kFrames && !measurement.exploded) {
    const double begin = now();
    engine.step();
    times.push_back(now() - begin);
    spent += times.back();
    ++measurement.frames;
    engine.read(sheet);
    measurement.exploded = has_exploded(sheet);
    measurement.energy.push_back(energy(sheet) - start_energy);
    if (measurement.frames > kFrames - kFramesPerSecond) last_second.add(sheet);
    if (measurement.frames == kTrial) short_run = spent / kTrial * kFrames > 1e3 * budget;
    if (short_run && spent > kShortRun) break;
  }
  measurement.median_ms = median(times);
  measurement.least_ms = *std::min_element(times.begin(), times.end());
  if (!measurement.complete()) return measurement;
  last_second.report(measurement);
  measurement.lost = scene.name == 'B' && centre_height(sheet) < -kSheetSide;
  return measurement;
}

}  // namespace weft::bench
