// `swiftlet fleet goto`, `land` and `stop`: requests to running vehicles, all that are seen or those that are named.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/ground/cli/fleet/fleet_commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/fleet/fleet_file.hpp"
#include "swiftlet/ground/fleet/formation.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;

// For how long those that are to land wait for those that are not known yet.
constexpr std::chrono::milliseconds kPatience{1000};

struct FleetRequestOptions : RequestOptions {
  std::string names;  // empty: all that are seen
  double look_s = 1.5;
  Ellipsoid safety;
  std::string fleet;  // file whose vehicles and safety these are; empty: none
};

struct FleetGotoOptions : FleetRequestOptions {
  double north_m = 0.0;
  double east_m = 0.0;
  std::optional<double> z_ned_m;
  std::optional<double> height_m;  // instead of z
  double speed = 0.5;
  std::optional<double> skew_s;  // unset: what keeps the ways apart
  std::string control = "motor_lag";
};

struct FleetLandOptions : FleetRequestOptions {
  double speed = 0.4;
};

struct FleetStopOptions : FleetRequestOptions {
  bool yes = false;
};

// A vehicle that is seen, as it was then.
struct Seen {
  std::string name;
  VehicleState state;
  bool is_wanted = false;

  bool flies() const { return !control::rotors_off(state.mode) && state.mode != Mode::kArmed; }
};

