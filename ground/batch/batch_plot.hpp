// The plot of a batch.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/ground/batch/batch_report.hpp"

namespace swiftlet::ground {

// Draws folder/batch.png, and writes the gnuplot script folder/batch.gp to draw it again. Returns an empty
// string, or one sentence with the reason why there is no picture.
std::string draw_batch(const std::filesystem::path& folder, const BatchReport& report);

}  // namespace swiftlet::ground
