#include "tests/bench/rough_air.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"
#include "tests/support/flight_setup.hpp"

namespace swiftlet::bench {
namespace {

using World = tests::FlightSetup;  // what is flown, and what it is flown in

struct Law {
  const char* name;
  std::function<void(control::ControlSettings&)> choose;
};

struct Condition {
  const char* name;
  double share;                                    // of the flights
  std::function<void(World&, std::uint64_t)> set;  // by the seed
};

struct Result {
  bool completed = false;
  double squares = 0.0;  // m^2, sum over the samples
  std::size_t samples = 0;
  double takeoff_peak_m = 0.0;
  double peak_m = 0.0;
};

Result fly(const World& world, std::uint64_t seed) {
  control::Mission mission =
      io::load_mission_file(io::find_config("missions/square.yaml"), world.control.limits).mission;
  mission.id = 1;
  simulation::ClosedLoop loop(world.flown, world.nominal, world.simulation, world.control, seed);
  Result result;
  const auto watch = [&] {
    const control::MissionProgress& progress = loop.controller.status().mission;
    const bool landing = progress.item_index + 1 == progress.item_count;
    if (progress.state != control::MissionState::kRunning || landing) return;
    const double error_m = loop.tracking_error().norm();
    result.squares += error_m * error_m;
    ++result.samples;
    result.peak_m = std::max(result.peak_m, error_m);
    if (progress.item_index == 0) result.takeoff_peak_m = std::max(result.takeoff_peak_m, error_m);
  };
  simulation::FlightObserver observer;
  observer.stepped = watch;
  result.completed =
      simulation::fly(loop, mission, io::planned_duration_s(mission, world.control.limits), observer)
          .completed;
  return result;
}

// Wind of 2.2 m/s from any direction, with Dryden gusts of 0.5 m/s.
void rough_wind(World& world, std::uint64_t seed) {
  constexpr double kWind = 2.2;
  const double from = 2.0 * M_PI * static_cast<double>(seed % 16) / 16.0;
  plant::AirSettings& air = world.simulation.air;
  air.wind_ned = {kWind * std::cos(from), kWind * std::sin(from), 0.0};
  air.gust_sigma_ned.setConstant(0.5);
  air.dryden = {1.0, kWind};
  world.flown.linear_drag = 0.01;
}

constexpr double kRotorRadius_m = 0.03;

const std::vector<Condition>& conditions() {
  static const std::vector<Condition> all = {
      {"nominal", 0.1, [](World&, std::uint64_t) {}},
      {"mass +10 %", 0.1, [](World& w, std::uint64_t) { w.flown.mass_kg *= 1.1; }},
      {"mass -10 %", 0.1, [](World& w, std::uint64_t) { w.flown.mass_kg *= 0.9; }},
      {"ground effect", 0.1,
       [](World& w, std::uint64_t) { w.simulation.ground.effect_rotor_radius_m = kRotorRadius_m; }},
      {"battery empties", 0.1, [](World& w, std::uint64_t) { w.flown.battery.capacity_ah *= 0.08; }},
      {"gusts", 0.1, rough_wind},
      {"gusts, mass +10 %", 1.0,
       [](World& w, std::uint64_t seed) {
         rough_wind(w, seed);
         w.flown.mass_kg *= 1.1;
       }},
  };
  return all;
}

using control::DisturbanceLaw;

constexpr double kBandwidth = 20.0;  // rad/s, of the observer

void use(control::ControlSettings& control, DisturbanceLaw law, bool learn_lift, double thrust_lead,
         double bandwidth = kBandwidth) {
  control.rough_air.law = law;
  control.rough_air.learn_lift = learn_lift;
  control.rough_air.thrust_lead = thrust_lead;
  control.disturbance.bandwidth = bandwidth;
}

const std::vector<Law>& laws() {
  static const std::vector<Law> all = {
      {"no observer",
       [](control::ControlSettings& c) { use(c, DisturbanceLaw::kObserved, false, 0.0, 0.0); }},
      {"observer", [](control::ControlSettings& c) { use(c, DisturbanceLaw::kObserved, false, 0.0); }},
      {"observer, lift learnt",
       [](control::ControlSettings& c) { use(c, DisturbanceLaw::kObserved, true, 1.0); }},
      {"incremental, lift learnt",
       [](control::ControlSettings& c) { use(c, DisturbanceLaw::kIncremental, true, 1.0); }},
      {"lead, lift learnt (default)", [](control::ControlSettings&) {}},
  };
  return all;
}

struct Row {
  std::string condition, law;
  int flights = 0, completed = 0;
  double rms_m = 0.0, worst_rms_m = 0.0, takeoff_peak_m = 0.0, peak_m = 0.0;
};

Row fly_all(const Condition& condition, const Law& law, int flights) {
  Row row{condition.name, law.name, std::max(1, static_cast<int>(std::lround(condition.share * flights)))};
  double squares = 0.0;
  std::size_t samples = 0;
  for (int seed = 1; seed <= row.flights; ++seed) {
    World world;
    condition.set(world, static_cast<std::uint64_t>(seed));
    law.choose(world.control);
    const Result result = fly(world, static_cast<std::uint64_t>(seed));
    row.completed += result.completed ? 1 : 0;
    squares += result.squares;
    samples += result.samples;
    row.worst_rms_m =
        std::max(row.worst_rms_m, std::sqrt(result.squares / static_cast<double>(result.samples)));
    row.takeoff_peak_m = std::max(row.takeoff_peak_m, result.takeoff_peak_m);
    row.peak_m = std::max(row.peak_m, result.peak_m);
  }
  row.rms_m = std::sqrt(squares / static_cast<double>(samples));
  return row;
}

}  // namespace

void fly_rough_air(const RoughOptions& options) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!options.json)
    std::printf("%-20s%-28s%10s%10s%10s%12s%10s\n", "3-D error, mm", "law", "flown", "RMS", "worst RMS",
                "take-off peak", "peak");
  for (const Condition& condition : conditions()) {
    for (const Law& law : laws()) {
      const Row row = fly_all(condition, law, options.flights);
      rows.push_back({{"condition", row.condition},
                      {"law", row.law},
                      {"flights", row.flights},
                      {"completed", row.completed},
                      {"rms_m", row.rms_m},
                      {"worst_rms_m", row.worst_rms_m},
                      {"takeoff_peak_m", row.takeoff_peak_m},
                      {"peak_m", row.peak_m}});
      if (options.json) continue;
      std::printf("%-20s%-28s%10s%10.2f%10.2f%12.1f%10.1f\n", row.condition.c_str(), row.law.c_str(),
                  fmt::format("{}/{}", row.completed, row.flights).c_str(), 1e3 * row.rms_m,
                  1e3 * row.worst_rms_m, 1e3 * row.takeoff_peak_m, 1e3 * row.peak_m);
      std::fflush(stdout);
    }
  }
  if (options.json) std::printf("%s\n", rows.dump().c_str());
}

}  // namespace swiftlet::bench