// Names of the vehicles in the domain, sorted, then of the wanted ones that were not seen.
std::vector<std::string> names_in(const Context& context, const FleetRequestOptions& options) {
  std::this_thread::sleep_for(std::chrono::duration<double>(options.look_s));
  std::vector<std::string> names = context.discovered_vehicles();
  if (!options.names.empty()) {
    for (const std::string& name : messages::vehicles_of_list(options.names)) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  if (names.empty())
    throw std::runtime_error(
        fmt::format("no vehicle found in domain {} within {:g} s{}; {}", options.network.domain,
                    options.look_s, dds::search_text(options.network),
                    dds::search_advice(options.network, context.participant().refused_keys())));
  return names;
}

bool is_wanted(const std::string& name, const FleetRequestOptions& options) {
  if (options.names.empty()) return true;
  const std::vector<std::string> wanted = messages::vehicles_of_list(options.names);
  return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

struct Sight {
  std::vector<Seen> seen;
  std::vector<std::string> unknown;  // names of those whose mode and position are not known
};

// Looks until all are known, at most for the time-out, and no longer than `patience` after the first one is known.
Sight look(const Context& context, const std::vector<std::string>& names, const FleetRequestOptions& options,
           std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLook{20};
  const auto is_known = [](const VehicleState& state) {
    return state.age_s < 1.0 && state.reference_position_ned_m.allFinite() &&
           state.position_ned_m.allFinite();
  };
  const auto end = Clock::now() + options.timeout();
  std::vector<std::unique_ptr<Vehicle>> unknown;
  for (const std::string& name : names) unknown.push_back(std::make_unique<Vehicle>(context, name));
  Sight sight;
  std::optional<Clock::time_point> first;
  while (!unknown.empty() && Clock::now() < (first ? std::min(end, *first + patience) : end)) {
    unknown.front()->wait_until(is_known, kLook);
    for (auto vehicle = unknown.begin(); vehicle != unknown.end();) {
      const VehicleState state = (*vehicle)->state();
      if (!is_known(state)) {
        ++vehicle;
        continue;
      }
      if (!first) first = Clock::now();
      sight.seen.push_back({(*vehicle)->name(), state, is_wanted((*vehicle)->name(), options)});
      vehicle = unknown.erase(vehicle);
    }
  }
  std::sort(sight.seen.begin(), sight.seen.end(),
            [](const Seen& a, const Seen& b) { return a.name < b.name; });
  for (const std::unique_ptr<Vehicle>& vehicle : unknown) sight.unknown.push_back(vehicle->name());
  return sight;
}

// Throws std::runtime_error if the place of one is not known: it may be in the way.
std::vector<Seen> look_at_all(const Context& context, const FleetRequestOptions& options) {
  Sight sight = look(context, names_in(context, options), options, options.timeout());
  if (!sight.unknown.empty())
    throw std::runtime_error(
        fmt::format("{}: mode and position are not known: nothing was sent", fmt::join(sight.unknown, ",")));
  return std::move(sight.seen);
}

FormationVehicle formation_vehicle(const Seen& vehicle) {
  const bool flies = vehicle.flies();
  return {vehicle.name, flies ? vehicle.state.reference_position_ned_m : vehicle.state.position_ned_m, flies,
          flies && vehicle.is_wanted};
}

// Throws InputError unless all that fly hold their positions, and all that are named fly.
void require_holding(const std::vector<Seen>& seen, const FleetRequestOptions& options) {
  for (const Seen& vehicle : seen) {
    if (vehicle.flies() && vehicle.state.mode != Mode::kHolding)
      throw io::InputError(fmt::format("{} is {}; hold it first: nothing was sent", vehicle.name,
                                       control::to_string(vehicle.state.mode)));
    if (!options.names.empty() && vehicle.is_wanted && !vehicle.flies())
      throw io::InputError(vehicle.name + " does not fly: nothing was sent");
  }
}

// The options of the request for these vehicles.
RequestOptions request_to(const std::vector<std::string>& names, const FleetRequestOptions& options) {
  RequestOptions request = options;
  request.network.vehicle = fmt::format("{}", fmt::join(names, ","));
  return request;
}

// With the safety of the fleet file, and the names of its vehicles unless some are named. Throws io::ConfigError.
template <typename T>
T with_fleet(T options) {
  if (options.fleet.empty()) return options;
  const FleetFile fleet = load_fleet_file(io::configuration_file(io::kinds::kFleet, options.fleet));
  options.safety = fleet.safety;
  if (!options.names.empty()) return options;
  for (const FleetMember& member : fleet.vehicles)
    options.names += (options.names.empty() ? "" : ",") + member.name;
  return options;
}

int go_to(const FleetGotoOptions& given) {
  const FleetGotoOptions options = with_fleet(given);
  if (options.z_ned_m.has_value() == options.height_m.has_value())
    throw io::InputError("goto: needs either z (down: negative is up) or --height (up, above the ground)");
  const control::Limits limits =
      io::load_control_settings(io::configuration_file(io::kinds::kControl, options.control)).limits;
  std::vector<Seen> seen;
  {
    const Context context(options.network);
    seen = look_at_all(context, options);
  }
  require_holding(seen, options);
  std::vector<FormationVehicle> vehicles;
  std::vector<std::string> members;
  for (const Seen& vehicle : seen) {
    vehicles.push_back(formation_vehicle(vehicle));
    if (vehicles.back().is_member) members.push_back(vehicle.name);
  }
  if (members.empty()) throw io::InputError("no vehicle flies: nothing was sent");
  const Eigen::Vector3d centre(options.north_m, options.east_m,
                               options.z_ned_m.value_or(-options.height_m.value_or(0.0)));
  const std::vector<Eigen::Vector3d> targets = formation_targets(vehicles, centre);
  std::map<std::string, Eigen::Vector3d> target_of;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (!vehicles[i].is_member) continue;
    const control::Outcome above = control::check_above_ground(vehicles[i].name.c_str(), targets[i].z());
    if (!above.accepted) throw io::InputError(std::string(above.reason) + ": nothing was sent");
    target_of[vehicles[i].name] = targets[i];
  }
  const FormationMove move{options.speed, limits, options.skew_s.value_or(FormationMove().skew_s)};
  const std::string refusal = formation_refusal(vehicles, targets, move, options.safety);
  if (!refusal.empty()) throw io::InputError(refusal + ": nothing was sent");
  VehicleRequest request{
      "goto", [&](Vehicle& vehicle) {
        return vehicle.go_to({target_of.at(vehicle.name()), std::nullopt, options.speed}, options.timeout());
      }};
  request.undo = [&](Vehicle& vehicle) { return vehicle.hold(options.timeout()); };
  request.undo_from = Mode::kHolding;
  request.undone = "holds";
  request.not_undone = "does NOT hold";
  request.cause = "did not accept it";
  request.skew_s =
      options.skew_s.value_or(longest_skew_s(vehicles, targets, move, options.safety, options.timeout_s));
  return run_request(request_to(members, options), request);
}

struct Landing {
  std::size_t sent = 0;  // requests
  bool failed = false;   // one that flies and is wanted has not landed
};

// Lands the wanted ones that fly, but none on another one.
Landing land(const std::vector<Seen>& seen, const FleetLandOptions& options) {
  std::vector<FormationVehicle> vehicles;
  for (const Seen& vehicle : seen) vehicles.push_back(formation_vehicle(vehicle));
  const auto obstacles = landing_obstacles(vehicles, options.safety);
  std::vector<std::string> names;
  Landing landing;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (!vehicles[i].is_member) continue;
    if (!obstacles[i]) {
      names.push_back(vehicles[i].name);
      continue;
    }
    landing.failed = true;
    std::fprintf(stderr,
                 "swiftlet: land: %s: was not landed: it would come down on %s; move it aside first\n",
                 vehicles[i].name.c_str(), vehicles[*obstacles[i]].name.c_str());
  }
  landing.sent = names.size();
  if (names.empty()) return landing;
  const int code =
      run_request(request_to(names, options),
                  {"land", [&](Vehicle& vehicle) { return vehicle.land(options.speed, options.timeout()); }});
  if (code != io::kDone) landing.failed = true;
  return landing;
}

