#include "swiftlet/ground/identify/identification_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include <fmt/core.h>

#include "swiftlet/ground/identify/report_page.hpp"
#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::ground {
namespace {

using identification::Experiment;
using plot::Colour;
using plot::Figure;
using plot::Panel;
using plot::Point;
using plot::Series;
using plot::Style;
using Parameters = std::vector<double>;
using Model = std::function<double(const Parameters&, double x)>;

constexpr int kCurvePoints = 80;
constexpr double kDerivativeStep = 1e-5;  // relative
constexpr std::size_t kMostGroups = 7;
constexpr std::size_t kUsualGroups = 5;
constexpr double kGroupWidth = 0.03;  // of the supply voltage, largest relative span of a group
constexpr std::array<Colour, kMostGroups> kGroupColours = {Colour::kBlue,   Colour::kOrange, Colour::kGreen,
                                                           Colour::kPurple, Colour::kOchre,  Colour::kTeal,
                                                           Colour::kBrown};
constexpr const char* kSpeed = "rotor speed \u03a9 (rad/s)";
constexpr const char* kThrottle = "throttle \u03b4";
constexpr const char* kMotorVoltage = "motor voltage v_a (V)";

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
void add_fit(
    Panel& panel, const Experiment& fit, const Model& model, double from, double to, const std::string& label,
    const std::function<Point(double x, double y)>& place = [](double x, double y) {
      return Point{x, y};
    }) {
  Series line{Style::kLine, Colour::kInk, label};
  Series of_readings{Style::kBand, Colour::kOchre, "95 % of readings"};
  Series of_line{Style::kBand, Colour::kRed, "95 % interval of the fit"};
  const double factor = interval_factor(fit);
  for (const double sign : {-1.0, 1.0}) {  // the lower side of the bands forward, the upper side back
    for (int i = 0; i <= kCurvePoints; ++i) {
      const double x = from + (to - from) * (sign < 0.0 ? i : kCurvePoints - i) / kCurvePoints;
      const double y = model(values(fit), x);
      const double own = variance(fit, model, x);
      const double reading = std::sqrt(own + fit.residual_sd * fit.residual_sd);
      of_readings.points.push_back(place(x, y + sign * factor * reading));
      of_line.points.push_back(place(x, y + sign * factor * std::sqrt(own)));
      if (sign < 0.0) line.points.push_back(place(x, y));
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
  Figure out = plot::captioned(caption, "rotor speed squared, \u03a9\u00b2 (rad\u00b2/s\u00b2)", y_label);
  double largest = 0.0;
  std::vector<Point> points;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    points.push_back({speeds[i] * speeds[i], fit.measured[i]});
    largest = std::max(largest, points.back().x);
  }
  const Model model = [](const Parameters& p, double square) { return p[0] * square; };
  add_fit(out.panels[0], fit, model, 0.0, largest,
          fmt::format("{} = {:.5g} \u03a9\u00b2", symbol, fit.estimates[0].value));
  add_readings(out.panels[0], fit, points);
  return out;
}

}  // namespace

std::vector<Figure> esc_figures(const identification::EscData& data, const Experiment& fit) {
  const double gain = fit.estimates[0].value;
  const double offset = fit.estimates[1].value;
  Figure over_throttle = plot::captioned(
      "Fig. 2: steady motor voltage over throttle, for each supply voltage", kThrottle, kMotorVoltage);
  add_groups(over_throttle.panels[0], fit, data.supply_voltage_v, data.throttle, data.motor_voltage_v,
             [&](double supply, double delta) {
               return std::sqrt(std::max(gain * supply * supply * delta + offset, 0.0));
             });

  Figure line =
      plot::captioned("Fig. 3: motor voltage squared over v_s\u00b2\u03b4, with the line of Eq. (9)",
                      "v_s\u00b2\u03b4 (V\u00b2)", "v_a\u00b2 (V\u00b2)");
  double largest = 0.0;
  std::vector<Point> points;
  for (std::size_t i = 0; i < data.throttle.size(); ++i) {
    points.push_back(
        {data.supply_voltage_v[i] * data.supply_voltage_v[i] * data.throttle[i], fit.measured[i]});
    largest = std::max(largest, points.back().x);
  }
  const Model model = [](const Parameters& p, double drive) { return p[0] * drive + p[1]; };
  add_fit(line.panels[0], fit, model, 0.0, largest,
          fmt::format("{:.4f} v_s\u00b2\u03b4 {:+.4f}", gain, offset));
  add_readings(line.panels[0], fit, points);
  return {over_throttle, line};
}

Figure steady_motor_figure(const identification::SteadyMotorData& data, const Experiment& fit) {
  Figure out =
      plot::captioned("Fig. 4: steady speed over motor voltage, with Eq. (22)", kMotorVoltage, kSpeed);
  const Model model = [](const Parameters& p, double speed) { return (p[0] + p[1] * speed) * speed; };
  std::vector<Point> points;
  for (std::size_t i = 0; i < data.speed_rad_s.size(); ++i)
    points.push_back({data.motor_voltage_v[i], data.speed_rad_s[i]});
  const std::array<double, 2> speeds = range_of(data.speed_rad_s);
  add_fit(out.panels[0], fit, model, std::max(0.0, speeds[0]), speeds[1],
          fmt::format("v_a = {:.4g} \u03a9 + {:.4g} \u03a9\u00b2", fit.estimates[0].value,
                      fit.estimates[1].value),
          [](double speed, double voltage) {
            return Point{voltage, speed};
          });
  add_readings(out.panels[0], fit, points);
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
  Figure out = plot::captioned("Step response of the speed, with both models and the 63.2 % reading",
                               "time (s)", kSpeed);
  const Experiment& better = step.physical_fits_better ? step.physical : step.reduced;
  std::vector<Point> points;
  Series reduced{Style::kLine, Colour::kInk,
                 fmt::format("reduced, tau_m {:.4f} s", step.reduced.estimates[0].value)};
  Series physical{Style::kDashes, Colour::kOrange,
                  fmt::format("physical, tau_m {:.4f} s at hover", step.physical.estimates[0].value)};
  for (std::size_t i = 0; i < data.time_s.size(); ++i) {
    points.push_back({data.time_s[i], data.speed_rad_s[i]});
    reduced.points.push_back({data.time_s[i], step.reduced.predicted[i]});
    physical.points.push_back({data.time_s[i], step.physical.predicted[i]});
  }
  const std::array<double, 2> speeds = range_of(better.predicted);
  const double read_at_s = step.step_time_s + step.reading.value;
  const double read_speed = speeds[0] + 0.632 * (speeds[1] - speeds[0]);
  add_readings(out.panels[0], better, points);
  out.panels[0].series.insert(out.panels[0].series.end(), {reduced, physical});
  out.panels[0].series.push_back(
      {Style::kDashes,
       Colour::kGreen,
       fmt::format("63.2 % after {:.4f} s", step.reading.value),
       {{read_at_s, speeds[0]}, {read_at_s, read_speed}, {step.step_time_s, read_speed}}});
  return out;
}

Figure throttle_thrust_figure(const identification::ThrottleThrustData& data, const Experiment& fit,
                              const plant::Vehicle& vehicle) {
  Figure out = plot::captioned("Thrust of one rotor over throttle, with the chain of Eq. (9), (22) and (25)",
                               kThrottle, "thrust T (N)");
  add_groups(out.panels[0], fit, data.supply_voltage_v, data.throttle, data.thrust_n,
             [&](double supply, double delta) {
               return plant::steady_thrust_from_throttle(vehicle, supply, delta);
             });
  return out;
}

Figure residual_figure(const Experiment& fit) {
  Figure out = plot::captioned(std::string("Residuals in the order of the rows") +
                                   (fit.outliers.empty() ? "" : "; crosses: outliers, clipped to the edge"),
                               "row", "measured \u2212 fitted (" + written_unit(fit.residual_unit) + ")");
  out.height = 260;
  out.panels[0].zero_line = true;
  Series taken{Style::kDots, Colour::kBlue};
  Series outliers{Style::kCrosses, Colour::kRed};
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
  out.panels[0].series = {taken, outliers};
  return out;
}

}  // namespace swiftlet::ground
