// Simulates hours of flight with random faults. Reports the consequences of each kind and every flight that
// leaves the fence or is upside down with its rotors running. Every flight repeats with its seed.
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/soak/soak_flight.hpp"

namespace swiftlet::soak {
namespace {

struct Options {
  double minutes = 30.0;
  std::uint64_t seed = 1;
  std::uint64_t flight = 0;  // 0: all of them
  std::string control = "motor_lag";
  bool json = false;
};

using Counts = std::array<int, kConsequences>;

struct Summary {
  std::array<Counts, plant::kFaultKinds> consequences{};
  int flights = 0;
  int take_offs = 0;
  int lying = 0;
  double simulated_s = 0.0;
  double airborne_s = 0.0;
  double most_outside_m = 0.0;
  std::vector<SoakFlight> violating;

  void add(const SoakFlight& flight) {
    ++flights;
    take_offs += flight.take_offs;
    lying += flight.lies ? 1 : 0;
    simulated_s += flight.simulated_s;
    airborne_s += flight.airborne_s;
    most_outside_m = std::max(most_outside_m, flight.most_outside_m);
    for (const MetFault& met : flight.faults) {
      if (met.fault.at_s > flight.simulated_s) continue;
      ++consequences[static_cast<std::size_t>(met.fault.kind)][static_cast<std::size_t>(met.consequence)];
    }
    if (flight.violation) violating.push_back(flight);
  }
};

int count(const Counts& counts, Consequence consequence) {
  return counts[static_cast<std::size_t>(consequence)];
}

std::string repeat_command(const Options& options, const SoakFlight& flight) {
  return "./dev soak faults --flight " + std::to_string(flight.seed) +
         (options.control == "motor_lag" ? "" : " --control " + options.control);
}

void print_table(const Summary& summary, const Options& options) {
  std::printf("%-18s %9s %8s %8s %8s %8s %8s\n", "fault in the air", "met", "flew on", "landed", "descended",
              "stopped", "fell");
  Counts all{};
  const auto row = [](const char* name, const Counts& counts) {
    int met = 0;
    for (int i = 1; i < kConsequences; ++i) met += counts[static_cast<std::size_t>(i)];
    std::printf("%-18s %9d %8d %8d %8d  %8d %8d\n", name, met, count(counts, Consequence::kFlewOn),
                count(counts, Consequence::kLanded), count(counts, Consequence::kDescended),
                count(counts, Consequence::kStopped), count(counts, Consequence::kFell));
  };
  for (std::size_t kind = 0; kind < plant::kFaultKinds; ++kind) {
    const Counts& counts = summary.consequences[kind];
    for (std::size_t i = 0; i < counts.size(); ++i) all[i] += counts[i];
    row(plant::to_string(static_cast<plant::FaultKind>(kind)), counts);
  }
  row("all", all);
  std::printf(
      "%.1f minutes simulated in %d flights, %.1f of them in the air, %d take-offs; %d faults on the ground; "
      "%d flights ended lying on the ground\n",
      summary.simulated_s / 60.0, summary.flights, summary.airborne_s / 60.0, summary.take_offs,
      count(all, Consequence::kOnGround), summary.lying);
  std::printf("farthest outside the fence: %.2f m, the limit is %.2f m\n",
              std::max(summary.most_outside_m, 0.0), kFenceMargin_m);
  for (const SoakFlight& flight : summary.violating) {
    std::printf("violation: %s at %.1f s; repeat with: %s\n", flight.violation->what.c_str(),
                flight.violation->at_s, repeat_command(options, flight).c_str());
  }
  std::printf("violations: %zu\n", summary.violating.size());
}

void print_json(const Summary& summary, const Options& options) {
  nlohmann::json json;
  for (std::size_t kind = 0; kind < plant::kFaultKinds; ++kind) {
    const Counts& counts = summary.consequences[kind];
    json["faults"][plant::to_string(static_cast<plant::FaultKind>(kind))] = {
        {"on_ground", count(counts, Consequence::kOnGround)},
        {"flew_on", count(counts, Consequence::kFlewOn)},
        {"landed", count(counts, Consequence::kLanded)},
        {"descended", count(counts, Consequence::kDescended)},
        {"stopped", count(counts, Consequence::kStopped)},
        {"fell", count(counts, Consequence::kFell)}};
  }
  json["flights"] = summary.flights;
  json["take_offs"] = summary.take_offs;
  json["lying"] = summary.lying;
  json["simulated_s"] = summary.simulated_s;
  json["airborne_s"] = summary.airborne_s;
  json["most_outside_m"] = summary.most_outside_m;
  json["violations"] = nlohmann::json::array();
  for (const SoakFlight& flight : summary.violating) {
    json["violations"].push_back({{"seed", flight.seed},
                                  {"at_s", flight.violation->at_s},
                                  {"what", flight.violation->what},
                                  {"repeat", repeat_command(options, flight)}});
  }
  std::printf("%s\n", json.dump(2).c_str());
}

// Returns true without violations.
bool soak(const Options& options) {
  const SoakSetup setup = load_setup(options.control);
  Summary summary;
  if (options.flight > 0) {
    const Log log = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
    summary.add(fly(setup, options.flight, log));
  }
  for (std::uint64_t seed = options.seed; options.flight == 0 && summary.simulated_s < options.minutes * 60.0;
       ++seed) {
    summary.add(fly(setup, seed));
  }
  options.json ? print_json(summary, options) : print_table(summary, options);
  return summary.violating.empty();
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet;
  soak::Options options;
  bool passed = false;
  const int code = runtime::run_process(
      {"faults_soak",
       "Flies with random faults and checks that the vehicle stays inside the fence and upright.",
       "--minutes 30 --seed 1"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--minutes", options.minutes, "minutes of simulated time")
            .range(0.1, 1e5)
            .show_default();
        app.add_option("--seed", options.seed, "seed of the first flight, incremented for each flight")
            .show_default();
        app.add_option("--flight", options.flight, "fly only the flight of this seed, and log its events");
        app.add_option("--control", options.control, "control settings").show_default();
        app.add_flag("--json", options.json, "print JSON");
      },
      [&] { passed = soak::soak(options); });
  return code != 0 ? code : passed ? 0 : 1;
}
