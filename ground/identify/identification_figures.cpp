#include "swiftlet/ground/identify/identification_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include <fmt/core.h>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::ground {
namespace {

using identification::Experiment;
using Parameters = std::vector<double>;
using Model = std::function<double(const Parameters&, double x)>;

constexpr int kCurvePoints = 80;
constexpr double kDerivativeStep = 1e-5;  // relative
constexpr std::size_t kMostGroups = 7;
constexpr std::size_t kUsualGroups = 5;
constexpr double kGroupWidth = 0.03;  // of the supply voltage, largest relative span of a group
constexpr const char* kFitColour = "#1a1a1a";
constexpr const char* kReadingColour = "#1f6fb4";
constexpr const char* kOutlierColour = "#c0392b";
constexpr const char* kBandColour = "#f39c12";
constexpr std::array<const char*, kMostGroups> kGroupColours = {"#1f6fb4", "#c2571a", "#2e8b57", "#8e44ad",
                                                                "#b8860b", "#008b8b", "#7f5539"};

Parameters values(const Experiment& fit) {
  Parameters out;
  for (const identification::ParameterEstimate& estimate : fit.estimates) out.push_back(estimate.value);
  return out;
}

// Variance of the model's value at x, from the covariance of its parameters.
double variance(const Experiment& fit, const Model& model, double x) {
  const Parameters at = values(fit);
  Eigen::VectorXd gradient(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double step = at[i] != 0.0 ? kDerivativeStep * std::abs(at[i]) : kDerivativeStep;
    Parameters up = at;
    Parameters down = at;
    up[i] += step;
    down[i] -= step;
    gradient[static_cast<Eigen::Index>(i)] = (model(up, x) - model(down, x)) / (2.0 * step);
  }
  return gradient.dot(fit.covariance * gradient);
}

double interval_factor(const Experiment& fit) {
  const identification::ParameterEstimate& any = fit.estimates.front();
  return any.standard_error > 0.0 ? any.half_width / any.standard_error : 0.0;
}

// Adds the model's curve and the 95 % bands of the curve and of single readings. place maps model values to a
// point of the figure.
void add_fit(Figure& figure, const Experiment& fit, const Model& model, double from, double to,
             const std::string& label, const std::function<FigurePoint(double x, double y)>& place) {
  FigureSeries line{label, Mark::kLine, kFitColour, {}};
  FigureBand of_readings{"95 % of readings", kBandColour, {}, {}};
  FigureBand of_line{"95 % interval of the fit", "#a04000", {}, {}};
  const double factor = interval_factor(fit);
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double x = from + (to - from) * i / kCurvePoints;
    const double y = model(values(fit), x);
    const double own = variance(fit, model, x);
    const double reading = factor * std::sqrt(own + fit.residual_sd * fit.residual_sd);
    line.points.push_back(place(x, y));
    of_readings.low.push_back(place(x, y - reading));
    of_readings.high.push_back(place(x, y + reading));
    of_line.low.push_back(place(x, y - factor * std::sqrt(own)));
    of_line.high.push_back(place(x, y + factor * std::sqrt(own)));
  }
  figure.bands = {of_readings, of_line};
  figure.series.push_back(line);
}

// Adds readings in two series: those used by the fit, and outliers.
void add_readings(Figure& figure, const Experiment& fit, const std::vector<FigurePoint>& points,
                  const std::string& label) {
  FigureSeries taken{label, Mark::kDots, kReadingColour, {}};
  FigureSeries outliers{"outliers, left out", Mark::kCrosses, kOutlierColour, {}};
  for (std::size_t i = 0; i < points.size(); ++i)
    (fit.is_outlier(i) ? outliers : taken).points.push_back(points[i]);
  figure.series.push_back(taken);
  if (!outliers.points.empty()) figure.series.push_back(outliers);
}

std::array<double, 2> range_of(const std::vector<double>& numbers) {
  const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
  return {*low, *high};
}

// Groups rows of similar supply voltage, highest voltage first.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<double>& supply) {
  std::vector<std::size_t> order(supply.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return supply[a] > supply[b]; });
  const double span = supply[order.front()] - supply[order.back()];
  std::vector<std::vector<std::size_t>> groups = {{order.front()}};
  bool narrow = true;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (supply[order[i - 1]] - supply[order[i]] > 0.06 * span) groups.emplace_back();
    groups.back().push_back(order[i]);
    narrow = narrow && supply[groups.back().front()] - supply[order[i]] < kGroupWidth * supply[order.front()];
  }
  if (narrow && groups.size() <= kMostGroups) return groups;
  // The voltages have no gaps: makes groups of equal size.
  const std::size_t wanted = std::min(kUsualGroups, supply.size());
  groups.assign(wanted, {});
  for (std::size_t i = 0; i < order.size(); ++i) groups[i * wanted / order.size()].push_back(order[i]);
  return groups;
}

