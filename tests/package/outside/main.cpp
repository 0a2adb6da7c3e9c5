// A project outside Weft: simulates a falling cloth with the installed libraries and encodes one frame of it.
#include <protocol/frame.h>
#include <weft/world.h>

#include <cstdio>

int main() {
  weft::World world = weft::World::parse(R"({
    "cloths": [{"name": "sheet", "levels": {"min": 4, "max": 4}}],
    "effects": [{"type": "gravity"}], "time_step": 0.016666666666666666, "integrator": {"type": "symplectic_euler"}})");
  world.step(60);

  // Free fall for 1 s: between -g t^2/2 and symplectic Euler's -g t (t + h)/2, h = 1/60 s without substeps.
  const weft::World::Cloth sheet = world.cloth("sheet");
  const double y = sheet.centre()[1];

  // A frame's positions are in rows of their own for each axis.
  const auto rows = static_cast<std::size_t>(sheet.rows()),
             columns = static_cast<std::size_t>(sheet.columns());
  std::vector<float> axes[3];
  const std::span<const float> positions = sheet.positions();
  for (std::size_t i = 0; i < 3 * rows * columns; ++i) axes[i % 3].push_back(positions[i]);
  const weft::protocol::GridView view{{axes[0].data(), axes[1].data(), axes[2].data()},
                                      sheet.rows(),
                                      sheet.columns(),
                                      sheet.columns(),
                                      1,
                                      {0, 0, 0}};
  auto record = weft::protocol::encode_cloth_record({}, 0, 4, 4, 16, view);
  weft::protocol::mark_last(record, 0);
  weft::protocol::Frame frame;
  std::string error;
  const bool decoded = weft::protocol::decode_frame(record, frame, error);
  std::printf("centre at %g m, %zu bytes %s\n", y, record.size(), error.c_str());
  return decoded && y < -4.904 && y > -4.987 && frame.cloths.size() == 1 ? 0 : 1;
}
