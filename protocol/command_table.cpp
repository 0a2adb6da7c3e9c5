#include "protocol/command_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/member.h"

namespace weft::protocol {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

enum class Presence { required, optional };

/// A member of an operation and the member of the command that holds it.
struct Field {
  const char* name;
  Presence presence;
  Bounds bounds;
  Fault (*read_into)(const Field& field, const json& value, Command& command);
  void (*write_from)(const Command& command,
                     ordered_json& value);  ///< leaves null where there is nothing to say
  std::string (*kind)(const Bounds& bounds);
};

template <class C, class T>
C command_of(T C::*);

template <auto kMember>
constexpr Field field(const char* name, Presence presence, Bounds bounds = {}) {
  using C = decltype(command_of(kMember));
  return {name,
          presence,
          bounds,
          [](const Field& self, const json& value, Command& command) {
            return read(value, self.bounds, pointer_to("", self.name), std::get<C>(command).*kMember);
          },
          [](const Command& command, ordered_json& value) { write(std::get<C>(command).*kMember, value); },
          [](const Bounds& own) { return kind_of(C{}.*kMember, own); }};
}

/// One of distance and eye; a cone is whole and has an eye.
Fault check_camera(const json& message, Command& command) {
  const auto& camera = std::get<Camera>(command);
  if (camera.distance && camera.eye)
    return JsonFault{"conflict", "/eye",
                     "/eye is given beside /distance; allowed: exactly one of /distance and /eye"};
  if (!camera.distance && !camera.eye)
    return JsonFault{"missing", "/distance",
                     "/distance is missing; allowed: exactly one of /distance and /eye"};
  if (!camera.target && !camera.half_angle) return {};
  const std::string path = camera.target ? "/target" : "/half_angle";
  const std::string other = camera.target ? "/half_angle" : "/target";
  if (camera.distance)
    return JsonFault{"conflict", path, path + " is given beside /distance; allowed: beside /eye"};
  if (!camera.target || !camera.half_angle)
    return JsonFault{"missing", other,
                     other + " is missing; allowed: both /target and /half_angle or neither"};
  if (*camera.target == *camera.eye)
    return refuse("range", "/target", message["target"], "any point but /eye");
  return {};
}

/// To unit length, by way of the largest component so that no square overflows or vanishes. False for zero.
template <std::size_t kSize>
bool normalise(std::array<double, kSize>& components) {
  double largest = 0;
  for (const double component : components) largest = std::max(largest, std::abs(component));
  if (largest == 0) return false;
  double square = 0;
  for (double& component : components) {
    component /= largest;
    square += component * component;
  }
  for (double& component : components) component /= std::sqrt(square);
  return true;
}

Fault normalise_wind(const json& message, Command& command) {
  if (normalise(std::get<WindSet>(command).direction)) return {};
  return refuse("range", "/direction", message["direction"], "any direction but the zero vector");
}

Fault normalise_turn(const json& message, Command& command) {
  auto& quaternion = std::get<ObstacleMove>(command).quaternion;
  if (!quaternion || normalise(*quaternion)) return {};
  return refuse("range", "/quaternion", message["quaternion"], "any but zero");
}

/// Not both.
Fault check_quality(const json&, Command& command) {
  const auto& quality = std::get<Quality>(command);
  if (quality.max_error && quality.max_ms)
    return JsonFault{"conflict", "/max_ms",
                     "/max_ms is given beside /max_error; allowed: at most one of /max_error and /max_ms"};
  return {};
}

/// Not both.
Fault check_friction(const json&, Command& command) {
  const auto& set = std::get<FrictionSet>(command);
  if (set.ball && set.obstacle)
    return JsonFault{"conflict", "/obstacle",
                     "/obstacle is given beside /ball; allowed: at most one of /ball and /obstacle"};
  return {};
}

struct Operation {
  const char* name;
  Command blank;
  std::vector<Field> fields;
  Fault (*finish)(const json& message, Command& command) = nullptr;  ///< what no single member can tell
};

/// In the order of Command's alternatives.
const std::vector<Operation>& operations() {
  constexpr auto kRequired = Presence::required, kOptional = Presence::optional;
  constexpr Bounds kCharacters{1, 64}, kId{0, 4294967295}, kShare{0, 1};
  constexpr Bounds kEye{-1e6, 1e6, "m"}, kPlace{-1e3, 1e3, "m"}, kVelocity{-200, 200, "m/s"};
  constexpr Bounds kFriction{0, 10};
  static const std::vector<Operation> table{
      {"hello",
       Hello{},
       {field<&Hello::client>("client", kOptional, kCharacters),
        field<&Hello::caps>("caps", kOptional, kCharacters),
        field<&Hello::window>("window", kOptional, {1, 8})}},
      {"scene.list", SceneList{}, {}},
      {"scene.join", SceneJoin{}, {field<&SceneJoin::scene>("scene", kRequired, kCharacters)}},
      {"camera",
       Camera{},
       {field<&Camera::distance>("distance", kOptional, {0, 1e6, "m"}),
        field<&Camera::eye>("eye", kOptional, kEye), field<&Camera::target>("target", kOptional, kEye),
        field<&Camera::half_angle>("half_angle", kOptional, {0.001, 3.14, "rad"})},
       check_camera},
      {"ack", Ack{}, {field<&Ack::frame>("f", kRequired, kId)}},
      {"ball.add",
       BallAdd{},
       {field<&BallAdd::position>("position", kRequired, kPlace),
        field<&BallAdd::radius>("radius", kRequired, {0.01, 10, "m"}),
        field<&BallAdd::velocity>("velocity", kOptional, kVelocity),
        field<&BallAdd::motion>("motion", kOptional),
        field<&BallAdd::mass>("mass", kOptional, {1e-3, 1e4, "kg"}),
        field<&BallAdd::friction>("friction", kOptional, kFriction)}},
      {"ball.move",
       BallMove{},
       {field<&BallMove::ball>("ball", kRequired, kId),
        field<&BallMove::position>("position", kRequired, kPlace)}},
      {"ball.throw",
       BallThrow{},
       {field<&BallThrow::ball>("ball", kRequired, kId),
        field<&BallThrow::velocity>("velocity", kRequired, kVelocity)}},
      {"ball.remove", BallRemove{}, {field<&BallRemove::ball>("ball", kRequired, kId)}},
      {"obstacle.move",
       ObstacleMove{},
       {field<&ObstacleMove::obstacle>("obstacle", kRequired, kId),
        field<&ObstacleMove::position>("position", kRequired, kPlace),
        field<&ObstacleMove::quaternion>("quaternion", kOptional, {-1e6, 1e6})},
       normalise_turn},
      {"obstacle.throw",
       ObstacleThrow{},
       {field<&ObstacleThrow::obstacle>("obstacle", kRequired, kId),
        field<&ObstacleThrow::velocity>("velocity", kRequired, kVelocity),
        field<&ObstacleThrow::spin>("spin", kOptional, {-200, 200, "rad/s"})}},
      {"obstacle.grab",
       ObstacleGrab{},
       {field<&ObstacleGrab::obstacle>("obstacle", kRequired, kId),
        field<&ObstacleGrab::point>("point", kOptional, kPlace),
        field<&ObstacleGrab::position>("position", kOptional, kPlace),
        field<&ObstacleGrab::max_force>("max_force", kOptional, {1e-3, 1e4, "N"})}},
      {"cloth.grab",
       ClothGrab{},
       {field<&ClothGrab::cloth>("cloth", kRequired, kId), field<&ClothGrab::u>("u", kRequired, kShare),
        field<&ClothGrab::v>("v", kRequired, kShare),
        field<&ClothGrab::position>("position", kOptional, kPlace),
        field<&ClothGrab::max_force>("max_force", kOptional, {1e-3, 1e4, "N"})}},
      {"grab.move",
       GrabMove{},
       {field<&GrabMove::grab>("grab", kRequired, kId),
        field<&GrabMove::position>("position", kRequired, kPlace)}},
      {"grab.release", GrabRelease{}, {field<&GrabRelease::grab>("grab", kRequired, kId)}},
      {"cloth.pin",
       ClothPin{},
       {field<&ClothPin::cloth>("cloth", kRequired, kId), field<&ClothPin::u>("u", kRequired, kShare),
        field<&ClothPin::v>("v", kRequired, kShare)}},
      {"cloth.unpin",
       ClothUnpin{},
       {field<&ClothUnpin::cloth>("cloth", kRequired, kId), field<&ClothUnpin::u>("u", kRequired, kShare),
        field<&ClothUnpin::v>("v", kRequired, kShare)}},
      {"cloth.tune",
       ClothTune{},
       {field<&ClothTune::cloth>("cloth", kRequired, kId),
        field<&ClothTune::parameters>("parameters", kRequired)}},
      {"friction.set",
       FrictionSet{},
       {field<&FrictionSet::friction>("friction", kRequired, kFriction),
        field<&FrictionSet::ball>("ball", kOptional, kId),
        field<&FrictionSet::obstacle>("obstacle", kOptional, kId)},
       check_friction},
      {"effect.set",
       EffectSet{},
       {field<&EffectSet::effect>("effect", kRequired, kCharacters), field<&EffectSet::on>("on", kRequired)}},
      {"effect.tune",
       EffectTune{},
       {field<&EffectTune::effect>("effect", kRequired, kCharacters),
        field<&EffectTune::parameters>("parameters", kRequired)}},
      {"wind.set",
       WindSet{},
       {field<&WindSet::direction>("direction", kRequired, {-1e6, 1e6}),
        field<&WindSet::speed>("speed", kRequired, {0, 100, "m/s"}),
        field<&WindSet::gusts>("gusts", kOptional, {0, 1}),
        field<&WindSet::turbulence>("turbulence", kOptional, {0, 1}),
        field<&WindSet::time_scale>("time_scale", kOptional, {0.05, 1000, "s"}),
        field<&WindSet::length_scale>("length_scale", kOptional, {0.01, 1000, "m"})},
       normalise_wind},
      {"wind.zone.set",
       WindZoneSet{},
       {field<&WindZoneSet::zone>("zone", kRequired, kId),
        field<&WindZoneSet::velocity>("velocity", kRequired, {-100, 100, "m/s"})}},
      {"quality",
       Quality{},
       {field<&Quality::max_error>("max_error", kOptional, {1e-6, 1}),
        field<&Quality::max_ms>("max_ms", kOptional, {0.01, 1000, "ms"})},
       check_quality},
      {"cost", Cost{}, {}},
      {"pause", Pause{}, {}},
      {"resume", Resume{}, {}},
      {"reset", Reset{}, {}},
      {"step", Step{}, {field<&Step::count>("count", kOptional, {1, 600})}},
      {"ping", Ping{}, {field<&Ping::t>("t", kRequired, {-1e15, 1e15})}},
  };
  return table;
}

template <class Items>
std::string listed(const Items& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + std::string(item.name);
  return text;
}

}  // namespace

