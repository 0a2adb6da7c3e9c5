#include "scene/effect_parameters.h"

#include <optional>

namespace weft::scene {
namespace {

using Values = std::vector<double>;
using Table = std::vector<EffectParameter>;

Values values_of(double number) { return {number}; }
Values values_of(const std::optional<double>& number) { return {number.value_or(0)}; }
Values values_of(const Vec3& vector) { return {vector.x(), vector.y(), vector.z()}; }

void set(double& number, const Values& values) { number = values[0]; }
void set(std::optional<double>& number, const Values& values) { number = values[0]; }
void set(Vec3& vector, const Values& values) { vector = Vec3(values[0], values[1], values[2]); }

template <class Effect, class Member>
Effect effect_with(Member Effect::*);

/// A parameter that is one member of its effect.
template <auto kMember>
EffectParameter member(const char* name, const Range& range) {
  using Effect = decltype(effect_with(kMember));
  return {{name, values_of(Effect{}.*kMember).size(), range},
          [](const EffectDescription& effect) { return values_of(std::get<Effect>(effect).*kMember); },
          [](EffectDescription& effect, const Values& values) {
            set(std::get<Effect>(effect).*kMember, values);
          }};
}

/// Where it is not given, which reads as drag, it goes with that.
EffectParameter lift(const Range& range) {
  EffectParameter lift = member<&AerodynamicsEffect::lift>("lift", range);
  lift.read = [](const EffectDescription& effect) {
    return Values{std::get<AerodynamicsEffect>(effect).lift_or_drag()};
  };
  return lift;
}

/// Along warp and weft.
EffectParameter strength(const Range& range) {
  return {{"strength", 2, range, true},
          [](const EffectDescription& effect) {
            const auto& tearing = std::get<TearingEffect>(effect);
            return Values{tearing.warp, tearing.weft};
          },
          [](EffectDescription& effect, const Values& values) {
            effect = TearingEffect{values[0], values[1]};
          }};
}

const Table& of(const GravityEffect&) {
  static const Table table{member<&GravityEffect::acceleration>("acceleration", {-1e4, 1e4, "m/s2"})};
  return table;
}

const Table& of(const PaperWindEffect&) {
  static const Table table{member<&PaperWindEffect::factor>("factor", {0, 1e6, "N at 1 m/s"})};
  return table;
}

const Table& of(const AerodynamicsEffect&) {
  constexpr Range kCoefficient{0, 100};
  static const Table table{member<&AerodynamicsEffect::air_density>("air_density", {0, 1e4, "kg/m3"}),
                           member<&AerodynamicsEffect::drag>("drag", kCoefficient), lift(kCoefficient)};
  return table;
}

const Table& of(const StrainDampingEffect&) {
  static const Table table{member<&StrainDampingEffect::time>("time", {0, 10, "s"})};
  return table;
}

const Table& of(const ClothContactEffect&) {
  static const Table table{member<&ClothContactEffect::thickness>("thickness", {1e-4, 1, "m"}),
                           member<&ClothContactEffect::friction>("friction", {0, 10})};
  return table;
}

const Table& of(const InflationEffect& inflation) {
  static const Table pump{member<&InflationEffect::pressure>("pressure", {-1e6, 1e6, "Pa"})};
  static const Table gas{member<&InflationEffect::volume>("volume", {1e-9, 1e9, "m3"}),
                         // Above a vacuum's.
                         member<&InflationEffect::pressure>("pressure", {-1e5, 1e6, "Pa"}),
                         member<&InflationEffect::fill_time>("fill_time", {0, 3600, "s"})};
  return inflation.volume ? gas : pump;
}

const Table& of(const TearingEffect&) {
  static const Table table{strength({0.001, 1e9, "N/m"})};
  return table;
}

/// Damping, plate_bending, strain_limit: the material has their numbers.
template <class Effect>
const Table& of(const Effect&) {
  static const Table none;
  return none;
}

}  // namespace

const std::vector<EffectParameter>& parameters_of(const EffectDescription& effect) {
  return std::visit([](const auto& each) -> const Table& { return of(each); }, effect);
}

}  // namespace weft::scene
