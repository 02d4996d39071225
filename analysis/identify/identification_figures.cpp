#include "swiftlet/analysis/identify/identification_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include <fmt/core.h>

#include "swiftlet/analysis/identify/report_page.hpp"
#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::analysis {
namespace {

using identification::Experiment;
using plot::Colour;
using plot::Figure;
using plot::Panel;
using plot::Point;
using plot::Series;
using plot::Style;
using Terms = std::function<Eigen::VectorXd(double x)>;  // that the parameters of a linear model multiply

constexpr int kCurvePoints = 80;
constexpr std::size_t kMostGroups = 7;
constexpr std::size_t kUsualGroups = 5;
constexpr double kGroupWidth = 0.03;  // of the supply voltage, largest relative span of a group
constexpr std::array<Colour, kMostGroups> kGroupColours = {Colour::kBlue,   Colour::kOrange, Colour::kGreen,
                                                           Colour::kPurple, Colour::kOchre,  Colour::kTeal,
                                                           Colour::kBrown};
constexpr const char* kSpeed = "rotor speed \u03a9 (rad/s)";
constexpr const char* kThrottle = "throttle \u03b4";
constexpr const char* kMotorVoltage = "motor voltage v_a (V)";

double interval_factor(const Experiment& fit) {
  const identification::ParameterEstimate& any = fit.estimates.front();
  return any.standard_error > 0.0 ? any.half_width / any.standard_error : 0.0;
}

// Adds the model's curve and the 95 % bands of the curve and of single readings.
void add_fit(Panel& panel, const Experiment& fit, const Terms& terms, double from, double to,
             const std::string& label) {
  Series line{Style::kLine, Colour::kInk, label};
  Series of_readings{Style::kBand, Colour::kOchre, "95 % of readings"};
  Series of_line{Style::kBand, Colour::kRed, "95 % interval of the fit"};
  Eigen::VectorXd parameters(static_cast<Eigen::Index>(fit.estimates.size()));
  for (std::size_t i = 0; i < fit.estimates.size(); ++i)
    parameters[static_cast<Eigen::Index>(i)] = fit.estimates[i].value;
  for (const double side : {-1.0, 1.0}) {  // below the line from left to right, above it back
    for (int i = 0; i <= kCurvePoints; ++i) {
      const double x = from + (to - from) * (side < 0.0 ? i : kCurvePoints - i) / kCurvePoints;
      const Eigen::VectorXd at = terms(x);
      const double y = at.dot(parameters);
      const double variance = at.dot(fit.covariance * at);
      const double factor = side * interval_factor(fit);
      of_readings.points.push_back({x, y + factor * std::sqrt(variance + fit.residual_sd * fit.residual_sd)});
      of_line.points.push_back({x, y + factor * std::sqrt(variance)});
      if (side < 0.0) line.points.push_back({x, y});
    }
  }
  panel.series.insert(panel.series.end(), {of_readings, of_line, line});
}

Series outliers_series() { return {Style::kCrosses, Colour::kRed, "outliers, left out"}; }

// Adds readings in two series: those used by the fit, and outliers.
void add_readings(Panel& panel, const Experiment& fit, const std::vector<Point>& points) {
  Series taken{Style::kDots, Colour::kBlue, "readings"};
  Series outliers = outliers_series();
  for (std::size_t i = 0; i < points.size(); ++i)
    (fit.is_outlier(i) ? outliers : taken).points.push_back(points[i]);
  panel.series.insert(panel.series.end(), {taken, outliers});
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
void add_groups(Panel& panel, const Experiment& fit, const std::vector<double>& supply,
                const std::vector<double>& throttle, const std::vector<double>& reading,
                const std::function<double(double supply, double throttle)>& model) {
  const std::array<double, 2> throttles = range_of(throttle);
  Series outliers = outliers_series();
  const std::vector<std::vector<std::size_t>> groups = groups_of(supply);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<double> supplies;
    Series dots{Style::kDots, kGroupColours[g]};
    for (const std::size_t row : groups[g]) {
      supplies.push_back(supply[row]);
      (fit.is_outlier(row) ? outliers : dots).points.push_back({throttle[row], reading[row]});
    }
    const double middle = identification::median(supplies);
    dots.label = fmt::format("{:.3f} V", middle);
    Series line{Style::kLine, kGroupColours[g]};
    for (int i = 0; i <= kCurvePoints; ++i) {
      const double delta = throttles[0] + (throttles[1] - throttles[0]) * i / kCurvePoints;
      line.points.push_back({delta, model(middle, delta)});
    }
    panel.series.insert(panel.series.end(), {line, dots});
  }
  panel.series.push_back(outliers);
}

Figure square_law_figure(const std::vector<double>& speeds, const Experiment& fit, const std::string& caption,
                         const std::string& y_label, const char* symbol) {
  Figure out = plot::one_panel(caption, "rotor speed squared, \u03a9\u00b2 (rad\u00b2/s\u00b2)", y_label);
  std::vector<double> squares;
  for (const double speed : speeds) squares.push_back(speed * speed);
  add_fit(
      out.panels[0], fit, [](double square) { return Eigen::VectorXd::Constant(1, square); }, 0.0,
      range_of(squares)[1], fmt::format("{} = {:.5g} \u03a9\u00b2", symbol, fit.estimates[0].value));
  add_readings(out.panels[0], fit, plot::points(squares, fit.measured));
  return out;
}

}  // namespace

