// Reports violated rules of a parameter struct as an error with the line of its file.
#pragma once

#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::io {

// Throws ConfigError for the first violation, with the line of its key or, if the key is missing, of the
// nearest enclosing map. Does nothing without a violation.
void reject_violations(const ConfigNode& root, const std::vector<plant::Violation>& violations);

}  // namespace swiftlet::io