// Those that are known do not wait for those that are not: these are looked for again when the others have landed.
int land(const FleetLandOptions& given) {
  const FleetLandOptions options = with_fleet(given);
  const auto look_for = [&](std::vector<std::string> names, std::chrono::milliseconds patience) {
    const Context context(options.network);
    if (names.empty()) names = names_in(context, options);
    return look(context, names, options, patience);
  };
  const Sight first = look_for({}, kPatience);
  std::vector<std::string> missing;
  for (const std::string& name : first.unknown) {
    if (is_wanted(name, options)) missing.push_back(name);
  }
  Landing landing = land(first.seen, options);
  if (missing.empty() && landing.sent == 0 && !landing.failed)
    throw io::InputError("no vehicle flies: nothing was sent");
  if (!missing.empty() && !first.seen.empty()) {
    std::vector<std::string> names = missing;
    for (const Seen& vehicle : first.seen) names.push_back(vehicle.name);
    Sight later = look_for(names, options.timeout());
    for (Seen& vehicle : later.seen) {
      const auto found = std::find(missing.begin(), missing.end(), vehicle.name);
      vehicle.is_wanted = found != missing.end();
      if (vehicle.is_wanted) missing.erase(found);
    }
    if (land(later.seen, options).failed) landing.failed = true;
  }
  for (const std::string& name : missing)
    std::fprintf(stderr, "swiftlet: land: %s: was not landed: mode and position are not known\n",
                 name.c_str());
  return landing.failed || !missing.empty() ? io::kFailed : io::kDone;
}

int stop(const FleetStopOptions& options) {
  std::vector<std::string> names;
  if (options.names.empty()) {
    const Context context(options.network);
    names = names_in(context, options);
  } else {
    names = messages::vehicles_of_list(options.names);  // without looking for others: it is urgent
  }
  if (!options.yes) {
    if (isatty(STDIN_FILENO) == 0 || isatty(STDERR_FILENO) == 0)
      throw io::InputError("stop: requires --yes without a terminal: vehicles in the air fall");
    std::fprintf(stderr, "The rotors turn off at once, also in the air: %s fall.\nType stop to do it: ",
                 fmt::format("{}", fmt::join(names, ",")).c_str());
    std::string typed;
    std::getline(std::cin, typed);
    if (typed != "stop") throw io::InputError("stop: not confirmed, nothing was sent");
  }
  return run_request(request_to(names, options),
                     {"stop", [&](Vehicle& vehicle) { return vehicle.stop(options.timeout()); },
                      OnInterrupt::kNothing, true});
}

