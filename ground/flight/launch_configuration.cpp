#include "swiftlet/ground/flight/launch_configuration.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/flight/flight_inputs.hpp"
#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/ground/mission/shifted_mission.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/command_line/installation.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/dispersion_file.hpp"
#include "swiftlet/simulation/mission_runner.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

// Sizes of a record, somewhat above those of real ones.
constexpr double kFigureRowBytes = 600.0;  // of flight.gp, for each reference
constexpr double kTraceRowBytes = 450.0;
constexpr double kMessagesBytes = 500.0;  // of all messages, compressed, for each sample of the IMU
constexpr double kOtherFilesBytes = 1e6;  // settings, logs, pictures
constexpr double kGroundTimeS = 10.0;     // recorded before take-off and after landing

std::string absolute_path(const fs::path& path) { return fs::absolute(path).string(); }

void require_takeoff_and_land(const io::MissionFile& mission, const fs::path& file) {
  if (!mission.takes_off())
    throw io::InputError(file.string() +
                         ": items: the first item is not a takeoff: a flight starts on the ground");
  if (!mission.lands())
    throw io::InputError(file.string() + ": items: the last item is not a land: a flight ends on the ground");
}

void require_valid(const FlightInputs& given) {
  const auto require = [](const char* what, const std::vector<plant::Violation>& violations) {
    for (const plant::Violation& violation : violations)
      throw io::InputError(fmt::format("{}: {}: {}", what, violation.key, violation.message));
  };
  if (given.vehicle) require("vehicle", plant::validate(*given.vehicle));
  if (given.control) require("control", control::validate(*given.control));
  if (given.simulation) require("simulation", plant::validate(*given.simulation));
}

CheckConditions conditions_of(const LaunchConfiguration& plan) {
  CheckConditions conditions;
  conditions.start_ned = plan.start_ned;
  const plant::SupplySettings& supply = plan.simulation.supply;
  conditions.state_of_charge = supply.ideal ? std::nullopt : std::optional(supply.initial_state_of_charge);
  return conditions;
}

// As require_flyable(), of a mission that is in no file.
double require_flyable_mission(const LaunchConfiguration& plan) {
  const CheckConditions conditions = conditions_of(plan);
  const MissionCheck check = check_mission(plan.mission, plan.vehicle, plan.control, conditions);
  if (!check.feasible()) throw io::InputError(plan.mission_file.string() + ": " + check.refusal());
  return check.duration_s;
}

// The vehicles of a fleet that are of one vehicle file: one plant and one control serve them.
struct Group {
  std::vector<std::size_t> members;
  std::string suffix;  // of the names of its processes
};

std::vector<Group> groups_of(const Fleet& fleet) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < fleet.plans.size(); ++i) {
    const auto is_same = [&](const Group& group) {
      return fleet.plans[group.members.front()].vehicle_file == fleet.plans[i].vehicle_file;
    };
    auto group = std::find_if(groups.begin(), groups.end(), is_same);
    if (group == groups.end()) group = groups.insert(group, Group{{}, ""});
    group->members.push_back(i);
  }
  if (groups.size() == 1) return groups;
  for (Group& group : groups) group.suffix = "-" + fleet.plans[group.members.front()].vehicle.name;
  return groups;
}

class ProcessBuilder {
 public:
  ProcessBuilder(const Fleet& fleet, const dds::NodeSettings& network)
      : fleet_(fleet), first_(fleet.plans.front()), common_(network_arguments(network)) {}

