#include "swiftlet/analysis/plot/gnuplot.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <string_view>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/child_process.hpp"
#include "swiftlet/io/temporary_folder.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::plot {
namespace {

namespace fs = std::filesystem;
using boost::algorithm::ends_with;
using boost::algorithm::replace_all_copy;

constexpr double kMargin = 0.04;     // of the span of the data, on both sides
constexpr double kLogMargin = 1.25;  // the same as a factor
constexpr std::size_t kManyDots = 200;
constexpr double kOfManyDots = 0.7;       // size of each
constexpr std::size_t kLongLabel = 50;    // characters
constexpr std::string_view kUnit = " (";  // where it begins in a label
constexpr const char* kNotInstalled = "no picture was drawn: gnuplot is not installed";

// gnuplot did not end in time, as on a loaded computer.
class TookTooLong : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// In the order of Colour.
constexpr std::array<const char*, 10> kColours = {"#3385c6", "#d9741a", "#2e8b57", "#8e44ad", "#b8860b",
                                                  "#008b8b", "#7f5539", "#c0392b", "#1a1a1a", "#9a9a9a"};

// How gnuplot draws a series, in the order of Style.
struct StyleCommand {
  const char* with;
  double size;  // line width, or size of points
};
constexpr std::array<StyleCommand, 7> kStyles = {
    {{"lines lw", 1.8},
     {"lines dt (10,6) lw", 1.8},
     {"steps lw", 1.8},
     {"points pt 7 ps", 0.6},
     {"points pt 2 lw 1.8 ps", 1.0},
     {"filledcurves closed fs transparent solid 0.25 noborder lw", 1.0},
     {"boxplot fs solid 0.25 lw", 1.4}}};

constexpr const char* kPanel = R"(
reset
set border lc rgb '#555555'
set grid lt 1 lc rgb '#dddddd' lw 0.8
set tics nomirror
set format '%g'
set key tmargin center horizontal Left reverse samplen 2.5
set title offset 0,-0.6
set style boxplot fraction 0.90 outliers pointtype 7
set pointsize 0.35
)";
constexpr const char* kViewInSpace = R"(set view 62,35
set xyplane at 0
set xtics offset -0.8,-0.3
set ytics offset 0.9,-0.1
set xlabel offset 0,-0.5
set ylabel offset 0,-0.5
set zlabel rotate by 90 offset -1
)";
constexpr const char* kInBox = R"(set lmargin at screen {:g}
set rmargin at screen {:g}
set bmargin at screen {:g}
set tmargin at screen {:g}
set key at graph 0.5,1.01 center bottom
)";

const char* colour_of(Colour colour) { return kColours.at(static_cast<std::size_t>(colour)); }

// A string of gnuplot. In single quotes it substitutes nothing, and the terminals are `noenhanced`; but a line
// break would end the command.
std::string quoted(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return "'" + replace_all_copy(text, "'", "''") + "'";
}

// What an axis shows: numbers between from and to, divided by a power of ten.
struct Scale {
  double from;
  double to;
  int exponent = 0;
  double power = 1.0;
  double span() const { return to - from; }
};

Scale scale_of(const Panel& panel, const Axis& axis, double Point::*coordinate, double least_span) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto take = [&](double value) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Series& series : panel.series)
    for (const Point& point : series.points) take(point.*coordinate);
  if (panel.zero_line && coordinate == &Point::y) take(0.0);
  if (!(low <= high)) low = high = 1.0;  // no data
  low = axis.from.value_or(low);
  high = std::max(low, axis.to.value_or(high));
  if (axis.logarithmic) return {axis.from.value_or(low / kLogMargin), axis.to.value_or(high * kLogMargin)};
  double margin = kMargin * (high - low);
  if (low == high) margin = low != 0.0 ? 0.5 * std::abs(low) : 0.5;
  margin = std::max(margin, 0.5 * (least_span - (high - low)));
  Scale scale{axis.from.value_or(low - margin), axis.to.value_or(high + margin)};
  const double largest = std::max(std::abs(scale.from), std::abs(scale.to));
  if (!panel.equal && (largest < 0.1 || largest >= 1e6))
    scale.exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0));
  scale.power = std::pow(10.0, scale.exponent);
  return scale;
}

// "thrust (N)" becomes "thrust (10^-3 N)", with superscripts.
std::string with_power(const std::string& label, int exponent) {
  constexpr std::array<const char*, 10> kSuperscripts = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  if (exponent == 0) return label;
  std::string power = "10";
  for (const char c : std::to_string(exponent))
    power += c == '-' ? "\u207b" : kSuperscripts.at(static_cast<std::size_t>(c - '0'));
  const std::size_t unit = label.rfind(kUnit);
  if (unit == std::string::npos) return label + kUnit.data() + power + ")";
  return label.substr(0, unit + kUnit.size()) + power + " " + label.substr(unit + kUnit.size());
}

