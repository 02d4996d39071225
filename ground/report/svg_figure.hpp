// A figure of points and curves as SVG, to stand in a page: no script, no font file, no network.
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
  std::string label;  // in the legend, if not empty
  Mark mark = Mark::kDots;
  std::string colour;
  std::vector<FigurePoint> points;
};

// Between two curves over the same x.
struct FigureBand {
  std::string label;
  std::string colour;
  std::vector<FigurePoint> low;
  std::vector<FigurePoint> high;
};

struct Figure {
  std::string title;  // for those who cannot see it
  std::string x_label;
  std::string y_label;
  bool zero_line = false;
  int height = 400;  // px of a width of 640
  std::vector<FigureBand> bands;
  std::vector<FigureSeries> series;
};

// A whole <svg> element. Axes span what is drawn, crosses (outliers) included; ticks are round numbers,
// scaled by a power of ten where they would be long, which the label then names. The legend stands in the
// corner where it hides least.
std::string svg(const Figure& figure);

// For text between tags and in attributes.
std::string html_escaped(const std::string& text);

}  // namespace swiftlet::ground
