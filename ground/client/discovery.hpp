// Which vehicles there are, told from the topics that are published in a domain.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::ground {

// Names of the wire, "rt/<vehicle>/<name>", that a vehicle, its motion capture or its controller publish;
// what ground tools publish shows no vehicle. Sorted, each once.
std::vector<std::string> vehicles_of(const std::vector<std::string>& wire_names);

// The names of one vehicle's topics among them, whoever publishes them.
std::vector<std::string> topics_of(const std::string& vehicle, const std::vector<std::string>& wire_names);

std::string listed(const std::vector<std::string>& words);  // "a, b, c"

}  // namespace swiftlet::ground
