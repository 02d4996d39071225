// Checks of axes, signs, scale and delay of the sensors by guided motions of a hand. The motion that was asked for
// gives the true axis; motion capture gives its size.
#pragma once

#include <cstdint>
#include <vector>

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

enum class HandStep {
  kRollRight,  // the right side goes down
  kNoseUp,
  kTurnRight,  // clockwise, seen from above
  kForward,    // along its nose, level
  kUp,
  kWave,  // quick turns about all axes
  kBack,  // level again; not measured
};

// Each segment begins and ends with the vehicle at rest, for kRest_s at least. Level at the begin of all.
struct HandSegment {
  HandStep step = HandStep::kRollRight;
  std::int64_t begin_ns = 0;  // computer's clock
  std::int64_t end_ns = 0;
};
constexpr double kRest_s = 0.3;

// A segment for each step is needed; one that is missing fails. rest: recorded at rest before. Precondition: the
// stamps of rest and recording rise with the clock.
CheckResults check_hand_motion(const VehicleRecording& recording, const std::vector<HandSegment>& segments,
                               const VehicleRecording& rest);

}  // namespace swiftlet::ground
