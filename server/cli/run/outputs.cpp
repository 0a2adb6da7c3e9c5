#include "cli/run/outputs.h"

namespace weft::cli {
namespace {

MeshFrame mesh_of(const Simulation<float>& simulation, std::size_t cloth, int frame) {
  const Particles<float>& particles = simulation.cloths()[cloth].particles();
  const Grid& grid = particles.grid();
  MeshFrame mesh{frame, simulation.time(), grid.rows, grid.cols, {}, {}};
  mesh.positions.reserve(static_cast<std::size_t>(grid.nodes()) * 3);
  mesh.velocities.reserve(static_cast<std::size_t>(grid.nodes()) * 3);
  const auto append = [](std::vector<float>& values, const VectorField<float>& field, int r, int c) {
    values.insert(values.end(), {field.x.at(r, c), field.y.at(r, c), field.z.at(r, c)});
  };
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      append(mesh.positions, particles.position, r, c);
      append(mesh.velocities, particles.velocity, r, c);
    }
  }
  mesh.place = {particles.place.x(), particles.place.y(), particles.place.z()};
  const Cloth<float>& torn = simulation.cloths()[cloth];
  if (torn.walls() != nullptr) mesh.torn_faces = torn.walls()->at(torn.level()).torn_faces();
  return mesh;
}

ExportedScene exported(const scene::Scene& scene, const Simulation<float>& simulation, int frames) {
  ExportedScene exported{scene.name, {}, {}, scene.simulation.time_step, frames};
  for (const ClothDescription& cloth : scene.simulation.cloths) exported.cloths.push_back(cloth.name);
  for (const Ball& ball : simulation.colliders().balls())
    exported.bodies.push_back(body_mesh("ball-" + std::to_string(ball.id), Sphere{ball.radius}));
  const auto& obstacles = simulation.colliders().obstacles();
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    exported.bodies.push_back(body_mesh("obstacle-" + std::to_string(i), obstacles[i].solid.shape));
  return exported;
}

/// In the order of exported().
std::vector<Pose> poses(const Colliders& colliders) {
  std::vector<Pose> poses;
  for (const Ball& ball : colliders.balls()) poses.push_back({ball.position, Quaternion::Identity()});
  for (const Obstacle& obstacle : colliders.obstacles())
    poses.push_back({obstacle.pose.position, Quaternion(obstacle.solid.rotation)});
  return poses;
}

}  // namespace

RunOutputs::RunOutputs(const std::vector<std::string>& meshes, const std::string& stats, int frames,
                       const scene::Scene& scene, const Simulation<float>& simulation)
    : stats_path_(stats) {
  for (const std::string& path : meshes)
    writers_.push_back(SceneWriter::open(path, exported(scene, simulation, frames)));
  if (!stats.empty()) stats_ = std::make_unique<StatsWriter>(stats, scene.simulation.cloths.size() > 1);
}

void RunOutputs::write(int frame, const Simulation<float>& simulation) {
  if (stats_) stats_->write(frame, simulation);
  if (writers_.empty()) return;
  SceneFrame meshes{{}, poses(simulation.colliders())};
  for (std::size_t cloth = 0; cloth < simulation.cloths().size(); ++cloth)
    meshes.cloths.push_back(mesh_of(simulation, cloth, frame));
  for (const auto& writer : writers_) writer->write(meshes);
}

void RunOutputs::finish() {
  for (const auto& writer : writers_) writer->finish();
  if (stats_) stats_->finish();
}

std::vector<std::string> RunOutputs::files() const {
  std::vector<std::string> files;
  for (const auto& writer : writers_) {
    const std::vector<std::string> written = writer->files();
    files.insert(files.end(), written.begin(), written.end());
  }
  if (stats_) files.push_back(stats_path_);
  return files;
}

}  // namespace weft::cli