std::optional<JsonFault> read_command(const json& message, Request& request) {
  if (!message.is_object())
    return JsonFault{"bad_type", "", "the message is " + shown(message) + "; allowed: an object with op"};
  if (const auto id = message.find("id"); id != message.end()) {
    constexpr Bounds kRequestId{1, 2147483647};
    if (auto fault = read(*id, kRequestId, "/id", request.id.emplace())) return fault;
  }

  const auto op = message.find("op");
  if (op == message.end())
    return JsonFault{"missing", "/op", "/op is missing; allowed: " + listed(operations())};
  if (!op->is_string()) return refuse("bad_type", "/op", *op, listed(operations()));
  const auto operation = std::find_if(operations().begin(), operations().end(),
                                      [&](const Operation& known) { return *op == known.name; });
  if (operation == operations().end()) return refuse("unknown_op", "/op", *op, listed(operations()));

  for (const auto& member : message.items()) {
    const std::string& name = member.key();
    const bool known = name == "op" || name == "id" ||
                       std::any_of(operation->fields.begin(), operation->fields.end(),
                                   [&](const Field& field) { return name == field.name; });
    if (!known) {
      const std::string also = operation->fields.empty() ? "" : ", " + listed(operation->fields);
      return refuse("unknown_member", pointer_to("", name), member.value(),
                    std::string("in ") + operation->name + " only op, id" + also);
    }
  }

  request.command = operation->blank;
  for (const Field& field : operation->fields) {
    const auto value = message.find(field.name);
    if (value != message.end()) {
      if (auto fault = field.read_into(field, *value, request.command)) return fault;
    } else if (field.presence == Presence::required) {
      const std::string path = pointer_to("", field.name);
      return JsonFault{"missing", path, path + " is missing; allowed: " + field.kind(field.bounds)};
    }
  }
  return operation->finish != nullptr ? operation->finish(message, request.command) : Fault{};
}

void write_command(const Request& request, ordered_json& message) {
  const Operation& operation = operations()[request.command.index()];
  message["op"] = operation.name;
  if (request.id) message["id"] = *request.id;
  for (const Field& field : operation.fields) {
    ordered_json value;
    field.write_from(request.command, value);
    if (!value.is_null()) message[field.name] = std::move(value);
  }
}

}  // namespace weft::protocol
