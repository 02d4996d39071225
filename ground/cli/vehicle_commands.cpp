// `swiftlet arm`, `disarm`, `takeoff`, `goto`, `hold`, `land` and `stop`: each sends one request.
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <unistd.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

struct TakeoffOptions : RequestOptions {
  double height_m = 1.0;
  double speed = 0.5;
};

struct GotoOptions : RequestOptions {
  Vehicle::Target target;  // without its z
  std::optional<double> z_ned_m;
  std::optional<double> height_m;  // instead of z
};

struct LandOptions : RequestOptions {
  double speed = 0.4;
};

struct StopOptions : RequestOptions {
  bool yes = false;
};

// Asks for confirmation at the terminal. Throws InputError if it is refused, or without terminal and --yes.
void confirm(const StopOptions& options) {
  if (options.yes) return;
  if (isatty(STDIN_FILENO) == 0 || isatty(STDERR_FILENO) == 0)
    throw io::InputError("stop: requires --yes without a terminal: a vehicle in the air falls");
  const bool one = messages::vehicles_of_list(options.network.vehicle).size() == 1;
  std::fprintf(stderr, "The rotors turn off at once, also if %s %s in the air: %s.\nType stop to do it: ",
               options.network.vehicle.c_str(), one ? "is" : "are", one ? "it falls" : "they fall");
  std::string typed;
  std::getline(std::cin, typed);
  if (typed != "stop") throw io::InputError("stop: not confirmed, nothing was sent");
}

// Throws InputError for what every vehicle refuses: a place below the ground, a yaw that may be in degrees. The
// vehicle itself knows its minimum height and its fence.
Vehicle::Target target_of(const GotoOptions& options) {
  if (options.z_ned_m.has_value() == options.height_m.has_value())
    throw io::InputError("goto: needs either z (down: negative is up) or --height (up, above the ground)");
  Vehicle::Target target = options.target;
  target.position_ned_m.z() = options.z_ned_m ? *options.z_ned_m : -*options.height_m;
  control::Outcome outcome = control::check_above_ground("goto", target.position_ned_m.z());
  if (outcome.accepted && target.yaw_rad) outcome = control::check_yaw("goto", *target.yaw_rad);
  if (!outcome.accepted) throw io::InputError(outcome.reason);
  return target;
}

}  // namespace

io::Command add_arm_command(runtime::CommandLine root) {
  return add_plain_request_command(
      root, {"arm", "Start the rotors on the ground, if all arming checks pass; all vehicles or none",
             &Vehicle::arm, OnInterrupt::kHold, true, &Vehicle::disarm});
}

io::Command add_disarm_command(runtime::CommandLine root) {
  return add_plain_request_command(
      root, {"disarm", "Stop the rotors on the ground", &Vehicle::disarm, OnInterrupt::kNothing, true});
}

io::Command add_takeoff_command(runtime::CommandLine root) {
  const auto options = std::make_shared<TakeoffOptions>();
  const runtime::CommandLine app =
      add_request_subcommand(root, "takeoff", "Climb vertically and hold; the vehicle must be armed",
                             "swiftlet takeoff 1.2 --speed 0.5", options);
  const runtime::Option height =
      app.add_option("height_m", options->height_m, "height above the ground").positive().show_default();
  app.add_option("--height", options->height_m, "the same").positive().excludes(height);
  app.add_option("--speed", options->speed, "peak speed, m/s").positive().show_default();
  return {app, [options] {
            return run_request(*options, {"takeoff", [&](Vehicle& vehicle) {
                                            return vehicle.take_off(options->height_m, options->speed,
                                                                    options->timeout());
                                          }});
          }};
}

io::Command add_goto_command(runtime::CommandLine root) {
  const auto options = std::make_shared<GotoOptions>();
  const runtime::CommandLine app = add_request_subcommand(
      root, "goto", "Fly straight to a position (NED, relative to the origin) and hold there",
      "swiftlet goto -1 0 --height 1.5 --yaw 1.57    (1 m south, 1.5 m up, nose east)\n"
      "         swiftlet goto -1 0 -1.5 --yaw 1.57            (the same, with z down)",
      options, Vehicles::kOne);  // two vehicles cannot hold at one position
  Vehicle::Target& target = options->target;
  app.add_option("x", target.position_ned_m.x(), "north, m").required().finite();
  app.add_option("y", target.position_ned_m.y(), "east, m").required().finite();
  runtime::Option z = app.add_option("z", options->z_ned_m, "down, m: negative is up").finite();
  app.add_option("--height", options->height_m, "height above the ground, m, instead of z")
      .positive()
      .excludes(z);
  app.add_option("--yaw", target.yaw_rad,
                 "yaw at the position, rad from north to east; default: the yaw does not change")
      .finite();
  app.add_option("--speed", target.speed_m_s, "peak speed, m/s").positive().show_default();
  return {app, [options] {
            const Vehicle::Target complete = target_of(*options);
            return run_request(*options, {"goto", [&](Vehicle& vehicle) {
                                            return vehicle.go_to(complete, options->timeout());
                                          }});
          }};
}

io::Command add_hold_command(runtime::CommandLine root) {
  return add_plain_request_command(root, {"hold", "Come to rest and hold the position", &Vehicle::hold});
}

io::Command add_land_command(runtime::CommandLine root) {
  const auto options = std::make_shared<LandOptions>();
  const runtime::CommandLine app = add_request_subcommand(
      root, "land", "Descend vertically, land and stop the rotors", "swiftlet land --speed 0.3", options);
  app.add_option("--speed", options->speed,
                 "peak speed, m/s; at most descent_speed_m_s of the control settings")
      .positive()
      .show_default();
  return {app, [options] {
            return run_request(*options, {"land", [&](Vehicle& vehicle) {
                                            return vehicle.land(options->speed, options->timeout());
                                          }});
          }};
}

io::Command add_stop_command(runtime::CommandLine root) {
  const auto options = std::make_shared<StopOptions>();
  const runtime::CommandLine app =
      add_request_subcommand(root, "stop", "Emergency stop: turn the rotors off at once, also in the air",
                             "swiftlet stop --yes", options);
  app.add_flag("--yes,-y", options->yes, "do not ask for confirmation");
  return {app, [options] {
            confirm(*options);
            return run_request(*options,
                               {"stop", [&](Vehicle& vehicle) { return vehicle.stop(options->timeout()); },
                                OnInterrupt::kNothing, true});
          }};
}

}  // namespace swiftlet::ground
