#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/smoothing_spline.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/missions/sample_times.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::io {
namespace {

using control::PositionYaw;
using control::SplineSample;

// Half of the last digit counts within these bounds: numbers such as 1 or 0.5 are meant exactly, and no vehicle
// tells a tenth of a micrometre.
constexpr double kLeastTolerance_m = 1e-7, kMostTolerance_m = 5e-4;
constexpr double kLeastTolerance_rad = 1e-6, kMostTolerance_rad = 1e-2;
// Velocities and accelerations were often differenced from the positions: their tolerances are wider.
constexpr double kLeastTolerance_m_s = 1e-3, kLeastTolerance_m_s2 = 1e-2;
// Positions at this rate determine the motion. Below, the path also follows velocities and accelerations.
constexpr double kSlowSamples_hz = 20.0;
constexpr double kStep = 3.0;  // of the greatest speed: above, a row is no motion but a step

// What a table gives besides times and positions.
struct Given {
  bool velocity = false;
  bool acceleration = false;
  bool yaw = false;
};

Given given_in(const MotionColumns& columns, const std::string& file_name) {
  if (!columns.has(Motion::kX) && columns.has_any({Motion::kVx, Motion::kAx, Motion::kRoll, Motion::kP})) {
    throw io::ConfigError(file_name, 1, "header",
                          "has no positions, must have " + list_of({Motion::kX, Motion::kY, Motion::kZ}) +
                              "; `swiftlet stream` flies velocities, accelerations, attitudes and "
                              "body rates");
  }
  require_columns(columns, file_name, "a trajectory", {Motion::kT, Motion::kX, Motion::kY, Motion::kZ},
                  {{Motion::kVx, Motion::kVy, Motion::kVz},
                   {Motion::kAx, Motion::kAy, Motion::kAz},
                   {Motion::kYaw},
                   {Motion::kYawRate}});
  return {columns.has(Motion::kVx), columns.has(Motion::kAx), columns.has(Motion::kYaw)};
}

// The samples in NED, one entry per row.
struct Samples {
  SampleTimes times;
  std::vector<PositionYaw> places;
  std::vector<PositionYaw> tolerances;         // of the places
  std::vector<Eigen::Vector3d> velocities;     // if given
  std::vector<Eigen::Vector3d> accelerations;  // if given
  std::size_t first_row = 0;                   // of the table

  std::size_t size() const { return places.size(); }
};

// Half of the last digit of three columns of a row, in NED and SI units.
Eigen::Vector3d rounding_of(const Table& table, std::size_t row, const MotionColumns& columns, Motion x) {
  Eigen::Vector3d rounding;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t column = *columns.index(static_cast<Motion>(static_cast<int>(x) + axis));
    rounding[axis] = 0.5 * columns.factor(column) * table.last_digit(row, column);
  }
  return ned_from(columns.frame(), rounding).cwiseAbs();
}

PositionYaw tolerance_of(const Table& table, std::size_t row, const MotionColumns& columns,
                         const std::optional<double>& tolerance_m) {
  if (tolerance_m) return PositionYaw::Constant(*tolerance_m);
  PositionYaw tolerance = PositionYaw::Constant(kLeastTolerance_rad);
  tolerance.head<3>() =
      rounding_of(table, row, columns, Motion::kX).cwiseMax(kLeastTolerance_m).cwiseMin(kMostTolerance_m);
  if (const auto yaw = columns.index(Motion::kYaw))
    tolerance[3] = std::clamp(0.5 * columns.factor(*yaw) * table.last_digit(row, *yaw), kLeastTolerance_rad,
                              kMostTolerance_rad);
  return tolerance;
}

// Without a unit, a yaw beyond a full turn may be in degrees.
void require_clear_yaw(const Table& table, std::size_t row, const MotionColumns& columns) {
  const auto yaw = columns.index(Motion::kYaw);
  if (!yaw || columns.declares_units() || std::abs(table.number(row, *yaw)) <= 2.0 * M_PI) return;
  table.fail(
      row, "yaw",
      fmt::format(
          "is {:g}, more than a full turn in rad: degrees, or several turns? Units in the header say "
          "which, or --frame enu --columns \"t [s],x,y,z,yaw [deg]\" or ...yaw [rad], with all columns "
          "of the file",
          table.number(row, *yaw)));
}

