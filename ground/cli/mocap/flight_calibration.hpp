// `swiftlet mocap calibrate` from a flight: what the flight told, added to what the room file has.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "swiftlet/ground/cli/mocap/calibration.hpp"
#include "swiftlet/identification/mocap/body_alignment.hpp"
#include "swiftlet/io/mocap/room.hpp"

namespace swiftlet::ground {

// Largest standard deviation of a component that is written; of the lever arm kLargestDeviationM.
constexpr double kLargestDeviationRad = 15e-3;

struct FlightCalibration {
  Misalignment misalignment;  // as in the room file; components that were not told are those of before
  LeverArm lever_arm;         // likewise; without residual_m
  std::array<bool, 3> misalignment_told{};
  std::array<bool, 3> lever_arm_told{};
  std::vector<std::string> advice;  // sentences: what was not told, and what to fly
};

// before: the room file's, with which the poses of the flight were made. Throws std::runtime_error with a sentence if the
// flight tells nothing, or a lever arm is too long.
FlightCalibration calibrated(const mocap::VehicleBody& before, const identification::BodyAlignment& found);

}  // namespace swiftlet::ground
