// A project outside Weft: simulates a falling cloth with the installed libraries and encodes one frame of it.
#include <cloth/world/simulation.h>
#include <protocol/frame.h>

#include <cmath>
#include <cstdio>

int main() {
  weft::SimulationDescription scene;
  scene.cloths.emplace_back();
  scene.cloths[0].initial_level = 4;
  scene.effects = {weft::GravityEffect{}};
  weft::Simulation<float> simulation(scene);
  for (int i = 0; i < 60; ++i) simulation.step();

  // Free fall for 1 s: between -g t^2/2 and symplectic Euler's -g t (t + h)/2, h = 1/60 s without substeps.
  const double y = simulation.centre(0).y();
  const weft::Vec3& place = simulation.cloths()[0].particles().place;
  const auto& position = simulation.cloths()[0].particles().position;
  const auto& grid = position.grid();
  const weft::protocol::GridView view{{position.x.row(0), position.y.row(0), position.z.row(0)},
                                      grid.rows,
                                      grid.cols,
                                      grid.stride,
                                      1,
                                      {place.x(), place.y(), place.z()}};
  auto record = weft::protocol::encode_cloth_record({}, 0, 4, 4, 16, view);
  weft::protocol::mark_last(record, 0);
  weft::protocol::Frame frame;
  std::string error;
  const bool decoded = weft::protocol::decode_frame(record, frame, error);
  std::printf("centre at %g m, %zu bytes %s\n", y, record.size(), error.c_str());
  return decoded && y < -4.904 && y > -4.987 && frame.cloths.size() == 1 ? 0 : 1;
}