  io::ProcessSettings plant(const Group& group) const {
    if (first_.px4_instance) {
      return process("swiftlet-px4", first_.vehicle_program,
                     {"--vehicle", vehicle_of(group), "--levels", level(), "--instance",
                      std::to_string(*first_.px4_instance)},
                     group);
    }
    std::vector<std::string> arguments = {
        "--vehicle",    vehicle_of(group),
        "--simulation", absolute_path(first_.simulation_file),
        "--seed",       std::to_string(fleet_.plans[group.members.front()].seed),
        "--start"};
    for (const std::size_t i : group.members) {
      const Eigen::Vector2d& start_ned = fleet_.plans[i].start_ned;
      append(arguments, {io::exact(start_ned.x()), io::exact(start_ned.y())});
    }
    if (first_.imu_rate_option_hz > 0)
      append(arguments, {"--imu-rate", std::to_string(first_.imu_rate_option_hz)});
    append(arguments, {"--level", level(), "--clock", runtime::to_string(first_.clock)});
    if (first_.simulation.odometry.source != plant::OdometrySource::kNone) {
      const bool fuses_mocap = first_.simulation.odometry.source == plant::OdometrySource::kMocap;
      append(arguments, {"--odometry", fuses_mocap ? "mocap" : "own"});
    }
    const plant::RadioSettings& radio = first_.simulation.radio;
    if (radio.on()) {
      append(arguments, {"--radio-delay", io::exact(radio.delay_s), "--radio-jitter",
                         io::exact(radio.jitter_s), "--radio-loss", io::exact(radio.loss)});
    }
    if (first_.clock == runtime::Clock::kLockstep) {
      arguments.emplace_back("--paused");
      const bool several = fleet_.plans.size() > 1;
      const fs::path trace =
          several ? fleet_.folder / "{}" / first_.trace_file().filename() : first_.trace_file();
      if (first_.trace) append(arguments, {"--trace", absolute_path(trace)});
    }
    if (first_.speed) append(arguments, {"--speed", io::exact(*first_.speed)});
    return process("swiftlet-plant", first_.vehicle_program, std::move(arguments), group);
  }

  io::ProcessSettings mocap(const std::vector<Group>& groups) const {
    Group all;
    for (const Group& group : groups)
      all.members.insert(all.members.end(), group.members.begin(), group.members.end());
    return process("swiftlet-mocap", first_.mocap_program,
                   {"--simulation", absolute_path(first_.simulation_file), "--seed",
                    std::to_string(first_.seed), "--clock", runtime::to_string(first_.clock)},
                   all);
  }

  io::ProcessSettings control(const Group& group) const {
    return process("swiftlet-control", first_.control_program,
                   {"--vehicle", vehicle_of(group), "--control", absolute_path(first_.control_file),
                    "--level", level(), "--clock", runtime::to_string(first_.clock)},
                   group);
  }

 private:
  static void append(std::vector<std::string>& arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
  }
  std::string vehicle_of(const Group& group) const {
    return absolute_path(fleet_.plans[group.members.front()].vehicle_file);
  }
  std::string level() const { return plant::to_string(first_.simulation.control_levels.lowest()); }

  io::ProcessSettings process(const std::string& program_name, const fs::path& program,
                              std::vector<std::string> arguments, const Group& group) const {
    append(arguments, common_);
    std::vector<std::string> names;
    for (const std::size_t i : group.members) names.push_back(fleet_.vehicles[i]);
    append(arguments, {"--vehicle-name", fmt::format("{}", fmt::join(names, ","))});
    const std::string name = program_name + group.suffix;
    return {name, program, std::move(arguments), fleet_.folder / (name + ".log")};
  }

  const Fleet& fleet_;
  const LaunchConfiguration& first_;  // its settings are those of all
  const std::vector<std::string> common_;
};

}  // namespace

double require_flyable(const LaunchConfiguration& plan, const io::FileOptions& reading) {
  const CheckConditions conditions = conditions_of(plan);
  const MissionCheck check = check_mission(plan.mission, plan.vehicle, plan.control, conditions);
  const std::string refusal = refusal_with_advice(plan.mission, plan.mission_file.string(), reading,
                                                  plan.vehicle, plan.control, check, conditions);
  if (!refusal.empty()) throw io::InputError(plan.mission_file.string() + ": " + refusal);
  return check.duration_s;
}

fs::path default_record_folder(const std::string& name) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  return fs::path("flights") / (std::string(stamp) + "-" + name);
}

