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
};

// The silent ones, the most severe first; empty if all send. As long as control_status arrives, its ages
// decide: they are measured where the samples are used. Without a control_status the vehicle is judged by its
// own topics, and motion capture is not judged.
std::vector<Silence> silences_of(const View& view, Clock::time_point now);

// Age of the newest pose that control used, s. Grows while control is silent too.
double pose_age_s(const View& view, Clock::time_point now);

// "VEHICLE SILENT for 3.2 s, since 14:03:07". system_now: the same time as the silences were found at.
std::string to_string(const Silence& silence, std::chrono::system_clock::time_point system_now);

}  // namespace swiftlet::ground
