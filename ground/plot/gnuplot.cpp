#include "swiftlet/ground/plot/gnuplot.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "swiftlet/ground/plot/page.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/runtime/child_process.hpp"

namespace swiftlet::plot {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLongest{30};
constexpr double kMargin = 0.04;     // of the span of the data, on both sides
constexpr double kLogMargin = 1.25;  // the same as a factor
constexpr std::size_t kManyDots = 200;
constexpr const char* kNoPicture = "no picture was drawn: ";
constexpr const char* kNotInstalled = "gnuplot is not installed";

// Settings of every panel.
constexpr const char* kPanel = R"(
reset
set border lc rgb '#555555'
set grid lt 1 lc rgb '#dddddd' lw 0.8
set tics nomirror
set format '%g'
set key tmargin center horizontal Left reverse samplen 2.5
set style boxplot fraction 0.90 outliers pointtype 7
set pointsize 0.35
)";
constexpr const char* kInSpace = R"(set view 62,35
set xyplane at 0
set xtics offset -0.8,-0.3
set ytics offset 0.9,-0.1
set xlabel offset 0,-0.5
set ylabel offset 0,-0.5
set zlabel rotate by 90 offset -1
)";

std::string colour_of(Colour colour) {
  constexpr std::array<const char*, 10> kPalette = {"#1f6fb4", "#d9741a", "#2e8b57", "#8e44ad", "#b8860b",
                                                    "#008b8b", "#7f5539", "#c0392b", "#1a1a1a", "#9a9a9a"};
  return fmt::format(" rgb '{}'", kPalette.at(static_cast<std::size_t>(colour)));
}

// A string of gnuplot. In single quotes it substitutes nothing, and the terminals are `noenhanced`; but a line
// break would end the command.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += c;
    out += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
  }
  return out + "'";
}

struct Range {
  double from = 0.0;
  double to = 1.0;
  double span() const { return to - from; }
};

Range extent(const Panel& panel, double Point::*coordinate, bool logarithmic) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Range data{kInfinity, -kInfinity};
  const auto take = [&](double value) { data = {std::min(data.from, value), std::max(data.to, value)}; };
  for (const Series& series : panel.series) {
    for (const Point& point : series.points) {
      const double value = point.*coordinate;
      if (std::isfinite(value) && (!logarithmic || value > 0.0)) take(value);
    }
  }
  if (panel.zero_line && coordinate == &Point::y) take(0.0);
  if (data.from <= data.to) return data;
  return logarithmic ? Range{1.0, 10.0} : Range{0.0, 1.0};
}

Range range_of(const Panel& panel, const Axis& axis, double Point::*coordinate) {
  const Range data = extent(panel, coordinate, axis.logarithmic);
  const double low = axis.from.value_or(data.from);
  const double high = std::max(low, axis.to.value_or(data.to));
  if (axis.logarithmic) return {axis.from.value_or(low / kLogMargin), axis.to.value_or(high * kLogMargin)};
  double margin = kMargin * (high - low);
  if (!(high > low)) margin = low != 0.0 ? 0.5 * std::abs(low) : 0.5;
  margin = std::max(margin, 0.5 * (axis.least_span - (high - low)));
  return {axis.from.value_or(low - margin), axis.to.value_or(high + margin)};
}

void widen(Range& range, const Axis& axis, double span) {
  const double missing = span - range.span();
  if (axis.from || axis.to || missing <= 0.0) return;
  range = {range.from - 0.5 * missing, range.to + 0.5 * missing};
}

struct Ranges {
  Range x, y, z;
};

Ranges ranges_of(const Panel& panel) {
  Ranges out{range_of(panel, panel.x, &Point::x), range_of(panel, panel.y, &Point::y),
             range_of(panel, panel.z, &Point::z)};
  if (panel.equal) {
    const double span = std::max({out.x.span(), out.y.span(), panel.in_space ? out.z.span() : 0.0});
    widen(out.x, panel.x, span);
    widen(out.y, panel.y, span);
  }
  return out;
}

// The power of ten, a multiple of three, that makes the numbers of an axis short.
int exponent_of(const Panel& panel, const Axis& axis, const Range& range) {
  const double largest = std::max(std::abs(range.from), std::abs(range.to));
  if (panel.equal || axis.logarithmic || (largest >= 0.1 && largest < 1e6)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0));
}

// "thrust (N)" becomes "thrust (10^-3 N)", with superscripts.
std::string with_power(const std::string& label, int exponent) {
  if (exponent == 0) return label;
  constexpr std::array<const char*, 10> kSuperscripts = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string power = "10";
  for (const char c : std::to_string(exponent))
    power += c == '-' ? "\u207b" : kSuperscripts.at(static_cast<std::size_t>(c - '0'));
  const std::size_t unit = label.rfind('(');
  if (unit == std::string::npos) return label + " (" + power + ")";
  return label.substr(0, unit + 1) + power + " " + label.substr(unit + 1);
}