Samples read(const Table& table, const MotionColumns& columns, const Given& given,
             const std::optional<double>& tolerance_m) {
  Samples samples;
  const std::size_t t = *columns.index(Motion::kT);
  samples.times = sample_times(table, t, columns.factor(t));
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::vector<double> numbers = table.row(row);
    require_clear_yaw(table, row, columns);
    PositionYaw place;
    place.head<3>() = columns.ned(numbers, Motion::kX);
    place[3] = given.yaw ? columns.yaw_ned(numbers) : 0.0;
    if (row > 0) {  // unwrapped: less than half a turn between rows
      const double before = samples.places.back()[3];
      place[3] = before + std::remainder(place[3] - before, 2.0 * M_PI);
    }
    samples.places.push_back(place);
    samples.tolerances.push_back(tolerance_of(table, row, columns, tolerance_m));
    if (given.velocity) samples.velocities.push_back(columns.ned(numbers, Motion::kVx));
    if (given.acceleration) samples.accelerations.push_back(columns.ned(numbers, Motion::kAx));
  }
  return samples;
}

// Keeps the samples within these times.
void cut(Samples& samples, const FileOptions& options, const std::string& file_name) {
  if (!options.from_s && !options.until_s) return;
  std::vector<double>& time_s = samples.times.time_s;
  constexpr double kSameTime_s = 1e-9;
  const double from_s = options.from_s.value_or(time_s.front());
  const double until_s = options.until_s.value_or(time_s.back());
  const auto begin = std::lower_bound(time_s.begin(), time_s.end(), from_s - kSameTime_s) - time_s.begin();
  const auto end = std::upper_bound(time_s.begin(), time_s.end(), until_s + kSameTime_s) - time_s.begin();
  if (end - begin < 2)
    throw io::ConfigError(
        file_name, 0, "",
        fmt::format("has {} samples from {:g} to {:g} s, must have at least 2: its last is at {:g} s",
                    std::max<std::ptrdiff_t>(end - begin, 0), from_s, until_s, time_s.back()));
  const auto keep = [begin, end](auto& list) {
    if (!list.empty()) list = {list.begin() + begin, list.begin() + end};
  };
  keep(time_s);
  keep(samples.places);
  keep(samples.tolerances);
  keep(samples.velocities);
  keep(samples.accelerations);
  samples.first_row += static_cast<std::size_t>(begin);
  const double start_s = time_s.front();
  for (double& t_s : time_s) t_s -= start_s;
}

// Stamps that are rounded and not even move each place along the path.
void allow_for_rounded_stamps(Samples& samples) {
  if (samples.times.rounding_s <= 0.0) return;
  const std::vector<double>& time_s = samples.times.time_s;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0;
    const std::size_t after = std::min(i + 1, samples.size() - 1);
    const PositionYaw rate =
        (samples.places[after] - samples.places[before]) / (time_s[after] - time_s[before]);
    samples.tolerances[i] += samples.times.rounding_s * rate.cwiseAbs();
  }
}

// Flies the samples so many times as slow. step_s stays that of the file.
void scale_time(Samples& samples, double factor) {
  for (double& t_s : samples.times.time_s) t_s *= factor;
  samples.times.rounding_s *= factor;
  for (Eigen::Vector3d& velocity : samples.velocities) velocity /= factor;
  for (Eigen::Vector3d& acceleration : samples.accelerations) acceleration /= factor * factor;
}

