// Gains for a loop with a delay, such as a controller at the far end of a slow network.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/control/design/level_loops.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::analysis {

struct DelayDesign {
  double factor = 1.0;  // on the bandwidth of every loop
  control::ControlSettings settings;
  std::array<double, 6>
      margins_s{};  // delay that each loop tolerates, in the order of control::kFlownLoopNames
};

// Each loop tolerates at least this many times the delay: the delay then takes half of its phase margin.
constexpr double kDelayReserve = 2.0;
// A slower vehicle hardly holds its place.
constexpr double kLeastBandwidthFactor = 0.05;

// All closed-loop poles of the design times the factor, but for the rotors' lag.
control::ControlSettings slowed(const control::ControlSettings& settings, double factor);

// How a vehicle is commanded. vehicle: the loops that it closes itself, above level actuators.
struct CommandLevel {
  plant::ControlLevel level = plant::ControlLevel::kActuators;
  control::VehicleLoops vehicle;
};

// Slows all loops down, as little as possible, until they tolerate the delay with the reserve. delay_s: from a sample
// to the vehicle that obeys the command, s. commanded: not at level trajectory, at which control closes no loop. Throws
// std::invalid_argument with a sentence if a factor of kLeastBandwidthFactor does not suffice, and as control::design() does.
DelayDesign design_for_delay(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                             double delay_s, const CommandLevel& commanded = {});

// The values that slowed() changes, and the name, with their keys in the control settings file.
std::vector<std::pair<std::string, std::string>> slowed_values(const control::ControlSettings& to);

}  // namespace swiftlet::analysis
