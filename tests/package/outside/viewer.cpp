// A project outside Weft that views a scene of a running server: viewer ws://HOST:PORT/v1/scenes/flag
#include <net/scene_client.h>

#include <chrono>
#include <cstdio>

int main(int, char** arguments) {
  using namespace weft;
  net::SceneClient scene(net::Url::parse(arguments[1]),
                         {.name = "outside", .limit = std::chrono::seconds(30)});

  std::string refused;
  try {
    scene.ask(protocol::WindSet{.direction = {1, 0, 0}, .speed = 1000});  // allowed: 0..100
  } catch (const net::RefusedError& error) {
    refused = error.code + " " + error.path;
  }

  const auto told = scene.ask(protocol::Camera{.distance = 12});
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (const auto received = scene.next_frame(until)) {
    const protocol::Frame& frame = received->frame;
    if (frame.stamp.frame < told.at("f")) continue;
    const protocol::ClothRecord& cloth = frame.cloths.at(0);
    std::printf("%s: %u x %u nodes, %s\n", scene.scene().at("name").get<std::string>().c_str(),
                static_cast<unsigned>(cloth.rows), static_cast<unsigned>(cloth.cols), refused.c_str());
    scene.close();
    return 0;
  }
  return 1;
}
