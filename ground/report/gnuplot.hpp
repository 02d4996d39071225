// Runs gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// Quotes a string for a gnuplot script.
std::string gnuplot_quoted(const std::string& text);

// Runs gnuplot on folder/NAME.gp, which draws folder/NAME.png from folder/NAME.csv. Returns an empty string,
// or one sentence with the reason why there is no picture.
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& name);

}  // namespace swiftlet::ground
