// Prints the results of the checks of a vehicle.
#pragma once

#include <cstdio>
#include <string>

#include "swiftlet/ground/vehicle_check/check_result.hpp"

namespace swiftlet::ground {

// A line for each check, with the finding below it where it fails or is skipped, and a line with the numbers.
void print_table(std::FILE* stream, const std::string& vehicle, const CheckResults& results);
void print_json(const std::string& vehicle, int domain, const CheckResults& results);

}  // namespace swiftlet::ground
