// The part of a recorded flight that is judged.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// From the mission's start to the start of its landing (or its end, without one); empty if it was not
// started.
std::optional<Window> mission_window(const FlightRecord& record, std::uint64_t mission_id,
                                     const control::Mission& mission);

// From the mission's start to its end, as far as it went; 0 if it was not started.
double mission_duration_s(const FlightRecord& record, std::uint64_t mission_id, Window window);

}  // namespace swiftlet::ground
