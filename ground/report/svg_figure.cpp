#include "swiftlet/ground/report/svg_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/core.h>

namespace swiftlet::ground {
namespace {

constexpr int kWidth = 640;
constexpr int kLeft = 74;
constexpr int kRight = 16;
constexpr int kTop = 14;
constexpr int kBottom = 54;
constexpr int kTicks = 6;         // approximate number
constexpr double kMargin = 0.04;  // of the span, on both sides
constexpr int kLegendRow = 18;
constexpr double kCharacter = 6.6;  // px, approximate width in the legend

// Maps the data of one axis to pixels.
class Axis {
 public:
  Axis(double min, double max, double from_px, double to_px) : from_px_(from_px), to_px_(to_px) {
    if (!(max > min)) {
      const double around = std::max(std::abs(min), 1e-12);
      min -= 0.5 * around;
      max += 0.5 * around;
    }
    const double margin = kMargin * (max - min);
    min_ = min - margin;
    max_ = max + margin;
    step_ = round_step((max_ - min_) / kTicks);
    const double largest = std::max(std::abs(min_), std::abs(max_));
    const double exponent = std::floor(std::log10(largest) / 3.0) * 3.0;
    exponent_ = exponent > 3.0 || exponent < 0.0 ? static_cast<int>(exponent) : 0;
    if (exponent_ == -3 && largest >= 0.1) exponent_ = 0;
  }

  double pixel(double value) const { return from_px_ + (value - min_) / (max_ - min_) * (to_px_ - from_px_); }
  std::vector<double> ticks() const {
    std::vector<double> out;
    for (double k = std::ceil(min_ / step_); k * step_ <= max_; k += 1.0) out.push_back(k * step_);
    return out;
  }
  std::string tick_text(double value) const {
    const double scale = std::pow(10.0, exponent_);
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step_ / scale) + 1e-9)));
    const std::string text = fmt::format("{:.{}f}", value / scale, decimals);
    return std::abs(value) < 1e-9 * step_ ? "0" : text;
  }
  // "thrust (N)" -> "thrust (10^-3 N)"
  std::string label(const std::string& text) const {
    if (exponent_ == 0) return html_escaped(text);
    const std::string power =
        fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{}</tspan><tspan dy=\"5\"> </tspan>", exponent_);
    const std::size_t open = text.rfind('(');
    if (open == std::string::npos) return html_escaped(text) + " (" + power + ")";
    return html_escaped(text.substr(0, open + 1)) + power + html_escaped(text.substr(open + 1));
  }

 private:
  // 1, 2 or 5 times a power of ten.
  static double round_step(double rough) {
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * power >= rough * 0.9) return factor * power;
    }
    return 10.0 * power;
  }

  double from_px_, to_px_;
  double min_ = 0.0, max_ = 1.0, step_ = 1.0;
  int exponent_ = 0;
};

struct Extent {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  void take(double value) {
    if (!std::isfinite(value)) return;
    min = std::min(min, value);
    max = std::max(max, value);
  }
};

struct Legend {
  std::string label;
  const FigureSeries* series;  // null for a band
  std::string colour;
};

class Drawing {
 public:
  explicit Drawing(const Figure& figure)
      : figure_(figure),
        extents_(extents(figure)),
        x_(extents_[0].min, extents_[0].max, kLeft, kWidth - kRight),
        y_(extents_[1].min, extents_[1].max, figure.height - kBottom, kTop) {}

  std::string draw() {
    out_ = fmt::format(
               "<svg viewBox=\"0 0 {} {}\" role=\"img\" "
               "font-family=\"sans-serif\" font-size=\"13\">",
               kWidth, figure_.height) +
           "<title>" + html_escaped(figure_.title) + "</title>\n" +
           fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", kWidth, figure_.height);
    axes();
    for (const FigureBand& band : figure_.bands) draw_band(band);
    // Draws points after curves, so that curves do not hide them.
    for (const FigureSeries& series : figure_.series) {
      if (series.mark == Mark::kLine || series.mark == Mark::kDashes) draw_series(series);
    }
    for (const FigureSeries& series : figure_.series) {
      if (series.mark == Mark::kDots || series.mark == Mark::kCrosses) draw_series(series);
    }
    legend();
    return out_ + "</svg>\n";
  }

