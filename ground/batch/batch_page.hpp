// The page of a batch.
#pragma once

#include <string>

#include "swiftlet/ground/batch/batch_report.hpp"

namespace swiftlet::ground {

// HTML: the distributions of errors and margins, the error over the parameters of the strongest effects, failed runs.
std::string batch_page(const BatchReport& report);

}  // namespace swiftlet::ground