namespace {

// The options that change the settings of the simulation file.
void take_simulation_options(const FlyOptions& options, LaunchConfiguration& plan) {
  plan.imu_rate_option_hz = options.imu_rate_hz;
  if (options.imu_rate_hz > 0) plan.simulation.imu.rate_hz = options.imu_rate_hz;
  plan.simulation.control_levels = options.level;
  plan.simulation.odometry.source = options.odometry;
  if (options.odometry != plant::OdometrySource::kNone && options.level == plant::ControlLevel::kActuators)
    throw io::InputError(
        "--odometry: needs --level rates, attitude or trajectory: level actuators needs the IMU");
  plant::RadioSettings& radio = plan.simulation.radio;
  radio.delay_s = options.radio_delay_s.value_or(radio.delay_s);
  radio.jitter_s = options.radio_jitter_s.value_or(radio.jitter_s);
  radio.loss = options.radio_loss.value_or(radio.loss);
  for (const plant::Violation& violation : plant::validate(plan.simulation)) {
    throw io::InputError("--imu-rate: " + violation.key + " " + violation.message);
  }
  for (const plant::Violation& violation : plant::validate_faults(plan.simulation.faults, plan.vehicle)) {
    throw io::InputError(plan.simulation_file.string() + ": " + violation.key + ": " + violation.message);
  }
}

void take_dispersion(const FlyOptions& options, LaunchConfiguration& plan) {
  if (options.dispersion == simulation::kUncertainty) {
    const std::string file = plan.vehicle_file.string();
    plan.dispersion = simulation::dispersion_of(io::load_vehicle_uncertainty(file), plan.vehicle, file);
  } else if (!options.dispersion.empty()) {
    plan.dispersion_file = io::configuration_file(io::kinds::kDispersion, options.dispersion);
    plan.dispersion = simulation::load_dispersion_file(plan.dispersion_file, {plan.vehicle, plan.simulation});
  }
}

// Throws unless the mission can be flown from its start.
void take_mission(const FlyOptions& options, const FlightInputs& given, LaunchConfiguration& plan) {
  if (given.mission) {
    plan.mission_file = given.mission->name;
    plan.mission = *given.mission;
  } else {
    plan.mission_file = io::configuration_file(io::kinds::kMission, options.mission);
    plan.mission = load_mission(plan.mission_file, options.reading, plan.vehicle, plan.control);
  }
  plan.start_ned = options.start_ned;
  if (options.mission_at_start)
    plan.mission.mission = shifted(std::move(plan.mission.mission), options.start_ned, plan.control.limits);
  if (const control::Outcome outcome = control::check(plan.mission.mission, plan.control.limits);
      !outcome.accepted)
    throw io::InputError(fmt::format("{}: started at {:g} m north and {:g} m east of the origin: {}",
                                     plan.mission_file.c_str(), plan.start_ned.x(), plan.start_ned.y(),
                                     outcome.reason));
  require_takeoff_and_land(plan.mission, plan.mission_file);
  if (plan.launch_mode != LaunchMode::kAttached) {
    plan.planned_duration_s =
        given.mission ? require_flyable_mission(plan) : require_flyable(plan, options.reading);
  }
}

}  // namespace

LaunchConfiguration plan_flight(const FlyOptions& options) { return plan_flight(options, {}); }

