#include "tests/soak/loss_flight.hpp"

#include <chrono>
#include <fstream>
#include <random>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "tests/support/network_namespace.hpp"
#include "tests/support/program.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using tests::HostNetwork;
using tests::Program;

enum Host { kVehicle, kControl, kGround, kHosts };

constexpr auto kRequestTimeout = 30s;
constexpr auto kFlightTimeout = 240s;

void lose_datagrams(const HostNetwork& network, int percent, const std::filesystem::path& folder) {
  const std::filesystem::path rules = folder / "loss.nft";
  std::ofstream file(rules);
  file << "table netdev loss {\n";
  for (const char* hook : {"egress", "ingress"}) {
    file << fmt::format(
        "  chain {0} {{\n    type filter hook {0} device \"eth0\" priority 0\n"
        "    meta protocol ip numgen random mod 100 < {1} drop\n  }}\n",
        hook, percent);
  }
  file << "}\n";
  file.close();
  for (int host = 0; host < kHosts; ++host) network.run(host, "nft -f " + rules.string());
}

// Waypoints in random places of the fence.
std::filesystem::path write_long_mission(const LossSettings& settings, const std::filesystem::path& folder) {
  std::mt19937_64 random(settings.seed);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  const std::filesystem::path path = folder / "long.yaml";
  std::ofstream file(path);
  file << "name: long\nframe: ned\ntolerance_m: 0.1\nitems:\n"
          "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5}\n";
  for (int i = 0; i < settings.waypoints; ++i) {
    file << fmt::format("  - {{kind: waypoint, position_m: [{:.4f}, {:.4f}, -1.0], speed_m_s: 0.5}}\n",
                        place(random), place(random));
  }
  file << "  - {kind: land, speed_m_s: 0.5}\n";
  return path;
}

// Duration of the tool; negative if it fails.
double ask(const std::vector<std::string>& words, const std::filesystem::path& folder, std::string& fault) {
  const auto begin = Clock::now();
  const tests::ProgramResult result = tests::run_program("swiftlet", words, folder, kRequestTimeout);
  if (result.exit_code == 0) return std::chrono::duration<double>(Clock::now() - begin).count();
  fault += words[0] + " " + words[1] + ": " + result.errors;
  return -1.0;
}

void fly(const LossSettings& settings, const std::filesystem::path& folder, LossResult& result) {
  const tests::ProgramResult flight = tests::run_program(
      "swiftlet", {"fly", settings.mission, "--attach", "--json", "--record", (folder / "flight").string()},
      folder, kFlightTimeout);
  const auto report = nlohmann::json::parse(flight.output, nullptr, false);
  if (report.is_discarded() || !report.is_object()) {
    result.fault += "fly: " + flight.errors;
    return;
  }
  const auto number = [&](const char* key) {
    return report.contains(key) && report[key].is_number() ? report[key].get<double>() : 0.0;
  };
  result.completed = report.value("completed", false);
  if (!result.completed) result.fault += report.value("reason", "no reason");
  result.rms_m = number("rms_3d_m");
  result.peak_m = number("peak_3d_m");
  result.longest_gap_s = number("longest_gap_s");
}

}  // namespace

bool LossResult::good() const {
  return upload_s >= 0.0 && clear_s >= 0.0 && completed && rms_m < kLargestRms_m;
}

LossResult fly_with_losses(const LossSettings& settings, const std::filesystem::path& folder) {
  const HostNetwork network(HostNetwork::Layout::kSwitch, kHosts);
  lose_datagrams(network, settings.percent, folder);
  const std::string long_mission = write_long_mission(settings, folder).string();
  const auto start = [&](Host host, const char* program, const std::vector<std::string>& options) {
    const HostNetwork::Inside inside(network, host);
    return Program(program, options, folder);
  };
  const Program plant = start(kVehicle, "swiftlet-plant", {"--seed", std::to_string(settings.seed)});
  const Program mocap = start(kVehicle, "swiftlet-mocap", {"--seed", std::to_string(settings.seed)});
  const Program control = start(kControl, "swiftlet-control", {});
  const HostNetwork::Inside inside(network, kGround);
  LossResult result;
  result.upload_s = ask({"mission", "upload", long_mission, "--timeout", "10"}, folder, result.fault);
  result.clear_s = ask({"mission", "clear", "--timeout", "10"}, folder, result.fault);
  fly(settings, folder, result);
  return result;
}

}  // namespace swiftlet::soak
