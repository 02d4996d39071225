#include "tests/soak/network_flight.hpp"

#include <cstdlib>
#include <utility>

#include <nlohmann/json.hpp>

#include "tests/support/refusals.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;

constexpr auto kFlightTimeout = 240s;

}  // namespace

NetworkFlight::NetworkFlight(std::filesystem::path folder)
    : folder_(std::move(folder)), network_(tests::HostNetwork::Layout::kSwitch, kHosts) {
  ::setenv("SWIFTLET_OPEN_NETWORK", "1", 1);  // of the programs that it starts
}

tests::Program& NetworkFlight::run(Host host, const char* program, const std::vector<std::string>& options) {
  const tests::HostNetwork::Inside inside(network_, host);
  return programs_.emplace_back(program, options, folder_);
}

void NetworkFlight::start(std::uint64_t seed, const std::vector<std::string>& control_options, Host mocap) {
  run(kVehicle, "swiftlet-plant", {"--seed", std::to_string(seed)});
  run(mocap, "swiftlet-mocap", {"--seed", std::to_string(seed)});
  run(kControl, "swiftlet-control", control_options);
}

tests::Program& NetworkFlight::start_standby() { return run(kVehicle, "swiftlet-control", {}); }

std::string NetworkFlight::log() const {
  std::string all;
  for (const tests::Program& program : programs_) all += program.errors();
  return all;
}

tests::ProgramResult NetworkFlight::ground(const std::vector<std::string>& words,
                                           std::chrono::seconds timeout) const {
  const tests::HostNetwork::Inside inside(network_, kGround);
  return tests::run_program("swiftlet", words, folder_, timeout);
}

NetworkFlight::Result NetworkFlight::fly(const std::string& mission) const {
  // The network is as bad as the flight has to stand; the check of vehicles would refuse it.
  const tests::ProgramResult flight = ground(
      {"fly", mission, "--attach", "--skip-check", "--json", "--record", (folder_ / "flight").string()},
      kFlightTimeout);
  Result result;
  const auto report = nlohmann::json::parse(flight.output, nullptr, false);
  if (report.is_discarded() || !report.is_object()) {
    result.fault = "fly: " + flight.errors;
    return result;
  }
  const auto number = [&](const char* key) {
    return report.contains(key) && report[key].is_number() ? report[key].get<double>() : 0.0;
  };
  result.completed = report.value("completed", false);
  if (!result.completed) result.fault = report.value("reason", "no reason");
  result.rms_m = number("rms_3d_m");
  result.peak_m = number("peak_3d_m");
  result.longest_gap_s = number("longest_gap_s");
  result.refused = tests::refused_datagrams(log());
  if (result.refused > 0) result.fault += std::to_string(result.refused) + " datagrams refused";
  return result;
}

}  // namespace swiftlet::soak
