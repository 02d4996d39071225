// Who has fallen silent: vehicle, motion capture, control service or battery.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

struct Silence {
  std::string who;              // "vehicle"
  std::optional<double> for_s;  // since its last sample; nullopt: none has come at all
  std::string missing{};        // "no IMU sample"
};

// The silent ones, the most severe first; empty if all send. Each is judged on its own. As long as
// control_status arrives, its ages decide: they are measured where the samples are used. Without a
// control_status, vehicle and battery are judged by their own topics, and motion capture is not judged.
std::vector<Silence> silences_of(const View& view, Clock::time_point now);

// Whether the control service is among them. Its mode and its requests are then the last known ones.
bool control_is_silent(const std::vector<Silence>& silences);

// Age of the newest pose that control used, s. Grows while control is silent too.
double pose_age_s(const View& view, Clock::time_point now);

// "VEHICLE SILENT for 3.2 s, since 14:03:07 (no IMU sample)". system_now: the same time as the silences were found at.
std::string to_string(const Silence& silence, std::chrono::system_clock::time_point system_now);

}  // namespace swiftlet::ground
