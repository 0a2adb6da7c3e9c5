#include <cmath>

#include "library/checks.h"
#include "library/parameters.h"
#include "library/world_impl.h"

namespace weft {
namespace {

using library::within;

Vec2 place_on(double u, double v) {
  return {within(u, "u", library::kShare), within(v, "v", library::kShare)};
}

}  // namespace

const std::string& World::Cloth::name() const { return world_->scene.simulation.cloths[index_].name; }
int World::Cloth::level() const { return world_->simulation.cloths()[index_].level(); }
int World::Cloth::min_level() const { return world_->scene.simulation.cloths[index_].min_level; }
int World::Cloth::max_level() const { return world_->scene.simulation.cloths[index_].max_level; }

void World::Cloth::set_level(int level) {
  const scene::Range levels{static_cast<double>(min_level()), static_cast<double>(max_level())};
  world_->simulation.request_level(index_, within(level, "level", levels));
}

int World::Cloth::rows() const { return world_->simulation.cloths()[index_].particles().grid().rows; }
int World::Cloth::columns() const { return world_->simulation.cloths()[index_].particles().grid().cols; }

std::span<const float> World::Cloth::positions() const {
  const Particles<float>& particles = std::as_const(world_->simulation).cloths()[index_].particles();
  return world_->pack(index_, particles.position, particles.place);
}

std::span<const float> World::Cloth::velocities() const {
  const Particles<float>& particles = std::as_const(world_->simulation).cloths()[index_].particles();
  return world_->pack(index_, particles.velocity, Vec3::Zero());
}

std::vector<std::uint32_t> World::Cloth::triangles() const {
  const weft::Cloth<float>& cloth = std::as_const(world_->simulation).cloths()[index_];
  std::vector<std::uint32_t> torn;
  if (cloth.walls() != nullptr) torn = cloth.walls()->at(cloth.level()).torn_faces();
  const auto columns = static_cast<std::uint32_t>(cloth.particles().grid().cols);
  const auto rows = static_cast<std::uint32_t>(cloth.particles().grid().rows);
  std::vector<std::uint32_t> corners;
  std::uint32_t face = 0;
  auto next_torn = torn.begin();
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    for (std::uint32_t c = 0; c + 1 < columns; ++c, ++face) {
      if (next_torn != torn.end() && *next_torn == face) {
        ++next_torn;
        continue;
      }
      const std::uint32_t first = r * columns + c, below = first + columns;
      corners.insert(corners.end(), {first, below, below + 1, first, below + 1, first + 1});
    }
  }
  return corners;
}

Vector World::Cloth::centre() const { return library::to_vector(world_->simulation.centre(index_)); }
double World::Cloth::mass() const { return world_->simulation.cloths()[index_].total_mass(); }

ClothState World::Cloth::state() const {
  const ClothReport report = world_->simulation.report(index_);
  const weft::Cloth<float>& cloth = std::as_const(world_->simulation).cloths()[index_];
  return {.kinetic_energy = report.kinetic_energy,
          .potential_energy = report.potential_energy,
          .max_stretch = report.strain.max,
          .max_compression = report.strain.max_compression,
          .nodes_in_contact = report.nodes_in_contact,
          .substeps = report.substeps,
          .asleep = cloth.asleep(),
          .frozen = cloth.frozen()};
}

void World::Cloth::pin(double u, double v) { world_->simulation.pin(index_, place_on(u, v)); }
bool World::Cloth::unpin(double u, double v) { return world_->simulation.unpin(index_, place_on(u, v)); }

World::Hand World::Cloth::grab(double u, double v, double max_force) {
  const double force = within(max_force, "max_force", library::kForce);
  return {*world_, world_->simulation.grab(index_, place_on(u, v), std::nullopt, force)};
}

void World::Cloth::set_parameter(std::string_view parameter, const std::vector<double>& values) {
  Material material = world_->simulation.cloths()[index_].description().material;
  library::set_material_parameter(material, world_->effects, parameter, values);
  world_->simulation.set_material(index_, material);
}

}  // namespace weft
