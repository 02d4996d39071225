#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/controllers.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/client/silence.hpp"
#include "swiftlet/ground/terminal/state_lines.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/services/dds/reach.hpp"

namespace swiftlet::ground {
namespace {

struct VehicleListOptions {
  dds::NodeSettings network;
  double look_s = 2.0;
  bool json = false;
  bool names = false;
};

// A discovered vehicle.
struct Found {
  std::string name;
  View view;
  std::vector<Silence> silences{};
  double mocap_hz = 0.0;  // poses a second, accepted and refused
  int controllers = 0;
};

std::chrono::milliseconds to_milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1e3));
}

std::uint64_t poses(const View& view) {
  return view.estimate.message.poses_accepted() + view.estimate.message.poses_refused();
}

// Discovers vehicle names for half of the time, then receives the topics of each vehicle for the other half.
std::vector<Found> discover(const Context& context, const VehicleListOptions& options) {
  std::this_thread::sleep_for(to_milliseconds(0.5 * options.look_s));
  std::map<std::string, std::unique_ptr<Client>> clients;
  for (const std::string& name : context.discovered_vehicles()) {
    dds::NodeSettings network = options.network;
    network.vehicle = name;
    clients[name] = std::make_unique<Client>(context.participant(), network);
    clients[name]->hear_controllers();
  }
  std::map<std::string, View> before;
  const double listen_s = 0.25 * options.look_s;
  std::this_thread::sleep_for(to_milliseconds(listen_s));
  for (const auto& [name, client] : clients) before[name] = client->view();
  const auto start = Clock::now();
  std::this_thread::sleep_for(to_milliseconds(listen_s));
  const double time_s = std::chrono::duration<double>(Clock::now() - start).count();
  std::vector<Found> found;
  for (const auto& [name, client] : clients) {
    Found vehicle{name, client->view()};
    vehicle.silences = silences_of(vehicle.view, Clock::now());
    vehicle.controllers = controllers_of(vehicle.view, Clock::now()).count();
    if (before[name].estimate.seen())
      vehicle.mocap_hz = static_cast<double>(poses(vehicle.view) - poses(before[name])) / time_s;
    found.push_back(std::move(vehicle));
  }
  return found;
}

nlohmann::ordered_json to_json(const Found& vehicle) {
  nlohmann::ordered_json json = {{"vehicle", vehicle.name}, {"mode", nullptr}};
  if (vehicle.view.control.seen()) json["mode"] = mode_name(vehicle.view.control.message.mode());
  json["silent"] = to_json(vehicle.silences);
  json["model"] = nullptr;
  if (vehicle.view.vehicle.seen()) json["model"] = vehicle.view.vehicle.message.name().c_str();
  json["battery_v"] = nullptr;
  if (vehicle.view.battery.seen()) json["battery_v"] = vehicle.view.battery.message.voltage_v();
  json["controllers"] = vehicle.controllers;
  json["mocap_hz"] = vehicle.mocap_hz;
  return json;
}

// The mode, unless control is silent: then it is not known.
std::string mode_of(const Found& vehicle) {
  const View& view = vehicle.view;
  if (!view.control.seen()) return "no control";
  return control_is_silent(vehicle.silences) ? "SILENT" : mode_name(view.control.message.mode());
}

void print(const std::vector<Found>& vehicles) {
  for (const Found& vehicle : vehicles) {
    for (const Silence& silence : vehicle.silences)
      print_alarm(stdout, vehicle.name + ": " + to_string(silence, std::chrono::system_clock::now()));
  }
  std::size_t widest = std::strlen("vehicle");
  for (const Found& vehicle : vehicles) widest = std::max(widest, vehicle.name.size());
  const int width = static_cast<int>(widest);
  std::printf("%-*s %-12s %-12s %9s %11s %8s\n", width, "vehicle", "model", "mode", "battery", "controllers",
              "mocap");
  for (const Found& vehicle : vehicles) {
    const View& view = vehicle.view;
    const std::string battery =
        view.battery.seen() ? fmt::format("{:.2f} V", view.battery.message.voltage_v()) : "-";
    std::printf("%-*s %-12s %-12s %9s %11d %5.0f Hz\n", width, vehicle.name.c_str(),
                view.vehicle.seen() ? view.vehicle.message.name().c_str() : "-", mode_of(vehicle).c_str(),
                battery.c_str(), vehicle.controllers, vehicle.mocap_hz);
  }
}

int list_vehicles(const VehicleListOptions& options) {
  const Context context(options.network);
  const std::vector<Found> vehicles = discover(context, options);
  if (options.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Found& vehicle : vehicles) json.push_back(to_json(vehicle));
    std::printf("%s\n", io::json_text(json, 2).c_str());
  } else if (options.names) {
    for (const Found& vehicle : vehicles) std::printf("%s\n", vehicle.name.c_str());
  } else if (!vehicles.empty()) {
    print(vehicles);
  }
  if (!vehicles.empty()) return io::kDone;
  std::fprintf(stderr, "swiftlet: list: no vehicle found in domain %d within %.1f s%s; %s\n",
               options.network.domain, options.look_s, dds::search_text(options.network).c_str(),
               dds::search_advice(options.network, context.participant().refused_keys()).c_str());
  return io::kFailed;
}

}  // namespace

io::Command add_list_command(runtime::CommandLine root) {
  const auto options = std::make_shared<VehicleListOptions>();
  const runtime::CommandLine app = root.add_subcommand(
      "list", "List the vehicles of the domain: who is silent first, then mode, battery and controllers");
  add_network_options(app, options->network);
  app.remove_option("--vehicle-name");
  app.add_option("--time", options->look_s, "duration of the discovery, s").range(0.4, 60.0).show_default();
  app.add_flag("--json", options->json, "print the list as JSON");
  app.add_flag("--names", options->names, "print only the names, one a line");
  app.footer("example: swiftlet list --json | jq -r .[].vehicle");
  return {app, [options] { return list_vehicles(*options); }};
}

}  // namespace swiftlet::ground