// Adds the subcommand with the options that all three have.
runtime::CommandLine add_subcommand(runtime::CommandLine fleet, const std::string& name,
                                    const std::string& description, const std::string& example,
                                    const std::shared_ptr<FleetRequestOptions>& options) {
  const runtime::CommandLine app = add_request_subcommand(fleet, name, description, example, options);
  app.remove_option("--vehicle-name");
  app.add_option("--vehicle-name", options->names,
                 "only these, a list such as kl1,kl2; default: all that are seen")
      .check([](const std::string& names) { return messages::fault_of_vehicle_list(names); }, "NAMES");
  app.add_option("--time", options->look_s, "how long to look for vehicles, s")
      .range(0.2, 60.0)
      .show_default();
  return app;
}

void add_safety_options(runtime::CommandLine app, FleetRequestOptions& options) {
  runtime::Option fleet =
      app.add_option("--fleet", options.fleet,
                     "fleet file, or the name of one in config/fleets: its safety, and its vehicles unless "
                     "--vehicle-name names some")
          .type_name(io::kinds::kFleet.value);
  app.add_option("--radius-xy", options.safety.radius_xy_m, "half of the distance that two keep across, m")
      .range(0.01, 10.0)
      .show_default()
      .excludes(fleet);
  app.add_option("--radius-z", options.safety.radius_z_m, "half of the distance that two keep in height, m")
      .range(0.01, 10.0)
      .show_default()
      .excludes(fleet);
}

}  // namespace

io::Command add_fleet_goto_command(runtime::CommandLine fleet) {
  const auto options = std::make_shared<FleetGotoOptions>();
  const runtime::CommandLine app = add_subcommand(
      fleet, "goto",
      "Move the formation of the vehicles that hover: its centre to a position, all keep their offsets",
      "swiftlet fleet goto 1 0 -1.5\nRefused, before anything is sent, if two would come too near to each "
      "other, or to one that "
      "stays.",
      options);
  app.add_option("x", options->north_m, "north, m, of the mean of their positions").required().finite();
  app.add_option("y", options->east_m, "east, m").required().finite();
  runtime::Option z = app.add_option("z", options->z_ned_m, "down, m: negative is up").finite();
  app.add_option("--height", options->height_m, "height above the ground, m, instead of z")
      .positive()
      .excludes(z);
  app.add_option("--speed", options->speed, "peak speed, m/s").positive().show_default();
  app.add_option("--skew", options->skew_s,
                 "by which one may begin later than another, s; if the last one answers later, all hold; "
                 "default: as long as the ways stay apart, at least 0.5 and at most --timeout")
      .range(0.0, 60.0);
  app.add_option("--control", options->control,
                 "control settings of the vehicles, or the name of a file in config/control: its limits "
                 "say how long they take")
      .type_name(io::kinds::kControl.value)
      .show_default();
  add_safety_options(app, *options);
  return {app, [options] { return go_to(*options); }};
}

io::Command add_fleet_land_command(runtime::CommandLine fleet) {
  const auto options = std::make_shared<FleetLandOptions>();
  const runtime::CommandLine app =
      add_subcommand(fleet, "land", "Land all vehicles that fly where they are, but none on another one",
                     "swiftlet fleet land --speed 0.3", options);
  app.add_option("--speed", options->speed,
                 "peak speed, m/s; at most descent_speed_m_s of the control settings")
      .positive()
      .show_default();
  add_safety_options(app, *options);
  return {app, [options] { return land(*options); }};
}

io::Command add_fleet_stop_command(runtime::CommandLine fleet) {
  const auto options = std::make_shared<FleetStopOptions>();
  options->look_s = 1.0;
  const runtime::CommandLine app = add_subcommand(
      fleet, "stop", "Emergency stop: turn the rotors of all vehicles off at once, also in the air",
      "swiftlet fleet stop --yes", options);
  app.add_flag("--yes,-y", options->yes, "do not ask for confirmation");
  return {app, [options] { return stop(*options); }};
}

}  // namespace swiftlet::ground
