// The part of a recorded flight that is evaluated.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// Interval from the mission's start to the start of its landing, or to its end if it has no landing; nullopt
// if the mission was not started.
std::optional<Window> mission_window(const FlightRecord& record, std::uint64_t mission_id,
                                     const control::Mission& mission);

// Duration from the mission's start to its end, s, or to the end of the record if the mission did not end.
// window: as mission_window() returns it.
double mission_duration_s(const FlightRecord& record, std::uint64_t mission_id, Window window);

}  // namespace swiftlet::ground
