// vehicle_info as what a vehicle is: stated from its vehicle file, and compared with that of control before it may be armed.
#pragma once

#include <string>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::messages {

// wire_version, name, rotor count, mass and battery; the rest is left as it is.
void describe(const plant::Vehicle& vehicle, msg::VehicleInfo& info);

// How the vehicle that reports this differs from `expected`, with both figures, in at most 127 characters: "the vehicle is not
// control's: lab25, not kaylion; mass 0.250 kg, not 0.040 kg"; empty: it does not. What it does not report is not compared.
// Masses and voltages of the full and empty battery may differ by `tolerance` of the expected ones.
std::string difference(const msg::VehicleInfo& info, const plant::Vehicle& expected, double tolerance);

}  // namespace swiftlet::messages
