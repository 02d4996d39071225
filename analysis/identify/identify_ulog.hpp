// `swiftlet identify flight` with a log of PX4: the thrust scale.
#pragma once

#include <string>

#include "swiftlet/analysis/identify/identify_options.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::analysis {

// True for the name of a ULog file.
bool is_ulog(const std::string& file);

// Prints the thrust scale, and what a log of PX4 does not determine. Throws InputError for options that need more than that.
int identify_ulog(const IdentifyFlightOptions& options, const plant::Vehicle& base,
                  const std::string& base_name);

}  // namespace swiftlet::analysis
