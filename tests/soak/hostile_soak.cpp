// Sends changed datagrams to all processes of a flight and prints how it went.
#include <cstdio>
#include <string>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/soak/hostile_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

constexpr double kAddedLate = 0.01;
constexpr double kMemoryGrowth_mib = 16.0;
constexpr double kLargestDeviation_m = 0.05;

int run(const HostileSettings& settings) {
  tests::TemporaryFolder folder;
  const HostileResult result = fly_under_attack(settings, folder.path());
  const auto row = [](const char* what, const std::string& value) {
    std::printf("  %-28s %s\n", what, value.c_str());
  };
  const auto number = [](const char* format, auto... values) {
    char text[128];
    std::snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  std::printf("%llu datagrams in %.1f s (%.0f/s)\n", static_cast<unsigned long long>(result.sent),
              result.attacked_s, static_cast<double>(result.sent) / result.attacked_s);
  std::string dead;
  for (const std::string& name : result.dead) dead += (dead.empty() ? "" : ", ") + name;
  row("processes that ended", dead.empty() ? "none" : dead);
  row("growth of memory",
      number("%.1f MiB in the second half (limit %.0f MiB)", result.memory_growth_mib, kMemoryGrowth_mib));
  bool good = result.dead.empty() && result.memory_growth_mib < kMemoryGrowth_mib;
  if (settings.network_key) {
    row("mission", result.mission_completed ? "completed" : "NOT COMPLETED");
    row("late steps before, during",
        number("%.2f %%, %.2f %% (limit: %.0f %% more)", result.late_before * 1e2, result.late_during * 1e2,
               kAddedLate * 1e2));
    row("largest deviation",
        number("%.2f cm (limit %.0f cm)", result.largest_deviation_m * 1e2, kLargestDeviation_m * 1e2));
    good = good && result.mission_completed && result.late_during - result.late_before < kAddedLate &&
           result.largest_deviation_m < kLargestDeviation_m;
    std::printf("%s\n", good ? "the attack did not disturb the flight" : "THE ATTACK DISTURBED THE FLIGHT");
  } else {
    std::printf(
        "%s; the flight is judged with --network-key only: a changed sample may pass for a true one without "
        "it\n",
        good ? "the attack ended no process" : "THE ATTACK DID HARM");
  }
  if (!good) {
    folder.keep();
    std::printf("logs: %s\n", folder.path().c_str());
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet;
  soak::HostileSettings settings;
  int exit_code = 0;
  const int status = runtime::run_process(
      {"hostile_soak", "Attacks a flight with changed datagrams, in a network namespace.",
       "--datagrams 100000 --network-key"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--datagrams", settings.datagrams, "number of datagrams")
            .range(1000, 100'000'000)
            .show_default();
        app.add_option("--rate", settings.per_second, "datagrams per second, at most")
            .range(100, 100'000)
            .show_default();
        app.add_option("--seed", settings.seed, "seed of the changes").show_default();
        app.add_flag("--network-key", settings.network_key,
                     "the flight has a network key, the attack has it not");
        app.add_flag(
            "--forge", settings.forges,
            "the attack also forges goodbyes, heartbeats and acknowledgements of the flight's participants");
      },
      [&] { exit_code = soak::run(settings); });
  return status != 0 ? status : exit_code;
}
