// Draws figures with gnuplot.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "swiftlet/analysis/plot/figure.hpp"

namespace swiftlet::plot {

// A gnuplot script with the data of the figure, which draws it to the PNG file `output`. Texts of the figure are
// drawn as they are: gnuplot interprets nothing in them.
std::string gnuplot_script(const Figure& figure, const std::string& output);

// Draws the figure to a PNG file. Returns an empty string, or one sentence with the reason why there is no
// picture; the file is then as before.
std::string draw_png(const Figure& figure, const std::filesystem::path& png);

constexpr std::chrono::seconds kLongestDrawing{30};

// Also writes NAME.gp beside NAME.png, to draw it again. Returns a sentence if gnuplot is not installed, or takes longer. Throws
// std::runtime_error if there is no whole picture for another reason.
std::string draw_png_if_installed(const Figure& figure, const std::filesystem::path& png,
                                  std::chrono::seconds longest = kLongestDrawing);

}  // namespace swiftlet::plot
