// The figures of a batch.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "swiftlet/analysis/plot/figure.hpp"
#include "swiftlet/ground/batch/batch_report.hpp"

namespace swiftlet::ground {

// Distribution of the errors, phase margins, and the RMS error over up to `scatters` parameters, strongest effect first.
// The report must have a tracking error.
plot::Figure batch_figure(const BatchReport& report, std::size_t scatters);

// Draws folder/batch.png, and writes the gnuplot script folder/batch.gp to draw it again. Returns an empty
// string, or a sentence if gnuplot is not installed or no run has a tracking error. Throws std::runtime_error
// if the picture could not be drawn or written whole; there is none then.
std::string draw_batch(const std::filesystem::path& folder, const BatchReport& report);

}  // namespace swiftlet::ground