// Refuses places that no vehicle reaches in time, by their row: steps in the file.
void require_reachable(const Table& table, const Samples& samples, double scale,
                       const control::Limits& limits) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step_s = samples.times.time_s[i] - samples.times.time_s[i - 1];
    const double step_m = scale * (samples.places[i] - samples.places[i - 1]).head<3>().norm();
    const double spare_m = scale * (samples.tolerances[i] + samples.tolerances[i - 1]).head<3>().norm();
    if (step_m - spare_m <= kStep * limits.max_speed * step_s) continue;
    table.fail(
        samples.first_row + i, "",
        fmt::format("is {:.3f} m from the row before, {:.4g} s earlier: {:.2f} m/s, the limit is {:.2f} "
                    "m/s",
                    step_m, step_s, step_m / step_s, limits.max_speed));
  }
}

std::vector<SplineSample> spline_samples(const Table& table, const MotionColumns& columns,
                                         const Samples& samples, bool with_derivatives, double widened) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<SplineSample> out;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t_s = samples.times.time_s[i];
    const auto add = [&](int derivative, const Eigen::Vector3d& value, Motion x, double least) {
      SplineSample sample{t_s, derivative, PositionYaw::Zero(), PositionYaw::Constant(kNone)};
      sample.value.head<3>() = value;
      sample.tolerance.head<3>() = rounding_of(table, samples.first_row + i, columns, x).cwiseMax(least);
      out.push_back(sample);
    };
    const bool last = i + 1 == samples.size();
    if (with_derivatives && !samples.accelerations.empty() && last)
      add(2, samples.accelerations[i], Motion::kAx, kLeastTolerance_m_s2);
    if (with_derivatives && !samples.velocities.empty() && last)
      add(1, samples.velocities[i], Motion::kVx, kLeastTolerance_m_s);
    out.push_back({t_s, 0, samples.places[i], widened * samples.tolerances[i]});
    if (with_derivatives && !samples.velocities.empty() && !last)
      add(1, samples.velocities[i], Motion::kVx, kLeastTolerance_m_s);
    if (with_derivatives && !samples.accelerations.empty() && !last)
      add(2, samples.accelerations[i], Motion::kAx, kLeastTolerance_m_s2);
  }
  return out;
}

// The path, and by how much its tolerances were widened for it to have no more segments than fit.
struct Fit {
  std::vector<control::PolynomialSegment> segments;
  double widened = 1.0;
};

Fit fit(const Table& table, const MotionColumns& columns, const Samples& samples, bool with_derivatives,
        bool may_widen) {
  constexpr double kAtRest_m_s = control::kJoin_m_s;
  const bool rests = samples.velocities.empty() || samples.velocities.back().norm() <= kAtRest_m_s;
  double least_m = kMostTolerance_m;
  for (const PositionYaw& tolerance : samples.tolerances)
    least_m = std::min(least_m, tolerance.head<3>().minCoeff());
  Fit out;
  while (true) {
    control::SmoothedPath path =
        control::smoothing_spline(spline_samples(table, columns, samples, with_derivatives, out.widened),
                                  rests, control::kMaxTrajectorySegments);
    if (path.tolerance_use <= control::kSmoothingPrecision) {
      out.segments = std::move(path.segments);
      return out;
    }
    const double needed = out.widened * std::max(2.0, path.tolerance_use);
    if (!may_widen || needed * least_m > kMostTolerance_m) {
      throw io::ConfigError(
          table.file(), 0, "",
          fmt::format(
              "no path of {} segments passes all samples within {:.2g} m: the samples are noisy, or too "
              "many for one path; --tolerance {:.1g} lets it pass by further",
              control::kMaxTrajectorySegments, out.widened * least_m, 2.0 * needed * least_m));
    }
    out.widened = needed;
  }
}

// What the path makes of the samples.
struct Comparison {
  double place_m = 0.0;       // greatest distance
  double velocity_m_s = 0.0;  // greatest difference from the given one
  double acceleration_m_s2 = 0.0;
  std::size_t velocity_row = 0, acceleration_row = 0;
};

