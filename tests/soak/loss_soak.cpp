// Flies while the network loses datagrams, and prints a row for each flight.
#include <cstdio>
#include <string>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/soak/loss_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

int run(const LossSettings& first, int flights) {
  std::printf("%d %% of all frames lost at each host in each direction, %d waypoints uploaded\n",
              first.percent, first.waypoints);
  std::printf("%7s %9s %9s %9s %9s %9s  %s\n", "seed", "upload s", "clear s", "rms mm", "peak mm", "gap s",
              "result");
  int good = 0;
  for (int flight = 0; flight < flights; ++flight) {
    LossSettings settings = first;
    settings.seed += static_cast<std::uint64_t>(flight);
    tests::TemporaryFolder folder;
    const LossResult result = fly_with_losses(settings, folder.path());
    good += result.good() ? 1 : 0;
    std::printf("%7llu %9.2f %9.2f %9.2f %9.2f %9.2f  %s\n", static_cast<unsigned long long>(settings.seed),
                result.upload_s, result.clear_s, result.flight.rms_m * 1e3, result.flight.peak_m * 1e3,
                result.flight.longest_gap_s,
                result.good() ? "completed" : ("FAILED " + result.fault).c_str());
    if (!result.good()) {
      folder.keep();
      std::printf("logs: %s\n", folder.path().c_str());
    }
    std::fflush(stdout);
  }
  std::printf("%d of %d flights completed with an rms error below %.0f mm\n", good, flights,
              kLargestRms_m * 1e3);
  return good == flights ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet;
  soak::LossSettings settings;
  int flights = 20;
  int exit_code = 0;
  const int status = runtime::run_process(
      {"loss_soak", "Flies over three hosts, network namespaces, that lose datagrams.",
       "--percent 30 --flights 3"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--percent", settings.percent, "frames that each host loses in each direction, %")
            .range(0, 90)
            .show_default();
        app.add_option("--flights", flights, "number of flights").range(1, 1000).show_default();
        app.add_option("--waypoints", settings.waypoints, "waypoints of the mission that is uploaded")
            .range(1, 2000)
            .show_default();
        app.add_option("--mission", settings.mission, "mission file, or name of one in config/missions")
            .show_default();
        app.add_option("--seed", settings.seed, "seed of the first flight").show_default();
      },
      [&] { exit_code = soak::run(settings, flights); });
  return status != 0 ? status : exit_code;
}
