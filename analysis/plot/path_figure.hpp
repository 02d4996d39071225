// The layout of a figure of a path: four quantities over time, one above another; the path from above and in
// space.
#pragma once

#include <array>
#include <string>

#include "swiftlet/analysis/plot/figure.hpp"

namespace swiftlet::plot {

constexpr std::size_t kFromAbove = 4;  // panels: 0 to 3 are over time
constexpr std::size_t kInSpace = 5;

// labels: of the quantities, from the top.
Figure path_figure(const std::string& title, const std::array<std::string, 4>& labels, double duration_s);

// Adds a series to the views from above and in space. Points: east, north, height, m.
void add_to_views(Figure& figure, const Series& series);

}  // namespace swiftlet::plot
