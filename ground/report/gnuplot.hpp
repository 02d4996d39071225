// Pictures of the figures that are kept.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// A string of a gnuplot script.
std::string gnuplot_quoted(const std::string& text);

// Runs gnuplot on folder/NAME.gp, which draws folder/NAME.png from folder/NAME.csv. Returns an empty text, or
// one sentence that says why there is no picture.
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& name);

}  // namespace swiftlet::ground
