// Figures of points and curves as SVG to embed in a page, without script, font file and network access.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::ground {

struct FigurePoint {
  double x = 0.0;
  double y = 0.0;
};

enum class Mark { kDots, kCrosses, kLine, kDashes };

struct FigureSeries {
  std::string label;  // legend text; empty: not in the legend
  Mark mark = Mark::kDots;
  std::string colour;
  std::vector<FigurePoint> points;
};

// The area between two curves over the same x.
struct FigureBand {
  std::string label;
  std::string colour;
  std::vector<FigurePoint> low;
  std::vector<FigurePoint> high;
};

struct Figure {
  std::string title;  // accessible name for screen readers
  std::string x_label;
  std::string y_label;
  bool zero_line = false;
  int height = 400;  // px; the width is 640 px
  std::vector<FigureBand> bands;
  std::vector<FigureSeries> series;
};

// Returns an <svg> element. The axes span all data, crosses (outliers) included. Ticks are round numbers;
// long ones are scaled by a power of ten, which the axis label shows. The legend is in the corner where it
// hides the fewest points.
std::string svg(const Figure& figure);

// Escapes text for element content and attributes.
std::string html_escaped(const std::string& text);

}  // namespace swiftlet::ground
