// Draws figures with gnuplot.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/analysis/plot/figure.hpp"

namespace swiftlet::plot {

// A gnuplot script with the data of the figure, which draws it to the PNG file `output`. Texts of the figure are
// drawn as they are: gnuplot interprets nothing in them.
std::string gnuplot_script(const Figure& figure, const std::string& output);

// Draws the figure to a PNG file. Returns an empty string, or one sentence with the reason why there is no
// picture; the file is then as before. with_script: also writes NAME.gp beside NAME.png, to draw it again.
std::string draw_png(const Figure& figure, const std::filesystem::path& png, bool with_script = false);

// As draw_png() with the script. Returns a sentence if gnuplot is not installed. Throws std::runtime_error if
// it is, and there is no whole picture.
std::string draw_png_if_installed(const Figure& figure, const std::filesystem::path& png);

}  // namespace swiftlet::plot
