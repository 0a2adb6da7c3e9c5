#include "study/errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace weft::study {
namespace {

/// Visits the nodes two trajectories share: visit(place in a, place in b, size), places in Frame::positions.
template <class Visit>
void for_each_shared_node(const Trajectory& a, const Trajectory& b, Visit visit) {
  std::size_t base_a = 0, base_b = 0;
  const auto node = [](const Sheet& sheet, int every, int r, int c) {
    return 3 * (static_cast<std::size_t>(r * every) * static_cast<std::size_t>(sheet.cols) +
                static_cast<std::size_t>(c * every));
  };
  for (std::size_t i = 0; i < a.sheets.size(); ++i) {
    const Sheet &in_a = a.sheets[i], &in_b = b.sheets[i];
    const int rows = std::min(in_a.rows, in_b.rows), cols = std::min(in_a.cols, in_b.cols);
    const int every_a = (in_a.rows - 1) / (rows - 1), every_b = (in_b.rows - 1) / (rows - 1);
    if (every_a * (cols - 1) + 1 != in_a.cols || every_b * (cols - 1) + 1 != in_b.cols) {
      throw std::invalid_argument("the two runs are not of levels of one cloth");
    }
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        visit(base_a + node(in_a, every_a, r, c), base_b + node(in_b, every_b, r, c), in_b.size);
      }
    }
    base_a += 3 * static_cast<std::size_t>(in_a.rows * in_a.cols);
    base_b += 3 * static_cast<std::size_t>(in_b.rows * in_b.cols);
  }
}

Vec3 at(const std::vector<double>& positions, std::size_t place) {
  return {positions[place], positions[place + 1], positions[place + 2]};
}

void add_position_errors(const Trajectory& run, const Trajectory& reference, Errors& errors) {
  double square = 0, square_of_means = 0;
  std::size_t nodes = 0;
  const auto frames = static_cast<double>(run.frames.size() - 1);
  for_each_shared_node(run, reference, [&](std::size_t a, std::size_t b, double size) {
    Vec3 sum(0, 0, 0);
    for (std::size_t f = 1; f < run.frames.size(); ++f) {
      const Vec3 offset = (at(run.frames[f].positions, a) - at(reference.frames[f].positions, b)) / size;
      sum += offset;
      square += offset.squaredNorm();
      errors.max_position = std::max(errors.max_position, offset.norm());
    }
    square_of_means += (sum / frames).squaredNorm();
    ++nodes;
  });
  const auto count = static_cast<double>(nodes);
  errors.rms_position = std::sqrt(square / (count * frames));
  errors.mean_shape = std::sqrt(square_of_means / count);
}

/// Root mean square over the frames but the start of of(frame) - of(reference's frame).
template <class Of>
double rms_difference(const Trajectory& run, const Trajectory& reference, Of of) {
  double square = 0;
  for (std::size_t f = 1; f < run.frames.size(); ++f) {
    const double difference = of(run.frames[f]) - of(reference.frames[f]);
    square += difference * difference;
  }
  return std::sqrt(square / static_cast<double>(run.frames.size() - 1));
}

template <class Of>
double range(const Trajectory& run, Of of) {
  const auto [low, high] = std::minmax_element(run.frames.begin(), run.frames.end(),
                                               [&](const Frame& a, const Frame& b) { return of(a) < of(b); });
  return of(*high) - of(*low);
}

/// The times at which the centre's coordinate `axis` passes `level`, s: linear between frames; a passage
/// counts once it has gone a tenth of the largest excursion beyond, so that a tremor about the level does
/// not.
std::vector<double> crossings(const Trajectory& run, int axis, double level) {
  double most = 0;
  for (const Frame& frame : run.frames) most = std::max(most, std::abs(frame.centre[axis] - level));
  std::vector<double> times;
  double side = 0, last = 0;  // the side that was last reached, and when the level was last passed from it
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    const double now = run.frames[f].centre[axis] - level;
    if (f > 0) {
      const double before = run.frames[f - 1].centre[axis] - level;
      if ((before < 0) != (now < 0)) {
        last = (static_cast<double>(f) - now / (now - before)) * run.time_step;
      }
    }
    if (std::abs(now) < 0.1 * most) continue;
    if (side * now < 0) times.push_back(last);
    side = now;
  }
  return times;
}

struct Swing {
  int axis = 0;
  double level = 0;
};

/// The axis along which the centre moves most, and its mean there.
Swing swing_of(const Trajectory& run) {
  Vec3 mean(0, 0, 0), square(0, 0, 0);
  for (const Frame& frame : run.frames) mean += frame.centre / static_cast<double>(run.frames.size());
  for (const Frame& frame : run.frames) square += (frame.centre - mean).cwiseAbs2();
  Swing swing;
  square.maxCoeff(&swing.axis);
  swing.level = mean[swing.axis];
  return swing;
}

std::optional<double> frequency_about(const Trajectory& run, const Swing& swing) {
  constexpr double kUneven = 1.5;  // longest half period over the shortest
  const std::vector<double> times = crossings(run, swing.axis, swing.level);
  if (times.size() < 3) return std::nullopt;
  double shortest = times[1] - times[0], longest = shortest;
  for (std::size_t i = 2; i < times.size(); ++i) {
    shortest = std::min(shortest, times[i] - times[i - 1]);
    longest = std::max(longest, times[i] - times[i - 1]);
  }
  if (longest > kUneven * shortest) return std::nullopt;
  return static_cast<double>(times.size() - 1) / (2 * (times.back() - times.front()));
}

}  // namespace

double energy_exchanged(const Trajectory& run) {
  return std::max(range(run, [](const Frame& f) { return f.kinetic_energy; }),
                  range(run, [](const Frame& f) { return f.potential_energy; }));
}

std::optional<double> frequency(const Trajectory& run) { return frequency_about(run, swing_of(run)); }

Errors errors_of(const Trajectory& run, const Trajectory& reference) {
  if (run.frames.size() != reference.frames.size() || run.frames.size() < 2 ||
      run.sheets.size() != reference.sheets.size()) {
    throw std::invalid_argument("the two runs have not as many frames and cloths");
  }
  Errors errors;
  add_position_errors(run, reference, errors);
  errors.strain = rms_difference(run, reference, [](const Frame& f) { return f.mean_strain; });
  if (const double exchanged = energy_exchanged(reference); exchanged > 0) {
    errors.energy =
        rms_difference(run, reference, [](const Frame& f) { return f.kinetic_energy + f.potential_energy; }) /
        exchanged;
  }
  const Swing swing = swing_of(reference);
  if (const auto expected = frequency_about(reference, swing)) {
    if (const auto found = frequency_about(run, swing)) errors.frequency = std::abs(*found / *expected - 1);
  }
  return errors;
}

}  // namespace weft::study
