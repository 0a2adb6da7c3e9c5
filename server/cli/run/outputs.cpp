#include "cli/run/outputs.h"

#include <stdexcept>

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

}  // namespace

RunOutputs::RunOutputs(const std::vector<std::string>& meshes, const std::string& stats, int frames,
                       const SimulationDescription& description) {
  const bool several = description.cloths.size() > 1;
  for (const ClothDescription& cloth : description.cloths) {
    auto& writers = writers_.emplace_back();
    for (const std::string& path : meshes) {
      files_.push_back(several ? MeshWriter::path_for_cloth(path, cloth.name) : path);
      writers.push_back(MeshWriter::open(files_.back()));
      if (frames > writers.back()->max_frames()) {
        throw std::runtime_error(path + ": holds at most " + std::to_string(writers.back()->max_frames()) +
                                 " frames; this run has " + std::to_string(frames));
      }
    }
  }
  if (stats.empty()) return;
  stats_ = std::make_unique<StatsWriter>(stats, several);
  files_.push_back(stats);
}

void RunOutputs::write(int frame, const Simulation<float>& simulation) {
  for (std::size_t cloth = 0; cloth < writers_.size(); ++cloth) {
    if (writers_[cloth].empty()) continue;
    const MeshFrame mesh = mesh_of(simulation, cloth, frame);
    for (auto& writer : writers_[cloth]) writer->write(mesh);
  }
  if (stats_) stats_->write(frame, simulation);
}

void RunOutputs::finish() {
  for (auto& writers : writers_) {
    for (auto& writer : writers) writer->finish();
  }
  if (stats_) stats_->finish();
}

}  // namespace weft::cli
