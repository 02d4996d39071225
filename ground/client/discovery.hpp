// Finds vehicles by the topics that are published in a domain.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::ground {

// The names of the vehicles among DDS topic names "rt/<vehicle>/<name>". Ignores topics that ground tools
// publish. Sorted, without duplicates.
std::vector<std::string> vehicles_of(const std::vector<std::string>& wire_names);

// The topic names of one vehicle, of any publisher. Sorted, without duplicates.
std::vector<std::string> topics_of(const std::string& vehicle, const std::vector<std::string>& wire_names);

std::string listed(const std::vector<std::string>& words);  // "a, b, c"

}  // namespace swiftlet::ground