Comparison compare(const Samples& samples, const std::vector<control::PolynomialSegment>& segments) {
  Comparison out;
  std::size_t segment = 0;
  double begin_s = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t_s = samples.times.time_s[i];
    while (segment + 1 < segments.size() && t_s > begin_s + segments[segment].duration_s)
      begin_s += segments[segment++].duration_s;
    const control::Reference at = control::evaluate(segments[segment], t_s - begin_s);
    out.place_m = std::max(out.place_m, (at.position_ned - samples.places[i].head<3>()).norm());
    const auto note = [i](const std::vector<Eigen::Vector3d>& given, const Eigen::Vector3d& value,
                          double& greatest, std::size_t& row) {
      if (given.empty() || (value - given[i]).norm() <= greatest) return;
      greatest = (value - given[i]).norm();
      row = i;
    };
    note(samples.velocities, at.velocity_ned, out.velocity_m_s, out.velocity_row);
    note(samples.accelerations, at.acceleration_ned, out.acceleration_m_s2, out.acceleration_row);
  }
  return out;
}

std::string length_text(double length_m) {
  return length_m < 1e-4 ? fmt::format("{:.2f} um", length_m * 1e6)
                         : fmt::format("{:.2f} mm", length_m * 1e3);
}

// The columns that the path is made of.
std::string columns_used(const MotionColumns& columns, bool with_derivatives) {
  std::string text;
  for (const Motion column : columns.all()) {
    const bool derivative = column >= Motion::kVx && column <= Motion::kAz;
    if (column == Motion::kYawRate || (derivative && !with_derivatives)) continue;
    text += (text.empty() ? "" : ", ") + name_of(column);
  }
  return text;
}

void say(const Table& table, const MotionColumns& columns, const Samples& samples, const Fit& fit,
         bool with_derivatives, std::vector<std::string>& assumptions) {
  const Comparison comparison = compare(samples, fit.segments);
  assumptions.insert(assumptions.end(), samples.times.remarks.begin(), samples.times.remarks.end());
  assumptions.push_back(fmt::format("{} samples at {} became {} segments; largest deviation {}",
                                    samples.size(), samples.times.rate(), fit.segments.size(),
                                    length_text(comparison.place_m)));
  if (fit.widened > 1.0)
    assumptions.push_back(
        fmt::format("half of the last digit would need more than {} segments: the deviation is up to "
                    "{:.3g} times that",
                    control::kMaxTrajectorySegments, fit.widened));
  assumptions.push_back("the path is made of the columns " + columns_used(columns, with_derivatives));
  if (samples.velocities.empty() && samples.accelerations.empty()) return;
  std::string text;
  if (!samples.velocities.empty())
    text += fmt::format("its velocity differs from vx, vy, vz by up to {:.3g} m/s (line {})",
                        comparison.velocity_m_s, table.line(samples.first_row + comparison.velocity_row));
  if (!samples.accelerations.empty())
    text += fmt::format("{}its acceleration differs from ax, ay, az by up to {:.3g} m/s^2 (line {})",
                        text.empty() ? "" : ", ", comparison.acceleration_m_s2,
                        table.line(samples.first_row + comparison.acceleration_row));
  assumptions.push_back(text);
}

// The speed at one end of samples without velocities, if it is more than their rounding, and a start from rest between them, explain:
// step is 1 at the first and -1 at the last sample.
std::optional<double> speed_at(const Samples& samples, std::size_t end, int step,
                               const control::Limits& limits, double scale) {
  constexpr double kUnnoticed_m_s = 0.05;
  if (samples.size() < 3) return std::nullopt;
  const auto sample = [&](int i) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(end) + std::ptrdiff_t{i} * step);
  };
  const auto& [time_s, places] = std::tie(samples.times.time_s, samples.places);
  const double before_s = std::abs(time_s[sample(1)] - time_s[sample(0)]);
  const double behind_s = std::abs(time_s[sample(2)] - time_s[sample(0)]);
  const Eigen::Vector3d near = (places[sample(1)] - places[sample(0)]).head<3>() / before_s;
  const Eigen::Vector3d far = (places[sample(2)] - places[sample(0)]).head<3>() / behind_s;
  // Second order: exact at constant acceleration.
  const double speed = scale * ((behind_s * near - before_s * far) / (behind_s - before_s)).norm();
  const double rounding = 4.0 * scale * samples.tolerances[end].head<3>().norm() / before_s;
  const double explained = kUnnoticed_m_s + rounding + behind_s * before_s * limits.max_reference_jerk / 6.0;
  return speed > explained ? std::optional(speed) : std::nullopt;
}

