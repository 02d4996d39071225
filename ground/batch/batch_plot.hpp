// The plot of a batch.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/ground/batch/batch_report.hpp"

namespace swiftlet::ground {

// Writes folder/batch.gp, which draws folder/batch.png from folder/batch.csv, and runs gnuplot on it. Returns
// an empty string, or one sentence with the reason why there is no picture.
std::string draw_batch(const std::filesystem::path& folder, const BatchReport& report);

}  // namespace swiftlet::ground
