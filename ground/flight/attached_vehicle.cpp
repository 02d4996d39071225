#include "swiftlet/ground/flight/attached_vehicle.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/reach.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using control::Mode;

constexpr auto kDiscoveryTimeout = 5s;
constexpr auto kStartTimeout = 15s;  // of control, beside other processes of the vehicle
constexpr auto kReportTimeout = 1s;
constexpr auto kFilesTimeout = 5s;       // latched, sent in fragments
constexpr auto kMissionTimeout = 500ms;  // mission_status arrives with control_status

bool finds(const View& view, const std::string& process) {
  const auto peer = view.peers.find(process);
  return peer != view.peers.end() && peer->second > 0;
}

// True if no process of the vehicle is discovered or heard; other ground tools do not count.
bool finds_nothing(const View& view) {
  const bool heard = view.vehicle.seen() || view.battery.seen();
  return !heard && std::none_of(view.peers.begin(), view.peers.end(),
                                [](const auto& peer) { return peer.first != "ground" && peer.second > 0; });
}

// Where it looks for the processes: "lo (127.0.0.1) only; with ... on ...".
std::string interfaces_of(const dds::NodeSettings& network) {
  if (!network.on_loopback()) return io::interfaces_text(false) + dds::search_text(network);
  return io::interfaces_text(true) + " only; " +
         (network.localhost_only ? "without --localhost-only" : "with --network-key FILE or --open-network") +
         " on " + io::interfaces_text(false);
}

std::string flight_of(const View& view) {
  const auto mode = static_cast<Mode>(view.control.message.mode());
  const std::string text = control::to_string(mode);
  if (mode != Mode::kMission || !view.mission.seen())
    return text + " (" + view.control.message.reason().c_str() + ")";
  return fmt::format("{}, item {} of {}", text, view.mission.message.item_index() + 1,
                     view.mission.message.item_count());
}

StandingVehicle reported_by(Client& client) {
  StandingVehicle vehicle{std::make_unique<RunningFiles>(client, kFilesTimeout), std::nullopt};
  client.wait(kReportTimeout, [](const View& news) { return news.estimate.seen(); });
  const View view = client.view();
  const auto& position_ned = view.estimate.message.position_ned();
  if (view.estimate.seen() && view.control.message.has_pose())
    vehicle.start_ned.emplace(position_ned[0], position_ned[1]);
  return vehicle;
}

bool is_on_ground(Mode mode) { return control::rotors_off(mode) || mode == Mode::kArmed; }

StandingVehicle require_on_ground(Client& client, const dds::NodeSettings& network) {
  const auto is_found = [](const View& view) { return view.control.seen(); };
  bool found = client.wait(kDiscoveryTimeout, is_found);
  if (!found && !finds_nothing(client.view()) && !finds(client.view(), "control"))
    found = client.wait(kStartTimeout, is_found);
  const View view = client.view();
  if (!found) throw std::runtime_error("looked on " + interfaces_of(network) + ": " + client.no_control());
  if (is_on_ground(static_cast<Mode>(view.control.message.mode()))) return reported_by(client);
  client.wait(kMissionTimeout, [](const View& news) { return news.mission.seen(); });
  throw std::runtime_error(
      fmt::format("vehicle {} is in flight: {}; wait until it has landed, or end its flight with `swiftlet "
                  "hold` and `swiftlet land`",
                  client.vehicle(), flight_of(client.view())));
}

}  // namespace

std::vector<StandingVehicle> require_on_ground(const dds::NodeSettings& network,
                                               const std::vector<std::string>& vehicles) {
  const dds::Participant participant(network);
  std::vector<StandingVehicle> standing;
  for (const std::string& vehicle : vehicles) {
    dds::NodeSettings settings = network;
    settings.vehicle = vehicle;
    Client client(participant, settings);
    standing.push_back(require_on_ground(client, settings));
  }
  return standing;
}

}  // namespace swiftlet::ground