// A long label has its unit in a second line.
std::string label_command(const std::string& label) {
  const std::size_t unit = label.size() < kLongLabel ? std::string::npos : label.rfind(kUnit);
  if (unit == std::string::npos) return quoted(label);
  return quoted(label.substr(0, unit)) + " . \"\\n\" . " + quoted(label.substr(unit + 1));
}

std::string axis_commands(char name, const Axis& axis, const Scale& scale) {
  const double from = (axis.reversed ? scale.to : scale.from) / scale.power;
  const double to = (axis.reversed ? scale.from : scale.to) / scale.power;
  std::string out = fmt::format("set {0}range [{1:.9g}:{2:.9g}]\nset {0}label {3}\n", name, from, to,
                                label_command(with_power(axis.label, scale.exponent)));
  if (axis.logarithmic) out += fmt::format("set logscale {}\n", name);
  if (!axis.numbered) out += fmt::format("set format {} ''\n", name);
  std::string ticks;
  for (std::size_t i = 0; i < axis.names.size(); ++i)  // gnuplot takes a name as a format
    ticks +=
        fmt::format("{}{} {}", i == 0 ? "" : ", ", quoted(replace_all_copy(axis.names[i], "%", "%%")), i + 1);
  return ticks.empty() ? out : out + fmt::format("set {}tics ({})\n", name, ticks);
}

// The box of a view in space: gnuplot sizes it by its ground, so that what is high would reach beyond it.
Box smaller_if_high(Box box, double height_over_width) {
  const double part = std::clamp(2.0 * height_over_width - 1.0, 0.0, 1.0);
  const double width = box.right - box.left;
  box.left += 0.11 * part * width;
  box.right -= 0.11 * part * width;
  box.bottom += 0.17 * part * (box.top - box.bottom);
  return box;
}

// The texts are below each other, so that those of intervals that follow closely do not collide.
void add_intervals(std::string& script, const Panel& panel, const Scale& x) {
  constexpr std::size_t kRows = 8;
  std::size_t row = 0;
  for (const Interval& interval : panel.intervals) {
    const double from = interval.from / x.power;
    script += fmt::format(
        "set arrow from {0:.7g},graph 0 to {0:.7g},graph 1 nohead back lw 1 lc rgb '{2}'\n"
        "set object rectangle from {0:.7g},graph 0 to {1:.7g},graph 1 back fs transparent solid 0.12 "
        "noborder fc rgb '{2}'\n",
        from, interval.to / x.power, colour_of(Colour::kRed));
    if (interval.text.empty()) continue;
    script += fmt::format("set label {} at {:.7g},graph {:g} left offset 0.4,0 front font ',9' tc rgb '{}'\n",
                          quoted(interval.text), from, 0.93 - 0.11 * static_cast<double>(row++ % kRows),
                          colour_of(Colour::kRed));
  }
}

void add_panel(std::string& script, const Panel& panel, std::size_t number) {
  Scale x = scale_of(panel, panel.x, &Point::x, panel.x.least_span);
  Scale y = scale_of(panel, panel.y, &Point::y, panel.y.least_span);
  const Scale z = scale_of(panel, panel.z, &Point::z, panel.z.least_span);
  if (panel.equal) {
    const double span = std::max({x.span(), y.span(), panel.in_space ? z.span() : 0.0});
    x = scale_of(panel, panel.x, &Point::x, span);
    y = scale_of(panel, panel.y, &Point::y, span);
  }
  std::string plots;
  for (const Series& series : panel.series) {
    if (series.points.empty()) continue;
    const std::string name = fmt::format("$panel{}_series{}", number, &series - panel.series.data() + 1);
    script += fmt::format("{} << EOD\n", name);
    for (const Point& p : series.points) {
      if (std::isfinite(p.x + p.y + p.z))
        script += fmt::format("{:.7g} {:.7g} {:.7g}\n", p.x / x.power, p.y / y.power, p.z / z.power);
      else
        script += "\n\n";  // interrupts a line
    }
    script += "EOD\n";
    const StyleCommand& style = kStyles.at(static_cast<std::size_t>(series.style));
    const bool many = series.style == Style::kDots && series.points.size() > kManyDots;
    plots +=
        fmt::format("{} {} using {} with {} {:g} lc rgb '{}' title {}", plots.empty() ? "" : ", \\\n ", name,
                    panel.in_space                  ? "1:2:3"
                    : series.style == Style::kBoxes ? "1:2:(0.5)"
                                                    : "1:2",
                    style.with, style.size * series.weight * (many ? kOfManyDots : 1.0),
                    colour_of(series.colour), quoted(series.label));
  }
  script += kPanel + axis_commands('x', panel.x, x) + axis_commands('y', panel.y, y);
  if (panel.in_space) script += axis_commands('z', panel.z, z) + kViewInSpace;
  if (panel.equal) script += panel.in_space ? "set view equal xyz\n" : "set size ratio -1\n";
  if (panel.zero_line) script += "set xzeroaxis lt 1 lc rgb '#777777'\n";
  script += "set title " + quoted(panel.title) + "\n";
  if (panel.box) {
    const Box box =
        panel.equal && panel.in_space ? smaller_if_high(*panel.box, z.span() / x.span()) : *panel.box;
    script += fmt::format(kInBox, box.left, box.right, box.bottom, box.top);
  }
  for (const Label& label : panel.labels)
    script += fmt::format("set label {} at {:.7g},{:.7g} {} front tc rgb '{}'\n", quoted(label.text),
                          label.at.x / x.power, label.at.y / y.power,
                          label.ends_here ? "right offset -0.6,-0.7" : "left offset 0.6,0.6",
                          colour_of(label.colour));
  add_intervals(script, panel, x);
  script += (panel.in_space ? "splot" : "plot") + (plots.empty() ? " NaN notitle" : plots) + "\n";
}

