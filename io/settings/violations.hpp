// From broken rules of a parameter struct to an error that points into its file.
#pragma once

#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::runtime {

// Throws ConfigError for the first violation, if there is one, with the line of its key (or of the nearest
// map around it).
void reject_violations(const ConfigNode& root, const std::vector<plant::Violation>& violations);

}  // namespace swiftlet::runtime
