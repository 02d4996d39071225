// Draws a tuning study: for each loop the step response, and the Bode diagram with the margins.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/analysis/plot/figure.hpp"
#include "swiftlet/analysis/tuning/tuning_study.hpp"

namespace swiftlet::analysis {

// The settings are drawn over each other. Three panels a loop: step response, magnitude, phase.
plot::Figure tuning_figure(const TuningStudy& study);

// Draws the figure to a PNG file. Returns an empty string, or one sentence with the reason why there is none.
std::string draw_tuning(const std::filesystem::path& png, const TuningStudy& study);

}  // namespace swiftlet::analysis