std::vector<Figure> esc_figures(const identification::EscData& data, const Experiment& fit) {
  const double gain = fit.estimates[0].value;
  const double offset = fit.estimates[1].value;
  Figure over_throttle = plot::one_panel(
      "Fig. 2: steady motor voltage over throttle, for each supply voltage", kThrottle, kMotorVoltage);
  add_groups(over_throttle.panels[0], fit, data.supply_voltage_v, data.throttle, data.motor_voltage_v,
             [&](double supply, double delta) {
               return std::sqrt(std::max(gain * supply * supply * delta + offset, 0.0));
             });

  Figure line =
      plot::one_panel("Fig. 3: motor voltage squared over v_s\u00b2\u03b4, with the line of Eq. (9)",
                      "v_s\u00b2\u03b4 (V\u00b2)", "v_a\u00b2 (V\u00b2)");
  std::vector<double> drives;
  for (std::size_t i = 0; i < data.throttle.size(); ++i)
    drives.push_back(data.supply_voltage_v[i] * data.supply_voltage_v[i] * data.throttle[i]);
  add_fit(
      line.panels[0], fit, [](double drive) { return Eigen::Vector2d(drive, 1.0); }, 0.0, range_of(drives)[1],
      fmt::format("{:.4f} v_s\u00b2\u03b4 {:+.4f}", gain, offset));
  add_readings(line.panels[0], fit, plot::points(drives, fit.measured));
  return {over_throttle, line};
}

Figure steady_motor_figure(const identification::SteadyMotorData& data, const Experiment& fit) {
  Figure out =
      plot::one_panel("Fig. 4: steady speed over motor voltage, with Eq. (22)", kMotorVoltage, kSpeed);
  const std::array<double, 2> speeds = range_of(data.speed_rad_s);
  add_fit(
      out.panels[0], fit, [](double speed) { return Eigen::Vector2d(speed, speed * speed); },
      std::max(0.0, speeds[0]), speeds[1],
      fmt::format("v_a = {:.4g} \u03a9 + {:.4g} \u03a9\u00b2", fit.estimates[0].value,
                  fit.estimates[1].value));
  for (Series& series : out.panels[0].series)  // Eq. (22) is a voltage over speed
    for (Point& point : series.points) std::swap(point.x, point.y);
  add_readings(out.panels[0], fit, plot::points(data.motor_voltage_v, data.speed_rad_s));
  return out;
}

Figure thrust_figure(const identification::ThrustTorqueData& data, const Experiment& fit) {
  return square_law_figure(data.speed_rad_s, fit, "Fig. 6: thrust over speed squared, with Eq. (25)",
                           "thrust T (N)", "T");
}

Figure torque_figure(const identification::ThrustTorqueData& data, const Experiment& fit) {
  return square_law_figure(data.speed_rad_s, fit, "Fig. 7: torque over speed squared, with Eq. (26)",
                           "torque Q (N\u00b7m)", "Q");
}

Figure motor_step_figure(const identification::MotorStepData& data, const identification::MotorStep& step) {
  Figure out = plot::one_panel("Step response of the speed, with both models and the 63.2 % reading",
                               "time (s)", kSpeed);
  const Experiment& better = step.physical_fits_better ? step.physical : step.reduced;
  const Series reduced{Style::kLine, Colour::kInk,
                       fmt::format("reduced, tau_m {:.4f} s", step.reduced.estimates[0].value),
                       plot::points(data.time_s, step.reduced.predicted)};
  const Series physical{Style::kDashes, Colour::kOrange,
                        fmt::format("physical, tau_m {:.4f} s at hover", step.physical.estimates[0].value),
                        plot::points(data.time_s, step.physical.predicted)};
  const std::array<double, 2> speeds = range_of(better.predicted);
  const double read_at_s = step.step_time_s + step.reading.value;
  const double read_speed = speeds[0] + 0.632 * (speeds[1] - speeds[0]);
  const Series reading{Style::kDashes,
                       Colour::kGreen,
                       fmt::format("63.2 % after {:.4f} s", step.reading.value),
                       {{read_at_s, speeds[0]}, {read_at_s, read_speed}, {step.step_time_s, read_speed}}};
  add_readings(out.panels[0], better, plot::points(data.time_s, data.speed_rad_s));
  out.panels[0].series.insert(out.panels[0].series.end(), {reduced, physical, reading});
  return out;
}

Figure throttle_thrust_figure(const identification::ThrottleThrustData& data, const Experiment& fit,
                              const plant::Vehicle& vehicle) {
  Figure out = plot::one_panel("Thrust of one rotor over throttle, with the chain of Eq. (9), (22) and (25)",
                               kThrottle, "thrust T (N)");
  add_groups(out.panels[0], fit, data.supply_voltage_v, data.throttle, data.thrust_n,
             [&](double supply, double delta) {
               return plant::steady_thrust_from_throttle(vehicle, supply, delta);
             });
  return out;
}

Figure residual_figure(const Experiment& fit) {
  Figure out =
      plot::one_panel(std::string("Residuals in the order of the rows") +
                          (fit.outliers.empty() ? "" : "; outliers are clipped to the edge"),
                      "row", "measured \u2212 fitted (" + written_unit(fit.residual_unit) + ")", 280);
  out.panels[0].zero_line = true;
  std::vector<Point> residuals;
  double largest = 0.0;
  for (std::size_t i = 0; i < fit.measured.size(); ++i) {
    residuals.push_back({static_cast<double>(i + 1), fit.measured[i] - fit.predicted[i]});
    if (!fit.is_outlier(i)) largest = std::max(largest, std::abs(residuals.back().y));
  }
  for (Point& residual : residuals) residual.y = std::clamp(residual.y, -1.5 * largest, 1.5 * largest);
  add_readings(out.panels[0], fit, residuals);
  return out;
}

}  // namespace swiftlet::analysis
