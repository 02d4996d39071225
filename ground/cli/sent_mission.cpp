#include "swiftlet/ground/cli/sent_mission.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/core.h>

#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/flight/attached_vehicle.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kModelTimeout{2000};  // vehicle_info comes once a second

// Waits until the vehicle has reported its model and its position.
VehicleState state_of(const Vehicle& running, std::chrono::milliseconds timeout) {
  running.wait_until(
      [](const VehicleState& state) { return state.model && state.position_ned_m.allFinite(); },
      std::min(timeout, kModelTimeout));
  return running.state();
}

// 0 .. 1; none if the vehicle has not reported it.
std::optional<double> charge_of(const VehicleState& state) {
  if (!std::isfinite(state.battery_charge)) return std::nullopt;
  return std::clamp(state.battery_charge, 0.0, 1.0);
}

}  // namespace

void add_sent_file_options(runtime::CommandLine app, SentFileOptions& options,
                           const std::string& file_description) {
  app.add_option("file", options.file, file_description).type_name(io::kinds::kMission.value).required();
  add_file_options(app, options.reading);
  app.add_option("--control", options.control,
                 "control settings with the limits and the fence for the check of the file")
      .type_name(io::kinds::kControl.value)
      .show_default();
  const runtime::Option vehicle =
      app.add_option("--vehicle", options.vehicle,
                     "vehicle file, or the name of one in config/vehicles, for the check of what it can fly; "
                     "default: the one with the name that the vehicle reports")
          .type_name(io::kinds::kVehicle.value);
  app.option("--as-fast-as-possible").needs(vehicle);
}

SentFile::SentFile(const SentFileOptions& options)
    : path(io::configuration_file(io::kinds::kMission, options.file)),
      settings(io::load_control_settings(io::configuration_file(io::kinds::kControl, options.control))),
      reading_(options.reading) {
  if (!options.vehicle.empty())
    vehicle_ = io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
}

io::MissionFile SentFile::mission() const {
  io::MissionFile file = vehicle_ ? load_mission(path, reading_, *vehicle_, settings)
                                  : io::load_mission_file(path, settings.limits, reading_);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", file.name.c_str(), assumption.c_str());
  return file;
}

io::TrajectoryFile SentFile::trajectory() const {
  io::TrajectoryFile file = vehicle_ ? load_trajectory(path, reading_, *vehicle_, settings)
                                     : io::load_trajectory_file(path, settings.limits, reading_);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", std::filesystem::path(path).stem().c_str(), assumption.c_str());
  return file;
}

void SentFile::require_flyable(const Vehicle& running, const io::MissionFile& file,
                               std::chrono::milliseconds timeout) const {
  CheckConditions conditions;
  const VehicleState state = state_of(running, timeout);
  if (state.position_ned_m.allFinite()) conditions.start_ned = state.position_ned_m.head<2>();
  conditions.state_of_charge = charge_of(state);
  require_flyable(running, file, conditions);
}

void SentFile::require_flyable(const Vehicle& running, const io::TrajectoryFile& file,
                               std::chrono::milliseconds timeout) const {
  CheckConditions conditions = at_start_of(file);
  const VehicleState state = state_of(running, timeout);
  conditions.state_of_charge = charge_of(state);
  require_flyable(running, mission_of(std::filesystem::path(path).stem(), file, settings), conditions);
}

void SentFile::require_flyable(const Vehicle& running, const io::MissionFile& file,
                               const CheckConditions& conditions) const {
  const KnownVehicle known = vehicle_ ? KnownVehicle{vehicle_, ""} : known_vehicle(running.state().model);
  std::string refusal;
  if (known.model) {
    const MissionCheck check = check_mission(file, *known.model, settings, conditions);
    refusal = refusal_with_advice(file, path, reading_, *known.model, settings, check, conditions);
  } else {
    std::fprintf(stderr, "%s: its rotors are not checked: %s\n", running.name().c_str(),
                 known.unknown.c_str());
    const MissionDryRun flown = dry_run(file.mission, settings, conditions.start_ned);
    if (!flown.completed) refusal = "the control service would not complete it: " + flown.reason;
  }
  if (!refusal.empty()) throw io::InputError(path + ": " + refusal);
}

}  // namespace swiftlet::ground