// The row of the table of the last sample at or before the start of a segment.
std::size_t row_of(const Samples& samples, const std::vector<control::PolynomialSegment>& segments,
                   std::size_t segment) {
  double begin_s = 0.0;
  for (std::size_t i = 0; i < segment; ++i) begin_s += segments[i].duration_s;
  const auto after =
      std::upper_bound(samples.times.time_s.begin(), samples.times.time_s.end(), begin_s + 1e-9);
  return samples.first_row + static_cast<std::size_t>(after - samples.times.time_s.begin()) - 1;
}

// What the fit of samples without velocities cannot do near their ends; empty if it is something else. row: of the fault.
std::string motion_at_end(const Samples& samples, std::size_t row, const control::Limits& limits,
                          double scale) {
  constexpr double kNear_s = 0.5;
  const std::vector<double>& time_s = samples.times.time_s;
  const double at_s = time_s[row - samples.first_row];
  if (const auto speed = speed_at(samples, 0, 1, limits, scale); speed && at_s - time_s.front() < kNear_s)
    return fmt::format("the path starts at about {:.2f} m/s, must start at rest", *speed);
  const std::size_t last = samples.size() - 1;
  if (const auto speed = speed_at(samples, last, -1, limits, scale); speed && time_s.back() - at_s < kNear_s)
    return fmt::format("the path ends at about {:.2f} m/s, must end at rest", *speed);
  return "";
}

}  // namespace

TrajectoryFile read_samples(const Table& table, const control::Limits& limits, const FileOptions& options) {
  const MotionColumns columns(table.columns(), table.file(), options.frame);
  const Given given = given_in(columns, table.file());
  table.require_rows(2);
  Samples samples = read(table, columns, given, options.tolerance_m);
  cut(samples, options, table.file());
  std::vector<std::string> assumptions;
  if (const auto assumption = columns.assumption("a sampled trajectory")) assumptions.push_back(*assumption);
  if (!given.yaw) assumptions.emplace_back("the file has no yaw: the vehicle faces north");
  if (columns.has(Motion::kYawRate))
    assumptions.emplace_back("yaw_rate is not used: the rate follows from the yaw");
  Heights heights;
  for (const PositionYaw& place : samples.places) heights.add(place.z());
  const double raise_m =
      raise_by(heights, {columns.frame(), columns.frame_is_assumed()}, table.file(), assumptions);
  for (PositionYaw& place : samples.places) place.z() -= raise_m;

  if (given.velocity && samples.velocities.front().norm() > control::kJoin_m_s)
    table.fail(
        samples.first_row, "",
        fmt::format("the path starts at {:.2f} m/s, must start at rest", samples.velocities.front().norm()));
  scale_time(samples, options.time_scale);
  require_reachable(table, samples, options.placement.scale, limits);
  allow_for_rounded_stamps(samples);
  const bool with_derivatives =
      (given.velocity || given.acceleration) && 1.0 / samples.times.step_s < kSlowSamples_hz;
  Fit path = fit(table, columns, samples, with_derivatives, !options.tolerance_m);
  say(table, columns, samples, path, with_derivatives, assumptions);
  for (control::PolynomialSegment& segment : path.segments) segment = options.placement.segment(segment);
  const std::vector<control::PolynomialSegment> segments = path.segments;
  return checked({std::move(path.segments), std::move(assumptions)}, columns.frame(), limits, options,
                 [&](const PathFault& fault) {
                   const std::size_t row = row_of(samples, segments, fault.segment);
                   const std::string motion =
                       given.velocity ? "" : motion_at_end(samples, row, limits, options.placement.scale);
                   table.fail(row, "", motion.empty() ? fault.sentence() : motion + ": " + fault.reason);
                 });
}

}  // namespace swiftlet::io
