// Figures as data: panels with axes and series. gnuplot.hpp draws them, page.hpp puts them in a page.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace swiftlet::plot {

// The palette of all figures. Red is for limits, outliers and failures, ink for references and fits. The other
// colours tell series apart.
enum class Colour { kBlue, kOrange, kGreen, kPurple, kOchre, kTeal, kBrown, kRed, kInk, kGrey };

enum class Style {
  kLine,
  kDashes,
  kSteps,  // a value holds until the next point
  kDots,
  kCrosses,
  kBand,  // the area inside the points, which go around it
  kBoxes  // box of the quartiles, whiskers to 90 % of the values y, outliers; all points have the same x
};

struct Point {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;  // only in space
};

// Interrupts a line, as does every point that is not finite.
constexpr Point kGap = {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};

struct Series {
  Style style = Style::kLine;
  Colour colour = Colour::kBlue;
  std::string label = {};  // in the legend; empty: not in the legend
  std::vector<Point> points = {};
  double weight = 1.0;  // factor on the usual width of a line, or size of a point
};

struct Label {
  Point at;
  std::string text;
  Colour colour = Colour::kInk;
  bool ends_here = false;  // ends below the point, else begins above it
};

// Limits that are not given are those of the data, with a margin. Numbers that would be long are divided by a
// power of ten, which the label shows.
struct Axis {
  std::string label;  // with the unit: "thrust (N)"
  std::optional<double> from;
  std::optional<double> to;
  double least_span = 0.0;  // of limits that are not given
  bool logarithmic = false;
  bool reversed = false;
  bool numbered = true;
  std::vector<std::string> names;  // at 1, 2, ..., in place of numbers
};

// Where the axes are, as fractions of the figure from its lower left corner.
struct Box {
  double left = 0.0;
  double right = 1.0;
  double bottom = 0.0;
  double top = 1.0;
};

// The series are drawn in their order. The legend is above the axes.
struct Panel {
  std::string title;
  Axis x, y, z;
  bool in_space = false;   // seen obliquely, z up from the ground at 0
  bool equal = false;      // equal scales of all axes
  bool zero_line = false;  // at y = 0
  std::vector<Series> series;
  std::vector<Label> labels;
  std::optional<Box> box;  // missing: the panel fills the figure
};

struct Figure {
  std::string title;    // headline of a picture; name of a figure in a page, for screen readers
  std::string caption;  // in a page, below the figure
  int width = 640;      // px
  int height = 400;     // px
  std::vector<Panel> panels;
};

// A figure of one panel for a page.
inline Figure captioned(const std::string& caption, const std::string& x_label, const std::string& y_label) {
  Figure figure{caption, caption, 640, 400, std::vector<Panel>(1)};
  figure.panels[0].x.label = x_label;
  figure.panels[0].y.label = y_label;
  return figure;
}

}  // namespace swiftlet::plot
