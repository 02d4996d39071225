#include "swiftlet/ground/cli/fly_options.hpp"

#include <cstdint>
#include <limits>

namespace swiftlet::ground {

void add_mission_options(runtime::CommandLine app, FlyOptions& options) {
  app.add_option(
         "mission", options.mission,
         "mission file, or the name of one in the configuration; also a trajectory or waypoints as CSV, or a "
         "QGroundControl .plan")
      .show_default();
  app.add_option("--vehicle", options.vehicle, "vehicle file or name").show_default();
  app.add_option("--control", options.control,
                 "control settings, file or name: motor_lag, or paper for the paper's own loops")
      .show_default();
  app.add_option("--simulation", options.simulation, "simulation settings, file or name").show_default();
  app.add_option("--seed", options.seed, "of all that is random in the simulation")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  app.add_option("--imu-rate", options.imu_rate_hz,
                 "IMU and inner-loop rate, Hz; as the simulation file says unless given")
      .one_of({500, 1000});
}

void add_fly_options(runtime::CommandLine app, FlyOptions& options) {
  add_mission_options(app, options);
  app.add_option(
      "--record", options.record,
      "folder for flight.csv, report.json, flight.png and logs; flights/<date>-<mission> unless given");
  app.add_flag(
      "--sensors", options.sensors,
      "keep sensors.csv in the record, every IMU sample, command, pose, voltage and rotor speed, for "
      "`swiftlet identify flight`");
  app.add_flag("--json", options.json, "print one JSON object instead of the summary");
}

runtime::Option add_vary_option(runtime::CommandLine app, FlyOptions& options) {
  return app.add_option(
      "--dispersion", options.dispersion,
      "dispersion file, or the name of one in the configuration: what differs from seed to seed "
      "in the vehicle that flies and in its world; the controller knows the vehicle file. "
      "Or `uncertainty`: what that file says of how sure its parameters are");
}

}  // namespace swiftlet::ground
