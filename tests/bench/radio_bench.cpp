// Tracking error of a Crazyflie that is commanded over a radio, for each level at which it closes its inner loops itself.
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "swiftlet/analysis/tuning/delay_design.hpp"
#include "swiftlet/ground/cli/analysis/level_gains.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/simulation/mission_runner.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"

namespace swiftlet::ground {
namespace {

using plant::ControlLevel;

struct Options {
  std::string vehicle = "crazyflie2";
  double loss = 0.02;
  double jitter_s = 0.004;
  std::uint64_t seed = 1;
  bool json = false;
};

// nullopt: not completed.
std::optional<record::TrackingErrors> fly_square(const plant::Vehicle& vehicle,
                                                 const plant::SimulationSettings& world,
                                                 const control::ControlSettings& settings,
                                                 std::uint64_t seed) {
  simulation::ClosedLoop loop(vehicle, world, settings, seed);
  control::Mission mission =
      io::load_mission_file(io::find_config("missions/square.yaml"), settings.limits).mission;
  mission.id = 1;
  const double planned_s = io::planned_duration_s(mission, settings.limits);
  record::Flight flight;
  const simulation::SimulatedFlight done = simulation::fly(loop, mission, planned_s, {&flight, nullptr, {}});
  if (!done.completed) return std::nullopt;
  return record::evaluate(flight).errors;
}

std::string text_of(const std::optional<record::TrackingErrors>& errors) {
  if (!errors) return "    lost          ";
  char text[64];
  std::snprintf(text, sizeof text, "%8.1f %9.1f", 1e3 * errors->rms_3d_m, 1e3 * errors->peak_3d_m);
  return text;
}

int run(const Options& options) {
  const plant::Vehicle vehicle =
      io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  const control::ControlSettings settings =
      io::load_control_settings(io::find_config("control/motor_lag.yaml"));
  plant::SimulationSettings world = io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!options.json) {
    std::printf("%s, square, %.0f %% loss, %.0f ms of jitter; errors in mm\n", vehicle.name.c_str(),
                100.0 * options.loss, 1e3 * options.jitter_s);
    std::printf("             one way  default gains       tuned for the delay\n");
    std::printf("level             ms      rms      peak  bandwidth %%      rms      peak\n");
  }
  bool all_flew = true;
  for (const ControlLevel level :
       {ControlLevel::kRates, ControlLevel::kAttitude, ControlLevel::kTrajectory}) {
    world.control_levels = level;
    for (const double delay_s : {0.0, 0.01, 0.02, 0.04}) {
      const double jitter_s = delay_s > 0.0 ? options.jitter_s : 0.0;
      world.radio = {delay_s, jitter_s, options.loss};
      const std::optional<record::TrackingErrors> flown = fly_square(vehicle, world, settings, options.seed);
      all_flew = all_flew && flown;
      analysis::DelayDesign tuned{1.0, settings, {}};
      if (level != ControlLevel::kTrajectory && delay_s > 0.0)
        tuned = analysis::design_for_delay(vehicle, settings, 2.0 * (delay_s + jitter_s),
                                           {level, vehicle_loops(vehicle)});
      const std::optional<record::TrackingErrors> slower =
          tuned.factor < 1.0 ? fly_square(vehicle, world, tuned.settings, options.seed) : flown;
      if (options.json) {
        const auto rms = [](const auto& e) { return e ? nlohmann::ordered_json(e->rms_3d_m) : nullptr; };
        rows.push_back({{"level", plant::to_string(level)},
                        {"delay_s", delay_s},
                        {"rms_3d_m", rms(flown)},
                        {"tuned_factor", tuned.factor},
                        {"tuned_rms_3d_m", rms(slower)}});
      } else {
        std::printf("%-13s %6.0f %s %12.0f %s\n", plant::to_string(level), 1e3 * delay_s,
                    text_of(flown).c_str(), 100.0 * tuned.factor, text_of(slower).c_str());
      }
    }
  }
  if (options.json) std::printf("%s\n", rows.dump(2).c_str());
  return all_flew ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::ground

int main(int argc, char** argv) {
  using namespace swiftlet;
  ground::Options options;
  int exit_code = 0;
  const int status = runtime::run_process(
      {"radio_bench", "Flies the square over a radio at each level.", "--loss 0.05"}, argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--vehicle", options.vehicle, "vehicle file, or the name of one").show_default();
        app.add_option("--loss", options.loss, "share of the packets that are lost")
            .range(0.0, 0.9)
            .show_default();
        app.add_option("--jitter", options.jitter_s, "additional delay, uniform from 0 to this, s")
            .range(0.0, 0.2)
            .show_default();
        app.add_option("--seed", options.seed, "random seed").show_default();
        app.add_flag("--json", options.json, "print JSON");
      },
      [&] { exit_code = ground::run(options); });
  return status != 0 ? status : exit_code;
}