// Adds readings over throttle and the model's curve for each supply voltage.
void add_groups(Figure& figure, const Experiment& fit, const std::vector<double>& supply,
                const std::vector<double>& throttle, const std::vector<double>& reading,
                const std::function<double(double supply, double throttle)>& model) {
  const std::array<double, 2> throttles = range_of(throttle);
  FigureSeries outliers{"outliers, left out", Mark::kCrosses, kOutlierColour, {}};
  const std::vector<std::vector<std::size_t>> groups = groups_of(supply);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<double> supplies;
    FigureSeries dots{"", Mark::kDots, kGroupColours[g], {}};
    for (const std::size_t row : groups[g]) {
      supplies.push_back(supply[row]);
      (fit.is_outlier(row) ? outliers : dots).points.push_back({throttle[row], reading[row]});
    }
    const double middle = identification::median(supplies);
    dots.label = fmt::format("{:.3f} V", middle);
    FigureSeries line{"", Mark::kLine, kGroupColours[g], {}};
    for (int i = 0; i <= kCurvePoints; ++i) {
      const double delta = throttles[0] + (throttles[1] - throttles[0]) * i / kCurvePoints;
      line.points.push_back({delta, model(middle, delta)});
    }
    figure.series.push_back(line);
    figure.series.push_back(dots);
  }
  if (!outliers.points.empty()) figure.series.push_back(outliers);
}

CaptionedFigure square_law_figure(const std::vector<double>& speeds, const Experiment& fit,
                                  const char* caption, const char* y_label, const char* line_label) {
  CaptionedFigure out{caption, {}};
  Figure& figure = out.figure;
  figure.title = caption;
  figure.x_label = "rotor speed squared, \xce\xa9\xc2\xb2 (rad\xc2\xb2/s\xc2\xb2)";
  figure.y_label = y_label;
  std::vector<double> squares;
  std::vector<FigurePoint> points;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    squares.push_back(speeds[i] * speeds[i]);
    points.push_back({squares[i], fit.measured[i]});
  }
  const Model model = [](const Parameters& p, double square) { return p[0] * square; };
  add_fit(figure, fit, model, 0.0, range_of(squares)[1], line_label, [](double x, double y) {
    return FigurePoint{x, y};
  });
  add_readings(figure, fit, points, "readings");
  return out;
}

}  // namespace

std::vector<CaptionedFigure> esc_figures(const identification::EscData& data, const Experiment& fit) {
  const double gain = fit.estimates[0].value;
  const double offset = fit.estimates[1].value;
  CaptionedFigure over_throttle{"Fig. 2: steady motor voltage over throttle, for each supply voltage", {}};
  over_throttle.figure.title = over_throttle.caption;
  over_throttle.figure.x_label = "throttle \xce\xb4";
  over_throttle.figure.y_label = "motor voltage v_a (V)";
  add_groups(over_throttle.figure, fit, data.supply_voltage_v, data.throttle, data.motor_voltage_v,
             [&](double supply, double delta) {
               return std::sqrt(std::max(gain * supply * supply * delta + offset, 0.0));
             });

  CaptionedFigure line{"Fig. 3: motor voltage squared over v_s\xc2\xb2\xce\xb4, with the line of Eq. (9)",
                       {}};
  line.figure.title = line.caption;
  line.figure.x_label = "v_s\xc2\xb2\xce\xb4 (V\xc2\xb2)";
  line.figure.y_label = "v_a\xc2\xb2 (V\xc2\xb2)";
  std::vector<double> drives;
  std::vector<FigurePoint> points;
  for (std::size_t i = 0; i < data.throttle.size(); ++i) {
    drives.push_back(data.supply_voltage_v[i] * data.supply_voltage_v[i] * data.throttle[i]);
    points.push_back({drives[i], fit.measured[i]});
  }
  const Model model = [](const Parameters& p, double drive) { return p[0] * drive + p[1]; };
  add_fit(line.figure, fit, model, 0.0, range_of(drives)[1],
          fmt::format("{:.4f} v_s\xc2\xb2\xce\xb4 {:+.4f}", gain, offset), [](double x, double y) {
            return FigurePoint{x, y};
          });
  add_readings(line.figure, fit, points, "readings");
  return {over_throttle, line};
}

CaptionedFigure steady_motor_figure(const identification::SteadyMotorData& data, const Experiment& fit) {
  CaptionedFigure out{"Fig. 4: steady speed over motor voltage, with Eq. (22)", {}};
  out.figure.title = out.caption;
  out.figure.x_label = "motor voltage v_a (V)";
  out.figure.y_label = "rotor speed \xce\xa9 (rad/s)";
  const Model model = [](const Parameters& p, double speed) { return (p[0] + p[1] * speed) * speed; };
  std::vector<FigurePoint> points;
  for (std::size_t i = 0; i < data.speed_rad_s.size(); ++i)
    points.push_back({data.motor_voltage_v[i], data.speed_rad_s[i]});
  const std::array<double, 2> speeds = range_of(data.speed_rad_s);
  add_fit(out.figure, fit, model, std::max(0.0, speeds[0]), speeds[1],
          fmt::format("v_a = {:.4g} \xce\xa9 + {:.4g} \xce\xa9\xc2\xb2", fit.estimates[0].value,
                      fit.estimates[1].value),
          [](double speed, double voltage) {
            return FigurePoint{voltage, speed};
          });
  add_readings(out.figure, fit, points, "readings");
  return out;
}