// True if the file has the last element of a PNG picture. gnuplot succeeds where it can write only the beginning of
// one.
bool is_whole(const std::string& picture) {
  constexpr std::string_view kLastPngChunk("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  return ends_with(picture, kLastPngChunk);
}

// Runs the script in a temporary folder. Returns the file 0 that it writes there. Throws std::runtime_error.
std::string run_gnuplot(const std::string& script, std::chrono::seconds longest) {
  const fs::path gnuplot = io::find_program("gnuplot");
  if (gnuplot.empty()) throw std::runtime_error(kNotInstalled);
  const auto temporary = io::TemporaryFolder::of_the_system("swiftlet-plot");
  const fs::path& folder = temporary.path();
  io::write_atomically(folder / "script", script);
  io::ChildProcess process({"gnuplot", gnuplot, {"script"}, folder / "log", folder});
  const auto end = process.wait(longest);
  const std::string no_picture = "no picture was drawn: gnuplot ";
  if (!end) throw TookTooLong(no_picture + fmt::format("took longer than {} s", longest.count()));
  if (end->by_signal || end->code != 0)
    throw std::runtime_error(no_picture + end->to_string() + ": " + process.last_log_line());
  std::string picture = io::read_text_file(folder / "0");
  if (!is_whole(picture))
    throw std::runtime_error(no_picture + "wrote a truncated file; is " + fs::temp_directory_path().string() +
                             " full?");
  return picture;
}

}  // namespace

std::string gnuplot_script(const Figure& figure, const std::string& output) {
  std::string script = fmt::format(
      "set encoding utf8\nset terminal pngcairo font 'DejaVu Sans,12' noenhanced size {},{}\nset output {}\n"
      "set multiplot title {} font ',15'\n",
      figure.width, figure.height, quoted(output), quoted(figure.title));
  for (std::size_t i = 0; i < figure.panels.size(); ++i) add_panel(script, figure.panels[i], i + 1);
  return script + "unset multiplot\nunset output\n";
}

namespace {

void draw(const Figure& figure, const fs::path& png, bool with_script, std::chrono::seconds longest) {
  if (with_script)
    io::write_atomically(
        fs::path(png).replace_extension(".gp"),
        "# Run gnuplot on this file, in its folder.\n" + gnuplot_script(figure, png.filename()));
  io::write_atomically(png, run_gnuplot(gnuplot_script(figure, "0"), longest));
}

}  // namespace

std::string draw_png(const Figure& figure, const fs::path& png) {
  try {
    draw(figure, png, false, kLongestDrawing);
    return {};
  } catch (const std::exception& fault) {
    return fault.what();
  }
}

std::string draw_png_if_installed(const Figure& figure, const fs::path& png, std::chrono::seconds longest) {
  const std::string hint = " (" + fs::path(png).replace_extension(".gp").filename().string() + " draws it)";
  try {
    draw(figure, png, true, longest);
    return {};
  } catch (const TookTooLong& fault) {
    return fault.what() + hint;
  } catch (const std::exception& fault) {
    if (!io::find_program("gnuplot").empty()) throw;
    return fault.what() + (fault.what() == std::string_view(kNotInstalled) ? hint : "");
  }
}

}  // namespace swiftlet::plot
