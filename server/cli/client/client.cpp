#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/client/conversation.h"
#include "cli/commands.h"
#include "cli/exit_codes.h"

namespace weft::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

int check_health(net::Url url, const net::ClientSecurity& security) {
  url.target = base_path(url.target) + "healthz";
  const net::HttpReply reply = net::http_get(url, kConnectTime, security);
  std::printf("%u %s\n", reply.status, reply.body.c_str());
  return reply.status == 200 && reply.body == "ok" ? 0 : kFailed;
}

int client(const ClientOptions& options) {
  net::Url url = net::Url::parse(options.url);
  if (options.health) return check_health(url, options.security);
  if (url.target.ends_with('/')) url.target += std::string(kScenesPath) + options.scene;
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });
  return Conversation(options, url).run(interrupted);
}

}  // namespace

void add_client(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ClientOptions>();
  CLI::App* command =
      app.add_subcommand("client", "Views and commands a scene of a running server, from a script");
  command
      ->add_option("URL", options->url,
                   "ws://HOST:PORT/v1/scenes/NAME, or http://HOST:PORT/ with --scene; behind a proxy, "
                   "http://HOST/PATH/; with TLS wss: and https:")
      ->required();
  command->add_option("--scene", options->scene, "Scene to join if the URL names none")->default_val("flag");
  auto* camera =
      command->add_option("--camera", options->distance, "The viewer's distance from every cloth, m");
  command->add_option("--eye", options->eye, "Where the viewer's eye is: X,Y,Z, m")
      ->delimiter(',')
      ->expected(3)
      ->excludes(camera);
  command->add_option("--wind", options->wind, "DX,DY,DZ,SPEED sets the wind, m/s")
      ->delimiter(',')
      ->expected(4);
  command->add_option("--ball", options->ball, "X,Y,Z,RADIUS adds a ball, m")->delimiter(',')->expected(4);
  command
      ->add_option("--throw", options->velocity, "VX,VY,VZ throws that ball, or else the scene's first, m/s")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--frames", options->frames, "Ends after so many frames (default: when interrupted)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seconds", options->seconds, "Ends after this time, s")->check(CLI::PositiveNumber);
  command
      ->add_option("--out", options->outputs,
                   "The scene as it comes, by extension: .glb, .usda, .obj (one file a frame) with its balls "
                   "and obstacles, or .pc2, .mdd and .csv, one a cloth; may be given several times")
      ->allow_extra_args(false);
  command->add_option("--script", options->script,
                      "Messages to send, one a line: a message of the protocol with \"at\", its time in s");
  command->add_option("--token", options->security.token, "The server's, where it asks for one")
      ->envname("WEFT_TOKEN");
  command
      ->add_option("--ca", options->security.authorities,
                   "Certificates (PEM) to trust with wss: and https: (default: the system's)")
      ->check(CLI::ExistingFile);
  command->add_flag("--reconnect", options->reconnect,
                    "Comes back when the connection breaks, to what it held as well");
  command->add_flag("--quiet", options->quiet, "Prints errors only");
  command->add_flag("--health", options->health, "Only asks whether the server is well (exit code 0: yes)");
  command->callback([options, &exit_code] { exit_code = client(*options); });
}

}  // namespace weft::cli