 private:
  static std::array<Extent, 2> extents(const Figure& figure) {
    std::array<Extent, 2> out;
    const auto take = [&](const std::vector<FigurePoint>& points) {
      for (const FigurePoint& point : points) {
        out[0].take(point.x);
        out[1].take(point.y);
      }
    };
    for (const FigureSeries& series : figure.series) take(series.points);
    for (const FigureBand& band : figure.bands) {
      take(band.low);
      take(band.high);
    }
    if (figure.zero_line) out[1].take(0.0);
    for (Extent& extent : out) {
      if (!(extent.min <= extent.max)) extent = {0.0, 1.0};
    }
    return out;
  }

  void axes() {
    const int bottom = figure_.height - kBottom;
    for (const double tick : x_.ticks()) {
      out_ +=
          fmt::format("<path d=\"M{:.1f} {} V{}\" stroke=\"#e3e3e3\"/>", x_.pixel(tick), kTop, bottom) +
          fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">", x_.pixel(tick), bottom + 18) +
          x_.tick_text(tick) + "</text>\n";
    }
    for (const double tick : y_.ticks()) {
      out_ +=
          fmt::format("<path d=\"M{} {:.1f} H{}\" stroke=\"#e3e3e3\"/>", kLeft, y_.pixel(tick),
                      kWidth - kRight) +
          fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">", kLeft - 7, y_.pixel(tick) + 4.5) +
          y_.tick_text(tick) + "</text>\n";
    }
    if (figure_.zero_line)
      out_ += fmt::format("<path d=\"M{} {:.1f} H{}\" stroke=\"#777\"/>\n", kLeft, y_.pixel(0.0),
                          kWidth - kRight);
    out_ +=
        fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#555\"/>\n",
                    kLeft, kTop, kWidth - kRight - kLeft, bottom - kTop);
    out_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">", (kLeft + kWidth - kRight) / 2,
                        figure_.height - 12) +
            x_.label(figure_.x_label) + "</text>\n";
    out_ += fmt::format("<text transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">",
                        (kTop + bottom) / 2) +
            y_.label(figure_.y_label) + "</text>\n";
  }

  std::string path_of(const std::vector<FigurePoint>& points) const {
    std::string out;
    for (const FigurePoint& point : points)
      out += fmt::format("{}{:.1f} {:.1f}", out.empty() ? "M" : "L", x_.pixel(point.x), y_.pixel(point.y));
    return out;
  }

  void draw_band(const FigureBand& band) {
    std::vector<FigurePoint> around = band.low;
    around.insert(around.end(), band.high.rbegin(), band.high.rend());
    out_ += "<path d=\"" + path_of(around) + "Z\" fill=\"" + band.colour + "\" fill-opacity=\"0.25\"/>\n";
  }

  void draw_series(const FigureSeries& series) {
    if (series.mark == Mark::kLine || series.mark == Mark::kDashes) {
      out_ += "<path d=\"" + path_of(series.points) + "\" fill=\"none\" stroke=\"" + series.colour +
              "\" stroke-width=\"1.8\"" + (series.mark == Mark::kDashes ? " stroke-dasharray=\"7 5\"" : "") +
              "/>\n";
      return;
    }
    // One path for all points of a series keeps the page small for long records.
    std::string d;
    for (const FigurePoint& point : series.points) {
      const double x = x_.pixel(point.x);
      const double y = y_.pixel(point.y);
      d += series.mark == Mark::kDots ? fmt::format("M{:.1f} {:.1f}h0", x, y)
                                      : fmt::format("M{:.1f} {:.1f}l8 8m0-8l-8 8", x - 4.0, y - 4.0);
    }
    const double width = series.mark == Mark::kCrosses ? 2.0 : series.points.size() > 200 ? 2.6 : 5.0;
    out_ += "<path d=\"" + d + "\" fill=\"none\" stroke=\"" + series.colour +
            fmt::format("\" stroke-width=\"{:.1f}\" stroke-linecap=\"round\"/>\n", width);
  }

  void legend() {
    std::vector<Legend> rows;
    for (const FigureSeries& series : figure_.series) {
      if (!series.label.empty()) rows.push_back({series.label, &series, series.colour});
    }
    for (const FigureBand& band : figure_.bands) {
      if (!band.label.empty()) rows.push_back({band.label, nullptr, band.colour});
    }
    if (rows.empty()) return;
    std::size_t longest = 0;
    for (const Legend& row : rows) longest = std::max(longest, row.label.size());
    const double width = 40.0 + kCharacter * static_cast<double>(longest);
    const double height = 8.0 + kLegendRow * static_cast<double>(rows.size());
    const auto [x, y] = emptiest_corner(width, height);
    out_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#fff\" "
        "fill-opacity=\"0.85\" "
        "stroke=\"#ccc\"/>\n",
        x, y, width, height);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double middle = y + 4.0 + kLegendRow * (static_cast<double>(i) + 0.5);
      out_ += legend_mark(rows[i], x + 6.0, middle) +
              fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"12\">", x + 33.0, middle + 4.0) +
              html_escaped(rows[i].label) + "</text>\n";
    }
  }

  // Upper left corner of a box of this size in the corner of the plot where it hides the fewest points.
  FigurePoint emptiest_corner(double width, double height) const {
    constexpr double kGap = 8.0;
    const double left = kLeft + kGap;
    const double right = kWidth - kRight - kGap - width;
    const double top = kTop + kGap;
    const double bottom = figure_.height - kBottom - kGap - height;
    FigurePoint best;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const FigurePoint corner : {FigurePoint{left, top}, FigurePoint{right, bottom},
                                     FigurePoint{right, top}, FigurePoint{left, bottom}}) {
      std::size_t hidden = 0;
      for (const FigureSeries& series : figure_.series) {
        for (const FigurePoint& point : series.points) {
          const double from_left = x_.pixel(point.x) - corner.x;
          const double from_top = y_.pixel(point.y) - corner.y;
          if (from_left > -kGap && from_left < width + kGap && from_top > -kGap && from_top < height + kGap)
            ++hidden;
        }
      }
      if (hidden < fewest) {
        fewest = hidden;
        best = corner;
      }
    }
    return best;
  }

  static std::string legend_mark(const Legend& row, double x, double y) {
    if (row.series == nullptr)
      return fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"22\" height=\"10\" fill=\"{}\" fill-opacity=\"0.25\"/>", x,
          y - 5.0, row.colour.c_str());
    switch (row.series->mark) {
      case Mark::kDots:
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\"/>", x + 11.0, y,
                           row.colour.c_str());
      case Mark::kCrosses:
        return fmt::format("<path d=\"M{:.1f} {:.1f}l8 8m0-8l-8 8\" stroke=\"{}\" stroke-width=\"2\"/>",
                           x + 7.0, y - 4.0, row.colour.c_str());
      case Mark::kLine:
      case Mark::kDashes:
        break;
    }
    return fmt::format("<path d=\"M{:.1f} {:.1f}h22\" stroke=\"{}\" stroke-width=\"1.8\"{}/>", x, y,
                       row.colour.c_str(),
                       row.series->mark == Mark::kDashes ? " stroke-dasharray=\"7 5\"" : "");
  }

  const Figure& figure_;
  std::array<Extent, 2> extents_;
  Axis x_, y_;
  std::string out_;
};

}  // namespace

std::string svg(const Figure& figure) { return Drawing(figure).draw(); }

std::string html_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace swiftlet::ground
