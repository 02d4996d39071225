// The names of vehicles, which are namespaces of ROS 2 topics, and lists of them as on the command line: "kl1,kl2,kl5..kl7".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace swiftlet::messages {

// What is wrong with the name of a vehicle: "must be ..."; "" for a valid one. ROS 2 refuses names that begin with a digit,
// reserves __, and hides what begins with _.
std::string fault_of_vehicle_name(const std::string& name);

// Longer lists are refused.
constexpr std::size_t kMostListedVehicles = 200;

// What is wrong with a list: a clause that follows its name; "" for a valid one. In a range, "kl5..kl7" or "kl08..kl12",
// both names have the same letters before their numbers, and the second number is not the lower one.
std::string fault_of_vehicle_list(const std::string& list);

// The names of a list, in its order. Leading zeros of a range are kept. Throws std::invalid_argument with the fault.
std::vector<std::string> vehicles_of_list(const std::string& list);

}  // namespace swiftlet::messages
