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

// x and y have the same length.
inline std::vector<Point> points(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<Point> out;
  for (std::size_t i = 0; i < x.size(); ++i) out.push_back({x[i], y[i]});
  return out;
}

// Interrupts a line, as does every point that is not finite.
constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
constexpr Point kGap = {kNowhere, kNowhere, kNowhere};

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

// Marked over the whole height of the axes, also if it is too short to be seen to scale.
struct Interval {
  double from = 0.0;  // x
  double to = 0.0;
  std::string text = {};  // empty: none
};

// Limits that are not given are those of the data, with a margin. Numbers that would be long are divided by a
// power of ten, which the label shows.
struct Axis {
  std::string label = {};  // with the unit: "thrust (N)"
  std::optional<double> from = {};
  std::optional<double> to = {};
  double least_span = 0.0;  // of limits that are not given
  bool logarithmic = false;
  bool reversed = false;
  bool numbered = true;
  std::vector<std::string> names = {};  // at 1, 2, ..., in place of numbers; at most 49 bytes each
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
  std::string title = {};
  std::optional<Box> box = {};  // missing: the panel fills the figure
  Axis x = {};
  Axis y = {};
  Axis z = {};
  bool in_space = false;   // seen obliquely, z up from the ground at 0
  bool equal = false;      // equal scales of all axes
  bool zero_line = false;  // at y = 0
  std::vector<Series> series = {};
  std::vector<Label> labels = {};
  std::vector<Interval> intervals = {};  // pictures only
};

struct Figure {
  std::string title;  // headline of a picture, caption in a page
  int width = 640;    // px
  int height = 400;   // px
  std::vector<Panel> panels;
};

inline Figure one_panel(const std::string& title, const std::string& x_label, const std::string& y_label,
                        int height = 400) {
  return {title, 640, height, {{"", {}, {x_label}, {y_label}}}};
}

}  // namespace swiftlet::plot
