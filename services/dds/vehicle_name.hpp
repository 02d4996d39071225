// The names of vehicles, which are namespaces of ROS 2 topics.
#pragma once

#include <string>

namespace swiftlet::comms {

// What is wrong with the name of a vehicle: "must be ..."; "" for a valid one. ROS 2 refuses names that begin
// with a digit, reserves __, and hides what begins with _.
std::string fault_of_vehicle_name(const std::string& name);

}  // namespace swiftlet::comms
