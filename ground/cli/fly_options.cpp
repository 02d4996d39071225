#include "swiftlet/ground/cli/fly_options.hpp"

#include <cstdint>
#include <limits>
#include <vector>

#include "swiftlet/io/configuration.hpp"

namespace swiftlet::ground {

void add_mission_options(runtime::CommandLine app, FlyOptions& options) {
  app.add_option(
         "mission", options.mission,
         "mission file, or the name of one in config/missions; also a trajectory or waypoints as CSV, or a "
         "QGroundControl .plan file")
      .type_name(io::kinds::kMission.value)
      .show_default();
  add_file_options(app, options.reading);
  app.add_option("--vehicle", options.vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("--control", options.control,
                 "control settings file, or the name of one in config/control: motor_lag, or paper for the "
                 "control laws of the paper")
      .type_name(io::kinds::kControl.value)
      .show_default();
  app.add_option("--simulation", options.simulation,
                 "simulation settings file, or the name of one in config/simulation")
      .type_name(io::kinds::kSimulation.value)
      .show_default();
  app.add_option("--seed", options.seed, "random seed of the simulation: sensor errors, dropouts and gusts")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  app.add_option("--imu-rate", options.imu_rate_hz,
                 "IMU and inner-loop rate, Hz; default: that of the simulation file")
      .one_of({"500", "1000"});
}

void add_level_option(runtime::CommandLine app, plant::ControlLevel& level) {
  using plant::ControlLevel;
  app.add_choice("--level", level,
                 {{"actuators", ControlLevel::kActuators},
                  {"rates", ControlLevel::kRates},
                  {"attitude", ControlLevel::kAttitude},
                  {"trajectory", ControlLevel::kTrajectory}},
                 "level at which the vehicle is commanded: throttles, body rates, attitude, or the "
                 "trajectory itself; at "
                 "all but actuators the simulated vehicle flies by loops of its own")
      .show_default("actuators");
}

void add_odometry_option(runtime::CommandLine app, plant::OdometrySource& odometry) {
  app.add_choice(
         "--odometry", odometry,
         {{"mocap", plant::OdometrySource::kMocap}, {"own", plant::OdometrySource::kOwnSensors}},
         "the simulated vehicle brings an estimate of its own in place of its IMU: mocap, of an "
         "on-board estimator on motion capture, or own, of sensors of its own, which drifts; needs another "
         "--level than actuators")
      .show_default("imu");
}

void add_radio_options(runtime::CommandLine app, FlyOptions& options) {
  app.add_option("--radio-delay", options.radio_delay_s,
                 "radio between vehicle and control: delay one way, s; default: that of the simulation file")
      .range(0.0, 0.2);
  app.add_option("--radio-jitter", options.radio_jitter_s,
                 "radio: additional delay, uniform from 0 to this, s; default: that of the simulation file")
      .range(0.0, 0.2);
  app.add_option("--radio-loss", options.radio_loss,
                 "radio: share of the packets that are lost; default: that of the simulation file")
      .range(0.0, 0.9);
}

void add_frame_option(runtime::CommandLine app, std::optional<io::MissionFrame>& frame) {
  app.add_choice<std::optional<io::MissionFrame>>(
      "--frame", frame,
      {{"ned", io::MissionFrame::kNed}, {"enu", io::MissionFrame::kEnu}, {"nwu", io::MissionFrame::kNwu}},
      "frame of a file that names none: ned (north, east, down), enu (east, north, up) or nwu (north, west, "
      "up)");
}

void add_file_options(runtime::CommandLine app, ReadingOptions& options) {
  add_frame_option(app, options.frame);
  app.add_option(
         "--tolerance", options.tolerance_m,
         "by how much the path may pass the samples of a CSV file by, m on each axis, and rad in yaw; "
         "default: half of the last digit with which they are written")
      .range(1e-9, 1.0);
  app.add_option(
      "--columns", options.columns,
      "names of all columns of a CSV file in order, in place of its header, such as t,x,y,z,yaw; w_ for "
      "one that is not used");
  app.add_option("--from", options.from_s,
                 "leave out the samples of a CSV file or log before this time, s from its first")
      .range(0.0, 1e6);
  app.add_option("--until", options.until_s,
                 "leave out the samples after this time, s from the first of the file")
      .range(0.0, 1e6);
  app.add_option("--scale", options.placement.scale,
                 "enlarge the file about the origin, heights too; times stay, so that paths become faster")
      .range(1e-3, 1e3)
      .show_default();
  app.add_option("--rotate", options.placement.rotate_deg,
                 "turn the file about the origin, headings too: deg, clockwise seen from above")
      .range(-360.0, 360.0)
      .show_default();
  app.add_numbers(
         "--offset", 3,
         [&options](const std::vector<double>& m) {
           options.placement.offset_ned = {m[0], m[1], m[2]};
         },
         "move the file by so many m north, east and down, after --scale and --rotate")
      .type_name("N,E,D");
  app.add_numbers(
         "--fence", 6,
         [&options](const std::vector<double>& m) {
           options.fence = io::Fence{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}};
         },
         "fence of the flight: north, east and down of two opposite corners, m, inside the fence of the "
         "control "
         "settings; in place of that of a mission file")
      .type_name("N,E,D,N,E,D");
  app.add_option(
         "--time-scale", options.time_scale,
         "fly the file so many times as slow: paths take longer, moves are flown at lower speeds; below 1 "
         "faster; holds and waits stay")
      .range(0.01, 100.0)
      .show_default();
  runtime::Option fastest = app.add_flag(
      "--as-fast-as-possible", options.as_fast_as_possible,
      "shorten the times until the vehicle meets a limit of its rotors, or of tilt, speed, "
      "acceleration or yaw rate of the control settings, by `mission check`; says which, and where");
  app.add_option(
         "--reserve", options.reserve,
         "with --as-fast-as-possible: share of the tilt limit and of the range of thrust of each rotor that "
         "is kept free")
      .range(0.0, 0.9)
      .show_default()
      .needs(fastest);
}

void add_record_options(runtime::CommandLine app, FlyOptions& options) {
  const runtime::Option record = app.add_option(
      "--record", options.record,
      "new folder for flight.mcap, report.json, flight.png and logs; default: flights/<date>-<mission>");
  app.add_flag("--replace", options.replace, "delete the record that the folder of --record holds first")
      .needs(record);
  app.add_flag("--json", options.json, "print one JSON object instead of the summary");
}

void add_fly_options(runtime::CommandLine app, FlyOptions& options) {
  add_mission_options(app, options);
  add_level_option(app, options.level);
  add_odometry_option(app, options.odometry);
  add_radio_options(app, options);
  add_record_options(app, options);
}

runtime::Option add_launch_options(runtime::CommandLine app, FlyOptions& options) {
  app.option("--localhost-only")
      .describe(
          "with --attach or --px4: use the loopback interface only, also with a key; otherwise always set");
  app.option("--open-network")
      .describe(
          "with --attach or --px4: use the network without --network-key or --security, where anyone can "
          "command the vehicles; otherwise without effect");
  app.remove_option("--domain");  // added below with another default
  app.add_option("--domain", options.domain, "DDS domain; default: a free one")
      .environment("ROS_DOMAIN_ID")
      .range(0, 232);
  runtime::Option attach = app.add_flag(
      "--attach", [&options] { options.launch_mode = LaunchMode::kAttached; },
      "start no processes: use the plant, mocap and control that run in the domain (default: 0)");
  app.add_flag("--skip-check", options.skip_check,
               "with --attach: arm the vehicle although it was not checked, see `swiftlet check vehicle`")
      .needs(attach);
  app.add_flag("--skip-hover-test", options.skip_hover_test,
               "with --attach: leave out the hover test before the first flight of a vehicle, see `swiftlet "
               "check vehicle --hover`")
      .needs(attach);
  runtime::add_clock_option(app, options.clock);
  app.add_option(
         "--speed", options.speed,
         "simulation speed factor (1 = real time); default: 1, or with --clock lockstep as fast as possible")
      .range(0.01, 100.0);
  app.add_flag("--view", options.view,
               "serve the live page of `swiftlet view` beside the flight, and print its URL");
  app.add_flag("--trace", options.trace,
               "lockstep only: write trace.csv, which holds every sample and command bit for bit");
  // Processes that it starts are on this host.
  for (const char* network_option :
       {"--network", "--peer", "--discovery-server", "--interface", "--dds-profile"})
    app.option(network_option).needs(attach);
  return attach;
}

runtime::Option add_dispersion_option(runtime::CommandLine app, FlyOptions& options) {
  return app
      .add_option(
          "--dispersion", options.dispersion,
          "dispersion file, or the name of one in config/dispersion: the distributions from which the "
          "parameters "
          "of the flown vehicle and of the simulation are sampled; the controller is designed on --vehicle. "
          "`uncertainty` samples from the parameter uncertainty in the vehicle file")
      .type_name(io::kinds::kDispersion.value);
}

}  // namespace swiftlet::ground