std::string axis_commands(char name, const Axis& axis, Range range, int exponent) {
  const double power = std::pow(10.0, exponent);
  if (axis.reversed) std::swap(range.from, range.to);
  std::string out = fmt::format("set {}range [{:.9g}:{:.9g}]\n", name, range.from / power, range.to / power);
  if (!axis.label.empty())
    out += fmt::format("set {}label {}\n", name, quoted(with_power(axis.label, exponent)));
  if (axis.logarithmic) out += fmt::format("set logscale {}\n", name);
  if (!axis.numbered) out += fmt::format("set format {} ''\n", name);
  for (std::size_t i = 0; i < axis.names.size(); ++i)
    out += fmt::format("set {}tics {}({} {})\n", name, i == 0 ? "" : "add ", quoted(axis.names[i]), i + 1);
  return out;
}

std::string style_of(const Series& series) {
  const double size = series.weight;
  const std::string colour = " lc" + colour_of(series.colour);
  switch (series.style) {
    case Style::kLine:
      return fmt::format("lines lw {:g}", 1.8 * size) + colour;
    case Style::kDashes:
      return fmt::format("lines dt (10,6) lw {:g}", 1.8 * size) + colour;
    case Style::kSteps:
      return fmt::format("steps lw {:g}", 1.8 * size) + colour;
    case Style::kDots:
      return fmt::format("points pt 7 ps {:g}", (series.points.size() > kManyDots ? 0.45 : 0.7) * size) +
             colour;
    case Style::kCrosses:
      return fmt::format("points pt 2 lw 1.8 ps {:g}", size) + colour;
    case Style::kBand:
      return "filledcurves closed" + colour + " fs transparent solid 0.25 noborder";
    case Style::kBoxes:
      break;
  }
  return fmt::format("boxplot lw {:g}", 1.4 * size) + colour + " fs solid 0.25";
}

// The points as a data block of gnuplot. Two blank lines interrupt a line.
void add_data(std::string& script, const std::string& name, const Series& series, const Point& powers,
              bool in_space) {
  const auto out = std::back_inserter(script);
  fmt::format_to(out, "{} << EOD\n", name);
  for (const Point& point : series.points) {
    if (!std::isfinite(point.x + point.y + point.z))
      script += "\n\n";
    else if (in_space)
      fmt::format_to(out, "{:.7g} {:.7g} {:.7g}\n", point.x / powers.x, point.y / powers.y,
                     point.z / powers.z);
    else
      fmt::format_to(out, "{:.7g} {:.7g}\n", point.x / powers.x, point.y / powers.y);
  }
  script += "EOD\n";
}

void add_panel(std::string& script, const Panel& panel, std::size_t number) {
  const Ranges ranges = ranges_of(panel);
  const std::array<int, 3> exponents = {exponent_of(panel, panel.x, ranges.x),
                                        exponent_of(panel, panel.y, ranges.y),
                                        exponent_of(panel, panel.z, ranges.z)};
  const Point powers = {std::pow(10.0, exponents[0]), std::pow(10.0, exponents[1]),
                        std::pow(10.0, exponents[2])};
  std::string plots;
  for (const Series& series : panel.series) {
    if (series.points.empty()) continue;
    const std::string name = fmt::format("$panel{}_series{}", number, &series - panel.series.data() + 1);
    add_data(script, name, series, powers, panel.in_space);
    plots += plots.empty() ? " " : ", \\\n  ";
    plots += name + (panel.in_space                  ? " using 1:2:3 with "
                     : series.style == Style::kBoxes ? " using 1:2:(0.5) with "
                                                     : " using 1:2 with ");
    plots += style_of(series) + (series.label.empty() ? " notitle" : " title " + quoted(series.label));
  }
  script += kPanel;
  script += axis_commands('x', panel.x, ranges.x, exponents[0]);
  script += axis_commands('y', panel.y, ranges.y, exponents[1]);
  if (panel.in_space) script += axis_commands('z', panel.z, ranges.z, exponents[2]) + kInSpace;
  if (!panel.title.empty()) script += "set title " + quoted(panel.title) + "\n";
  if (panel.zero_line) script += "set xzeroaxis lt 1 lc rgb '#777777'\n";
  if (panel.equal) script += panel.in_space ? "set view equal xyz\n" : "set size ratio -1\n";
  if (panel.box)
    script += fmt::format(
        "set lmargin at screen {:g}\nset rmargin at screen {:g}\nset bmargin at screen {:g}\nset tmargin at "
        "screen "
        "{:g}\n",
        panel.box->left, panel.box->right, panel.box->bottom, panel.box->top);
  for (const Label& label : panel.labels)
    script += fmt::format("set label {} at {:.7g},{:.7g} {} front tc{}\n", quoted(label.text),
                          label.at.x / powers.x, label.at.y / powers.y,
                          label.ends_here ? "right offset -0.6,-0.7" : "left offset 0.6,0.6",
                          colour_of(label.colour));
  script += (panel.in_space ? "splot" : "plot") + (plots.empty() ? " NaN notitle" : plots) + "\n";
}

