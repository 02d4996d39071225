#include "swiftlet/ground/cli/sent_mission.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/core.h>

#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/flight/running_files.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kStateTimeout{2000};

// Waits until control has reported a position.
VehicleState state_of(const Vehicle& running, std::chrono::milliseconds timeout) {
  running.wait_until([](const VehicleState& state) { return state.position_ned_m.allFinite(); },
                     std::min(timeout, kStateTimeout));
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
  app.add_option(
         "--control", options.control,
         "control settings with the limits and the fence for the check of the file; default: those that "
         "control flies with")
      .type_name(io::kinds::kControl.value);
  app.add_option("--vehicle", options.vehicle,
                 "vehicle file for the check of what it can fly; default: the one that control flies with")
      .type_name(io::kinds::kVehicle.value);
}

SentFile::SentFile(const SentFileOptions& options, const dds::NodeSettings& network,
                   std::chrono::milliseconds timeout)
    : path(io::configuration_file(io::kinds::kMission, options.file)), reading_(options.reading) {
  const auto read = [&](const std::string& vehicle, const std::string& control) {
    vehicle_ = io::load_vehicle(vehicle);
    settings = io::load_control_settings(control);
  };
  const auto given = [](const io::ConfigurationKind& kind, const std::string& name) {
    return name.empty() ? "" : io::configuration_file(kind, name);
  };
  const std::string vehicle = given(io::kinds::kVehicle, options.vehicle);
  const std::string control = given(io::kinds::kControl, options.control);
  if (!vehicle.empty() && !control.empty()) {
    read(vehicle, control);
    return;
  }
  Client client(network);
  const RunningFiles running(client, timeout);
  read(vehicle.empty() ? running.vehicle() : vehicle, control.empty() ? running.control() : control);
}

io::MissionFile SentFile::mission() const {
  io::MissionFile file = load_mission(path, reading_, vehicle_, settings);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", file.name.c_str(), assumption.c_str());
  return file;
}

io::TrajectoryFile SentFile::trajectory() const {
  io::TrajectoryFile file = load_trajectory(path, reading_, vehicle_, settings);
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
  require_flyable(file, conditions);
}

void SentFile::require_flyable(const Vehicle& running, const io::TrajectoryFile& file,
                               std::chrono::milliseconds timeout) const {
  CheckConditions conditions = at_start_of(file);
  const VehicleState state = state_of(running, timeout);
  conditions.state_of_charge = charge_of(state);
  require_flyable(mission_of(std::filesystem::path(path).stem(), file, settings), conditions);
}

void SentFile::require_flyable(const io::MissionFile& file, const CheckConditions& conditions) const {
  const MissionCheck check = check_mission(file, vehicle_, settings, conditions);
  const std::string refusal =
      refusal_with_advice(file, path, reading_, vehicle_, settings, check, conditions);
  if (!refusal.empty()) throw io::InputError(path + ": " + refusal);
}

}  // namespace swiftlet::ground