LaunchConfiguration plan_flight(const FlyOptions& options, const FlightInputs& given) {
  LaunchConfiguration plan;
  plan.launch_mode = options.launch_mode;
  plan.clock = options.clock;
  plan.speed = options.speed;
  plan.vehicle_file = io::configuration_file(io::kinds::kVehicle, options.vehicle);
  plan.control_file = io::configuration_file(io::kinds::kControl, options.control);
  plan.simulation_file = io::configuration_file(io::kinds::kSimulation, options.simulation);
  plan.vehicle = given.vehicle ? *given.vehicle : io::load_vehicle(plan.vehicle_file);
  plan.control = given.control ? *given.control : io::load_control_settings(plan.control_file);
  plan.simulation = given.simulation ? *given.simulation : io::load_simulation_settings(plan.simulation_file);
  require_valid(given);
  take_simulation_options(options, plan);
  take_dispersion(options, plan);
  plan.seed = options.seed;
  take_mission(options, given, plan);
  if (plan.launch_mode == LaunchMode::kStarted) {
    plan.vehicle_program = io::program_beside(options.px4_instance ? "swiftlet-px4" : "swiftlet-plant");
    plan.mocap_program = io::program_beside("swiftlet-mocap");
    plan.control_program = io::program_beside("swiftlet-control");
  }
  plan.folder = options.record.empty() ? default_record_folder(plan.mission.name) : fs::path(options.record);
  plan.trace = options.trace;
  plan.px4_instance = options.px4_instance;
  return plan;
}

simulation::DispersionSample draw(const LaunchConfiguration& plan, std::uint64_t seed) {
  return draw(plan.dispersion, {plan.vehicle, plan.simulation}, seed);
}

std::uintmax_t LaunchConfiguration::record_bytes() const {
  const double imu_row_bytes = kMessagesBytes + (trace ? kTraceRowBytes : 0.0);
  const double bytes_per_s =
      record::kTelemetryRateHz * kFigureRowBytes + simulation.imu.rate_hz * imu_row_bytes;
  return static_cast<std::uintmax_t>((planned_duration_s + kGroundTimeS) * bytes_per_s + kOtherFilesBytes);
}

std::vector<fs::path> LaunchConfiguration::input_files() const {
  std::vector<fs::path> files = {mission_file, vehicle_file, control_file, simulation_file};
  if (!dispersion_file.empty()) files.push_back(dispersion_file);
  return files;
}

ExistingRecord existing_record(const FlyOptions& options) {
  if (options.record.empty()) return ExistingRecord::kNumbered;
  return options.replace ? ExistingRecord::kReplaced : ExistingRecord::kRefused;
}

analysis::FlightReport report_of(const LaunchConfiguration& plan) {
  analysis::FlightReport report;
  report.clock = plan.launch_mode == LaunchMode::kInProcess ? "in process" : runtime::to_string(plan.clock);
  report.mission = plan.mission.name;
  report.vehicle = plan.vehicle.name;
  report.start_ned = plan.start_ned;
  report.control = plan.control.name;
  report.dispersion = plan.dispersion.name;
  report.seed = plan.seed;
  report.imu_rate_hz = plan.simulation.imu.rate_hz;
  report.record_dir = plan.folder.string();
  report.tolerance_m = plan.mission.tolerance_m;
  return report;
}

Eigen::Vector2d start_of(std::size_t i, std::size_t vehicles, double spacing_m, int per_row) {
  const std::size_t columns =
      per_row == 0 ? vehicles : std::min<std::size_t>(vehicles, static_cast<std::size_t>(per_row));
  const std::size_t rows = (vehicles + columns - 1) / columns;
  const auto offset = [spacing_m](std::size_t place, std::size_t places) {
    return spacing_m * (static_cast<double>(place) - 0.5 * static_cast<double>(places - 1));
  };
  return {offset(i / columns, rows), offset(i % columns, columns)};
}

std::vector<io::ProcessSettings> processes(const Fleet& fleet, const dds::NodeSettings& network) {
  const LaunchConfiguration& first = fleet.plans.front();
  if (first.launch_mode != LaunchMode::kStarted) return {};
  const ProcessBuilder builder(fleet, network);
  const std::vector<Group> groups = groups_of(fleet);
  std::vector<io::ProcessSettings> processes;
  for (const Group& group : groups) processes.push_back(builder.plant(group));
  processes.push_back(builder.mocap(groups));
  for (const Group& group : groups) processes.push_back(builder.control(group));
  return processes;
}

}  // namespace swiftlet::ground
