// Flies the recorded sensors of a flight again, into a control process alone, and compares its commands with the
// recorded ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "swiftlet/analysis/logs/log_diff.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::ground {

struct ControlReplaySettings {
  std::string vehicle;                 // of those in the file
  std::filesystem::path vehicle_file;  // empty: that of the recording, else kaylion
  std::filesystem::path control_file;  // empty: that of the recording, else motor_lag
};

struct ControlReplay {
  std::string vehicle_file;  // what the controller was started with; "recorded" for an attachment of the file
  std::string control_file;
  std::uint64_t imu_samples = 0;
  std::uint64_t requests = 0;          // commands, missions, trajectories and settings
  std::uint64_t other_answers = 0;     // requests that are now accepted and were refused, or the reverse
  analysis::TopicDifference commands;  // A: recorded, B: replayed
};

// Why the replayed controller did not do the same as the recorded one, one sentence; empty if it did. tolerance: the largest
// difference of a command that counts as the same.
std::string difference_of(const ControlReplay& replay, double tolerance);

// Lockstep: each IMU sample waits for the poses, battery and rotor speed samples that the recorded controller had, and the
// next one for its command. Requests and setpoints come between the IMU samples between which they were recorded. The
// recording must begin before the vehicle was armed. proceed: called for each IMU sample with the share that is done;
// false ends the replay with std::runtime_error. Throws ConfigError if the file lacks a topic that it needs,
// std::runtime_error if the process ends or does not answer.
ControlReplay replay_into_control(const mcap::Reader& file, const ControlReplaySettings& settings,
                                  const std::function<bool(double)>& proceed);

}  // namespace swiftlet::ground
