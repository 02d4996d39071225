// What the commands that send a mission or a trajectory to a running vehicle have in common: its file, and the dry run before
// it is sent.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/mission/pace.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

struct SentFileOptions {
  std::string file;
  ReadingOptions reading;
  std::string control = "motor_lag";
  std::string vehicle;  // a vehicle file, or the name of one; empty: what the running vehicle reports
};

// Adds the file, the options of add_file_options(), --control and --vehicle. `options` must outlive the parsing.
void add_sent_file_options(runtime::CommandLine app, SentFileOptions& options,
                           const std::string& file_description);

// What is needed to read and check the file.
struct SentFile {
  explicit SentFile(const SentFileOptions& options);

  io::MissionFile mission() const;
  io::TrajectoryFile trajectory() const;
  // Throws InputError if the vehicle cannot fly it, by its own dry run, from where it stands. If neither
  // --vehicle nor the running vehicle says which model it is, it says so and checks all but the rotors.
  void require_flyable(const Vehicle& running, const io::MissionFile& file,
                       std::chrono::milliseconds timeout) const;
  // The same of a trajectory, which the vehicle joins from its motion.
  void require_flyable(const Vehicle& running, const io::TrajectoryFile& file,
                       std::chrono::milliseconds timeout) const;

  std::string path;
  control::ControlSettings settings;

 private:
  void require_flyable(const Vehicle& running, const io::MissionFile& file,
                       const CheckConditions& conditions) const;

  ReadingOptions reading_;
  std::optional<plant::Vehicle> vehicle_;  // of --vehicle
};

}  // namespace swiftlet::ground