// A new temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "swiftlet-plot.XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error(pattern + " cannot be made");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

// Runs the script in a temporary folder. Returns the contents of the files that it writes there. Throws
// std::runtime_error.
std::vector<std::string> drawn(const std::string& script, const std::vector<std::string>& outputs) {
  const fs::path gnuplot = ground::find_program("gnuplot");
  if (gnuplot.empty()) throw std::runtime_error(kNotInstalled);
  const TemporaryFolder folder;
  ground::write_whole_file(folder / "script.gp", script);
  ground::ChildProcess process({"gnuplot", gnuplot, {"script.gp"}, folder / "log", folder / ""});
  const auto end = process.wait(kLongest);
  if (!end) throw std::runtime_error(fmt::format("gnuplot took longer than {} s", kLongest.count()));
  if (end->by_signal || end->code != 0)
    throw std::runtime_error("gnuplot " + end->to_string() + ": " + process.last_log_line());
  std::vector<std::string> files;
  for (const std::string& output : outputs) files.push_back(runtime::read_text_file(folder / output));
  return files;
}

// An <svg> element without the prolog, namespaces and size of the file, and without the tooltips of gnuplot.
std::string element_of(const std::string& file, const Figure& figure) {
  constexpr std::string_view kEndOfHead = "</desc>";
  constexpr std::string_view kTooltip = "<title>gnuplot_plot_";
  constexpr std::string_view kEndOfTooltip = "</title>";
  std::string body = file.substr(file.find(kEndOfHead) + kEndOfHead.size());
  for (std::size_t at = body.find(kTooltip); at != std::string::npos; at = body.find(kTooltip, at))
    body.erase(at, body.find(kEndOfTooltip, at) + kEndOfTooltip.size() - at);
  return fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\"><title>", figure.width, figure.height) +
         html_escaped(figure.title) + "</title>" + body;
}

}  // namespace

std::string gnuplot_script(const Figure& figure, Format format, const std::string& output) {
  std::string script = "set encoding utf8\n";
  script += format == Format::kPng ? "set terminal pngcairo font 'DejaVu Sans,12'"
                                   : "set terminal svg dynamic font 'sans-serif,13' background '#ffffff'";
  script += fmt::format(" noenhanced size {},{}\nset output {}\nset multiplot", figure.width, figure.height,
                        quoted(output));
  if (format == Format::kPng) script += " title " + quoted(figure.title) + " font ',15'";
  script += "\n";
  for (std::size_t i = 0; i < figure.panels.size(); ++i) add_panel(script, figure.panels[i], i + 1);
  return script + "unset multiplot\nunset output\n";
}

std::string draw_png(const Figure& figure, const fs::path& png) {
  std::string picture;
  try {
    picture = drawn(gnuplot_script(figure, Format::kPng, "picture.png"), {"picture.png"}).front();
  } catch (const std::exception& fault) {
    return std::string(kNoPicture) + fault.what();
  }
  try {
    ground::write_whole_file(png, picture);
  } catch (const std::exception& fault) {
    return fault.what();
  }
  return {};
}

std::string draw_png_and_script(const Figure& figure, const fs::path& png) {
  const fs::path script = fs::path(png).replace_extension(".gp");
  const std::string name = script.filename().string();
  const std::string output = png.filename().string();
  ground::write_whole_file(script, "# Draws " + output + ": run `gnuplot " + name + "` in this folder.\n" +
                                       gnuplot_script(figure, Format::kPng, output));
  const std::string fault = draw_png(figure, png);
  return fault == std::string(kNoPicture) + kNotInstalled ? fault + " (" + name + " draws it)" : fault;
}

Drawings draw_svg(const std::vector<Figure>& figures) {
  Drawings out;
  if (figures.empty()) return out;
  std::string script;
  std::vector<std::string> outputs;
  for (const Figure& figure : figures) {
    outputs.push_back(std::to_string(outputs.size()) + ".svg");
    script += gnuplot_script(figure, Format::kSvg, outputs.back());
  }
  try {
    const std::vector<std::string> files = drawn(script, outputs);
    for (std::size_t i = 0; i < files.size(); ++i) out.svg.push_back(element_of(files[i], figures[i]));
  } catch (const std::exception& fault) {
    out.fault = std::string(kNoPicture) + fault.what();
  }
  return out;
}

}  // namespace swiftlet::plot
