// `swiftlet view`: the live page of running vehicles.
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/view/view_server.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

struct ViewOptions {
  dds::NodeSettings network;
  bool named = false;
  ViewSettings view;
  int port = ViewSettings::kDefaultPort;
  bool any_port = false;
};

int serve(const ViewOptions& options) {
  const Interrupts interrupts;
  const Context context(options.network);
  ViewSettings settings = options.view;
  settings.port = static_cast<std::uint16_t>(options.port);
  if (options.named) settings.vehicles = messages::vehicles_of_list(options.network.vehicle);
  const auto say = [](const std::string& sentence) {
    std::fprintf(stderr, "swiftlet: view: %s\n", sentence.c_str());
  };
  std::unique_ptr<ViewServer> server;
  try {
    server = std::make_unique<ViewServer>(context, settings, say);
  } catch (const std::runtime_error&) {
    if (!options.any_port || settings.port == 0) throw;
    settings.port = 0;
    server = std::make_unique<ViewServer>(context, settings, say);
  }
  std::printf("%s\n", server->url().c_str());
  std::fflush(stdout);
  std::fprintf(stderr,
               "view: open this URL in a browser or connect Foxglove to it, with ws:// in place of http://; "
               "end with Ctrl-C\n");
  while (interrupts.count() == 0) std::this_thread::sleep_for(50ms);
  return io::kDone;
}

}  // namespace

io::Command add_view_command(runtime::CommandLine root, const std::string& version) {
  const auto options = std::make_shared<ViewOptions>();
  options->view.program = version;
  const runtime::CommandLine app = root.add_subcommand("view", io::purpose_of("view"));
  add_network_options(app, options->network, Vehicles::kSeveral);
  runtime::Option name = app.option("--vehicle-name");
  name.when_given([options] { options->named = true; }).show_default("all of the domain");
  app.add_option("--listen", options->view.address,
                 "IP address to listen at; of other interfaces than loopback, such as 0.0.0.0 for all, the "
                 "URL holds a token "
                 "that each request needs")
      .check(fault_of_listen_address, "ADDRESS")
      .show_default();
  app.add_option("--port", options->port, "TCP port; 0: any that is free").range(0, 65535).show_default();
  app.add_flag("--any-port", options->any_port, "another port that is free, if that one is in use");
  app.add_option("--allow-origin", options->view.origins,
                 "let pages of this origin connect too, such as https://app.foxglove.dev; may be repeated")
      .repeated()
      .type_name("ORIGIN");
  app.footer(
      "Prints the URL of the page. Vehicles that appear later are shown too. The page sends hold, land and "
      "stop.\n"
      "example: swiftlet view --domain 0\nexample: swiftlet view --vehicle-name kl1,kl2 --listen 0.0.0.0");
  return {app, [options] { return serve(*options); }};
}

}  // namespace swiftlet::ground
