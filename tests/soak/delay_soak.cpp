// Flies with the controller behind a slow network, and prints a row for each delay.
#include <cstdio>
#include <string>
#include <vector>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/soak/delay_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

int run(const DelaySettings& common, const std::vector<int>& delays_ms) {
  std::printf("control behind a network with a delay each way, %d %% of the frames duplicated\n",
              common.duplicated);
  std::printf("%6s %7s %10s %8s %8s %9s %9s %8s %8s  %s\n", "delay", "jitter", "overtaken", "p50 ms",
              "p95 ms", "default", "tuned ms", "rms mm", "peak mm", "result");
  bool all_good = true;
  for (const int delay_ms : delays_ms) {
    DelaySettings settings = common;
    settings.delay_ms = delay_ms;
    settings.jitter_ms = delay_ms / 5;
    const tests::TemporaryFolder folder;
    const DelayResult result = fly_with_delay(settings, folder.path());
    all_good = all_good && result.good();
    std::printf("%6d %7d %10llu %8.1f %8.1f %8.1f%s %9.1f %8.2f %8.2f  %s\n", settings.delay_ms,
                settings.jitter_ms, static_cast<unsigned long long>(result.overtaken),
                1e3 * result.after.p50_s, 1e3 * result.after.p95_s, 1e3 * result.before.margin_s,
                result.before.near_margin ? "!" : " ", 1e3 * result.after.margin_s, 1e3 * result.flight.rms_m,
                1e3 * result.flight.peak_m,
                result.good() ? "completed" : ("FAILED " + result.flight.fault).c_str());
    std::fflush(stdout);
  }
  std::printf(
      "default and tuned: the delay that the gains tolerate, ms; ! is a warning of `swiftlet status`\n");
  return all_good ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet;
  soak::DelaySettings settings;
  std::vector<int> delays_ms = {5, 20, 50};
  int exit_code = 0;
  const int status = runtime::run_process(
      {"delay_soak", "Flies over three hosts, network namespaces, with the controller behind a slow network.",
       "--delay 20 --duplicated 5"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--delay", delays_ms, "delay each way, ms; the jitter is a fifth of it")
            .range(0, 80)
            .show_default();
        app.add_option("--duplicated", settings.duplicated, "frames that arrive twice, %")
            .range(0, 100)
            .show_default();
        app.add_option("--mission", settings.mission, "mission file, or name of one in config/missions")
            .show_default();
        app.add_option("--seed", settings.seed, "seed of the simulation and the network").show_default();
      },
      [&] { exit_code = soak::run(settings, delays_ms); });
  return status != 0 ? status : exit_code;
}
