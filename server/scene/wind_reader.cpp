#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr Range kIntensity{0, 1};

Gusts read_gusts(const json& value, const std::string& path, Report& report) {
  constexpr Range kTimeScale{0.05, 1000, "s"};
  Gusts gusts;
  Object object(value, path, report);
  object.require("intensity", kIntensity);
  object.number("intensity", gusts.intensity, kIntensity);
  object.number("time_scale", gusts.time_scale, kTimeScale);
  return gusts;
}

Turbulence read_turbulence(const json& value, const std::string& path, Report& report) {
  constexpr Range kLengthScale{0.01, 1000, "m"};
  Turbulence turbulence;
  Object object(value, path, report);
  object.require("intensity", kIntensity);
  object.number("intensity", turbulence.intensity, kIntensity);
  object.number("length_scale", turbulence.length_scale, kLengthScale);
  return turbulence;
}

WindZone read_zone(const json& value, const std::string& path, Report& report) {
  constexpr Range kAirVelocity{-100, 100, "m/s"};
  constexpr Range kEdge{0.001, 1000, "m"};
  WindZone zone;
  Object object(value, path, report);
  object.require("type", "a zone's shape");
  switch (object.choice("type", {BoxZone::kName, SphereZone::kName})) {
    case 0: {
      BoxZone box;
      object.require("size", "an array of 3 numbers, each " + kLength.text());
      object.vector("size", box.size, kLength);
      if (const json* orientation = object.find("orientation")) {
        box.orientation = read_orientation(*orientation, object.path("orientation"), report);
      }
      zone.shape = box;
      break;
    }
    case 1: {
      SphereZone sphere;
      object.require("radius", kLength);
      object.number("radius", sphere.radius, kLength);
      zone.shape = sphere;
      break;
    }
    default:
      object.ignore_rest();
      return zone;
  }
  object.require("position", "an array of 3 numbers, each " + kPosition.text());
  object.vector("position", zone.position, kPosition);
  object.require("velocity", "an array of 3 numbers, each " + kAirVelocity.text());
  object.vector("velocity", zone.velocity, kAirVelocity);
  object.number("edge", zone.edge, kEdge);
  return zone;
}

}  // namespace

Wind read_wind(const json& value, const std::string& path, Report& report) {
  constexpr Range kSpeed{0, 100, "m/s"};
  Wind wind;
  Object object(value, path, report);
  object.direction("direction", wind.direction, kComponent);
  object.require("speed", kSpeed);
  object.number("speed", wind.speed, kSpeed);
  if (const json* gusts = object.find("gusts")) {
    wind.gusts = read_gusts(*gusts, object.path("gusts"), report);
  }
  if (const json* turbulence = object.find("turbulence")) {
    wind.turbulence = read_turbulence(*turbulence, object.path("turbulence"), report);
  }
  object.each("zones", 0, kMaxWindZones, [&](const json& zone, const std::string& at) {
    wind.zones.push_back(read_zone(zone, at, report));
  });
  return wind;
}

}  // namespace weft::scene
