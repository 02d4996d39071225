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
  std::string control,
      vehicle;  // files, or names of such; empty: those that the running controller flies with
};

// Adds the file, the options of add_file_options(), --control and --vehicle. `options` must outlive the parsing.
void add_sent_file_options(runtime::CommandLine app, SentFileOptions& options,
                           const std::string& file_description);

// What is needed to read and check the file.
struct SentFile {
  // Throws std::runtime_error if the controller does not tell within the timeout what the options do not say.
  SentFile(const SentFileOptions& options, const dds::NodeSettings& network,
           std::chrono::milliseconds timeout);

  io::MissionFile mission() const;
  io::TrajectoryFile trajectory() const;
  // Throws InputError if the vehicle cannot fly it, by its own dry run, from where it stands.
  void require_flyable(const Vehicle& running, const io::MissionFile& file,
                       std::chrono::milliseconds timeout) const;
  // The same of a trajectory, which the vehicle joins from its motion.
  void require_flyable(const Vehicle& running, const io::TrajectoryFile& file,
                       std::chrono::milliseconds timeout) const;

  std::string path;
  control::ControlSettings settings;

 private:
  void require_flyable(const io::MissionFile& file, const CheckConditions& conditions) const;

  ReadingOptions reading_;
  plant::Vehicle vehicle_;
};

}  // namespace swiftlet::ground
