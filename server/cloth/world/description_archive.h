#pragma once
/// Descriptions that change while a scene runs, as they are written down (archive.h).
#include "cloth/core/archive.h"
#include "cloth/levels/settle.h"
#include "cloth/world/description.h"

namespace weft {

// --- Materials ---

template <class Archive>
void serialize(Archive& archive, Stiffness& stiffness) {
  archive(stiffness.warp, stiffness.weft);
}
template <class Archive>
void serialize(Archive& archive, Rigidity& rigidity) {
  archive(rigidity.u, rigidity.v, rigidity.twist);
}
template <class Archive>
void serialize(Archive& archive, StrainLimit& limit) {
  archive(limit.warp, limit.weft, limit.shear, limit.stiffening);
}
template <class Archive>
void serialize(Archive& archive, Material& material) {
  archive(material.density, material.structural, material.shear, material.bending, material.damping,
          material.rigidity, material.limit);
}

// --- Wind ---

template <class Archive>
void serialize(Archive& archive, BoxZone& zone) {
  archive(zone.size, zone.orientation);
}
template <class Archive>
void serialize(Archive& archive, SphereZone& zone) {
  archive(zone.radius);
}
template <class Archive>
void serialize(Archive& archive, WindZone& zone) {
  archive(zone.shape, zone.position, zone.velocity, zone.edge);
}
template <class Archive>
void serialize(Archive& archive, Wind& wind) {
  archive(wind.direction, wind.speed, wind.gusts.intensity, wind.gusts.time_scale, wind.turbulence.intensity,
          wind.turbulence.length_scale, wind.zones);
}

// --- Things ---

template <class Archive>
void serialize(Archive& archive, Waypoint& point) {
  archive(point.time, point.position);
}
template <class Archive>
void serialize(Archive& archive, Pose& pose) {
  archive(pose.position, pose.orientation);
}
template <class Archive>
void serialize(Archive& archive, PoseWaypoint& point) {
  archive(point.time, point.pose);
}
template <class Archive>
void serialize(Archive& archive, PinRegion& pin) {
  archive(pin.u_min, pin.u_max, pin.v_min, pin.v_max, pin.path, pin.loop, pin.obstacle, pin.ball, pin.motion,
          pin.from, pin.until, pin.stiffness);
}
template <class Archive>
void serialize(Archive& archive, BallDescription& ball) {
  archive(ball.position, ball.radius, ball.velocity, ball.motion, ball.mass, ball.friction, ball.path,
          ball.loop);
}

// --- Integrators ---

template <class Archive>
void serialize(Archive& archive, SymplecticEulerDescription& method) {
  archive(method.substeps, method.safety);
}
template <class Archive>
void serialize(Archive& archive, ImplicitParameters& method) {
  archive(method.substeps, method.tolerance, method.newton_iterations, method.linear_iterations,
          method.liveliness);
}
template <class Archive>
void serialize(Archive& archive, BackwardEulerDescription& method) {
  archive(static_cast<ImplicitParameters&>(method));
}
template <class Archive>
void serialize(Archive& archive, Bdf2Description& method) {
  archive(static_cast<ImplicitParameters&>(method));
}
template <class Archive>
void serialize(Archive& archive, XpbdDescription& method) {
  archive(method.substeps, method.longest_substep);
}

}  // namespace weft
