#include "tests/soak/loss_flight.hpp"

#include <chrono>
#include <fstream>
#include <random>
#include <vector>

#include <fmt/core.h>

#include "tests/support/network/network_namespace.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using tests::HostNetwork;

constexpr auto kRequestTimeout = 30s;

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
  for (int host = 0; host < NetworkFlight::kHosts; ++host) network.run(host, "nft -f " + rules.string());
}

// Waypoints in random places near each other: the battery lasts for all of them.
std::filesystem::path write_long_mission(const LossSettings& settings, const std::filesystem::path& folder) {
  std::mt19937_64 random(settings.seed);
  std::uniform_real_distribution<double> place(-0.02, 0.02);
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
double ask(const NetworkFlight& flight, const std::vector<std::string>& words, std::string& fault) {
  const auto begin = Clock::now();
  const tests::ProgramResult result = flight.ground(words, kRequestTimeout);
  if (result.exit_code == 0) return std::chrono::duration<double>(Clock::now() - begin).count();
  fault += words[0] + " " + words[1] + ": " + result.errors;
  return -1.0;
}

}  // namespace

bool LossResult::good() const {
  return upload_s >= 0.0 && clear_s >= 0.0 && flight.completed && flight.rms_m < kLargestRms_m &&
         flight.refused == 0;
}

LossResult fly_with_losses(const LossSettings& settings, const std::filesystem::path& folder) {
  NetworkFlight flight(folder);
  lose_datagrams(flight.network(), settings.percent, folder);
  const std::string long_mission = write_long_mission(settings, folder).string();
  flight.start(settings.seed);
  LossResult result;
  result.upload_s = ask(flight, {"mission", "upload", long_mission, "--timeout", "10"}, result.fault);
  result.clear_s = ask(flight, {"mission", "clear", "--timeout", "10"}, result.fault);
  result.flight = flight.fly(settings.mission);
  result.fault += result.flight.fault;
  return result;
}

}  // namespace swiftlet::soak