CaptionedFigure thrust_figure(const identification::ThrustTorqueData& data, const Experiment& fit) {
  return square_law_figure(data.speed_rad_s, fit, "Fig. 6: thrust over speed squared, with Eq. (25)",
                           "thrust T (N)",
                           fmt::format("T = {:.5g} \xce\xa9\xc2\xb2", fit.estimates[0].value).c_str());
}

CaptionedFigure torque_figure(const identification::ThrustTorqueData& data, const Experiment& fit) {
  return square_law_figure(data.speed_rad_s, fit, "Fig. 7: torque over speed squared, with Eq. (26)",
                           "torque Q (N\xc2\xb7m)",
                           fmt::format("Q = {:.5g} \xce\xa9\xc2\xb2", fit.estimates[0].value).c_str());
}

CaptionedFigure motor_step_figure(const identification::MotorStepData& data,
                                  const identification::MotorStep& step) {
  CaptionedFigure out{"Step response of the speed, with both models and the 63.2 % reading", {}};
  Figure& figure = out.figure;
  figure.title = out.caption;
  figure.x_label = "time (s)";
  figure.y_label = "rotor speed \xce\xa9 (rad/s)";
  const Experiment& better = step.physical_fits_better ? step.physical : step.reduced;
  std::vector<FigurePoint> points;
  FigureSeries reduced{
      fmt::format("reduced, tau_m {:.4f} s", step.reduced.estimates[0].value), Mark::kLine, kFitColour, {}};
  FigureSeries physical{fmt::format("physical, tau_m {:.4f} s at hover", step.physical.estimates[0].value),
                        Mark::kDashes,
                        "#e67e22",
                        {}};
  for (std::size_t i = 0; i < data.time_s.size(); ++i) {
    points.push_back({data.time_s[i], data.speed_rad_s[i]});
    reduced.points.push_back({data.time_s[i], step.reduced.predicted[i]});
    physical.points.push_back({data.time_s[i], step.physical.predicted[i]});
  }
  const std::array<double, 2> speeds = range_of(better.predicted);
  const double read_at = step.step_time_s + step.reading.value;
  figure.series = {reduced, physical};
  figure.series.push_back({fmt::format("63.2 % after {:.4f} s", step.reading.value),
                           Mark::kDashes,
                           "#2e8b57",
                           {{read_at, speeds[0]},
                            {read_at, speeds[0] + 0.632 * (speeds[1] - speeds[0])},
                            {step.step_time_s, speeds[0] + 0.632 * (speeds[1] - speeds[0])}}});
  add_readings(figure, better, points, "readings");
  return out;
}

CaptionedFigure throttle_thrust_figure(const identification::ThrottleThrustData& data, const Experiment& fit,
                                       const plant::Vehicle& vehicle) {
  CaptionedFigure out{"Thrust of one rotor over throttle, with the chain of Eq. (9), (22) and (25)", {}};
  out.figure.title = out.caption;
  out.figure.x_label = "throttle \xce\xb4";
  out.figure.y_label = "thrust T (N)";
  add_groups(out.figure, fit, data.supply_voltage_v, data.throttle, data.thrust_n,
             [&](double supply, double delta) {
               return plant::steady_thrust_from_throttle(vehicle, supply, delta);
             });
  return out;
}

CaptionedFigure residual_figure(const Experiment& fit) {
  CaptionedFigure out{"Residuals in the order of the rows", {}};
  if (!fit.outliers.empty()) out.caption += "; crosses: outliers, clipped to the edge";
  Figure& figure = out.figure;
  figure.title = out.caption;
  figure.x_label = "row";
  figure.y_label = "measured \xe2\x88\x92 fitted (" + written_unit(fit.residual_unit) + ")";
  figure.zero_line = true;
  figure.height = 260;
  FigureSeries taken{"", Mark::kDots, kReadingColour, {}};
  FigureSeries outliers{"", Mark::kCrosses, kOutlierColour, {}};
  double largest = 0.0;
  for (std::size_t i = 0; i < fit.measured.size(); ++i) {
    if (fit.is_outlier(i)) continue;
    const double residual = fit.measured[i] - fit.predicted[i];
    largest = std::max(largest, std::abs(residual));
    taken.points.push_back({static_cast<double>(i + 1), residual});
  }
  for (const std::size_t row : fit.outliers) {
    const double edge = 1.5 * largest;
    outliers.points.push_back(
        {static_cast<double>(row + 1), std::clamp(fit.measured[row] - fit.predicted[row], -edge, edge)});
  }
  figure.series = {taken, outliers};
  return out;
}

std::string written_unit(const std::string& unit) {
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit.compare(i, 2, "^2") == 0) {
      out += "\xc2\xb2";
      ++i;
    } else if (unit[i] == '*') {
      out += "\xc2\xb7";
    } else {
      out += unit[i];
    }
  }
  return out;
}

}  // namespace swiftlet::ground
