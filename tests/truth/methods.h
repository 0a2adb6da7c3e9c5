#pragma once
/// The integrators, as the truths ask for them: solved to rounding where they solve, with as many substeps as
/// a case needs.
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <numbers>
#include <ostream>
#include <string>
#include <string_view>

#include "rig.h"

namespace weft::test {

enum class Method { symplectic_euler, backward_euler, bdf2, xpbd };
inline constexpr std::array kMethods{Method::symplectic_euler, Method::backward_euler, Method::bdf2,
                                     Method::xpbd};

inline std::string name_of(Method method) {
  constexpr std::array kNames{"symplectic_euler", "backward_euler", "bdf2", "xpbd"};
  return kNames[static_cast<std::size_t>(method)];
}

template <class Description>
Description solved_exactly(int substeps, int newton_iterations) {
  Description description;
  description.substeps = substeps;
  description.newton_iterations = newton_iterations;
  description.tolerance = 1e-12;
  description.linear_iterations = 1000;
  return description;
}

/// With so many substeps a step; symplectic Euler takes at least what keeps it stable.
inline IntegratorDescription stepping(Method method, int substeps, int newton_iterations = 1) {
  switch (method) {
    case Method::backward_euler:
      return solved_exactly<BackwardEulerDescription>(substeps, newton_iterations);
    case Method::bdf2:
      return solved_exactly<Bdf2Description>(substeps, newton_iterations);
    case Method::xpbd:
      return XpbdDescription{substeps};
    default:
      return SymplecticEulerDescription{substeps};
  }
}

/// For GoogleTest's messages.
inline void PrintTo(Method method, std::ostream* out) { *out << name_of(method); }

/// What a step of h makes of y' = i w y: the principal root of backward Euler's or BDF2's characteristic
/// polynomial (T3, T4).
inline std::complex<double> principal_root(Method method, double w, double h) {
  const std::complex<double> z(0, w * h);
  return method == Method::bdf2 ? (2.0 + std::sqrt(1.0 + 2.0 * z)) / (3.0 - 2.0 * z) : 1.0 / (1.0 - z);
}

/// Frequency that the method gives a mode of angular frequency w stepped by h, relative to the mode's own:
/// the argument of the principal root of its characteristic polynomial (T4). Projecting a spring once is
/// backward Euler.
inline double relative_frequency(Method method, double w, double h) {
  if (method == Method::symplectic_euler) return 2 * std::asin(w * h / 2) / (w * h);
  return std::arg(principal_root(method, w, h)) / (w * h);
}

/// Frequency, Hz, of a signal sampled every `dt` seconds, from its first to its last upward crossing of zero,
/// each found by a straight line between two samples.
class Crossings {
 public:
  explicit Crossings(double dt) : dt_(dt) {}
  void add(double value) {
    if (samples_ > 0 && last_ < 0 && value >= 0) {
      const double time = (samples_ - value / (value - last_)) * dt_;
      if (count_++ == 0) first_ = time;
      latest_ = time;
    }
    last_ = value;
    ++samples_;
  }
  double frequency() const { return (count_ - 1) / (latest_ - first_); }
  int count() const { return count_; }

 private:
  double dt_, last_ = 0, first_ = 0, latest_ = 0;
  int samples_ = 0, count_ = 0;
};

/// Only structural springs.
inline Material strands(double structural, double density = 0.1) {
  Material material;
  material.density = density;
  material.structural = structural;
  material.shear = material.bending = 0;
  return material;
}

/// Implicit methods as a scene has them that asks for nothing else.
class ImplicitMethod : public ::testing::TestWithParam<Method> {
 protected:
  static IntegratorDescription integrator() {
    if (GetParam() == Method::bdf2) return Bdf2Description{};
    return BackwardEulerDescription{};
  }
  /// How many of `all` random scenes a test draws: half of them, or all in an instantiation Nightly/....
  static int sample(int all) {
    const std::string_view suite = ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name();
    return suite.starts_with("Nightly/") ? all : all / 2;
  }
};
inline constexpr std::array kImplicitMethods{Method::bdf2, Method::backward_euler};

class EveryMethod : public ::testing::TestWithParam<Method> {};

inline std::string name_of_case(const ::testing::TestParamInfo<Method>& tested) {
  return name_of(tested.param);
}

}  // namespace weft::test
