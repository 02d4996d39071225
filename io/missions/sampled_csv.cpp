#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/control/planning/spline.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flight_csv.hpp"
#include "swiftlet/io/missions/flight_table.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::ground {
namespace {

using control::PlaceDerivatives;
using control::PositionYaw;

constexpr double kLeastStep_s = 1e-4;
constexpr double kLongestStep_s = 3600.0;

// What a table gives besides times and positions.
struct Given {
  bool velocity = false;
  bool acceleration = false;  // only with velocities
  bool yaw = false;
};

Given given_in(const MotionColumns& columns, const std::string& file_name) {
  if (!columns.has(Motion::kX) && columns.has_any({Motion::kVx, Motion::kAx, Motion::kRoll, Motion::kP})) {
    throw runtime::ConfigError(file_name, 1, "header",
                               "has no positions, must have " +
                                   list_of({Motion::kX, Motion::kY, Motion::kZ}) +
                                   "; `swiftlet stream` flies velocities, accelerations, attitudes and "
                                   "body rates");
  }
  require_columns(columns, file_name, "a trajectory", {Motion::kT, Motion::kX, Motion::kY, Motion::kZ},
                  {{Motion::kVx, Motion::kVy, Motion::kVz},
                   {Motion::kAx, Motion::kAy, Motion::kAz},
                   {Motion::kYaw},
                   {Motion::kYawRate}});
  const bool velocity = columns.has(Motion::kVx);
  return {velocity, velocity && columns.has(Motion::kAx), columns.has(Motion::kYaw)};
}

// In NED, one entry per row.
struct Samples {
  std::vector<double> time_s;
  std::vector<PositionYaw> places;
  std::vector<PlaceDerivatives> derivatives;  // velocity and acceleration, as far as they are known
};

// The time of a row, s.
double time_of(const runtime::CsvTable& table, std::size_t row, const MotionColumns& columns,
               const Samples& before) {
  const std::size_t column = *columns.index(Motion::kT);
  const double factor = columns.factor(column);
  if (row == 0) return factor * table.number(row, column);
  const double last_s = before.time_s.back();
  return factor *
         table.number(row, column,
                      runtime::between((last_s + kLeastStep_s) / factor, (last_s + kLongestStep_s) / factor),
                      factor == 1.0 ? "s" : "");
}

Samples read(const runtime::CsvTable& table, const MotionColumns& columns, const Given& given) {
  Samples samples;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    samples.time_s.push_back(time_of(table, row, columns, samples));
    const std::vector<double> numbers = table.row(row);
    PositionYaw place;
    place.head<3>() = columns.ned(numbers, Motion::kX);
    place[3] = given.yaw ? columns.yaw_ned(numbers) : 0.0;
    if (row > 0) {  // unwrapped: less than half a turn between rows
      const double before = samples.places.back()[3];
      place[3] = before + std::remainder(place[3] - before, 2.0 * M_PI);
    }
    samples.places.push_back(place);
    PlaceDerivatives derivatives = PlaceDerivatives::Zero();
    if (given.velocity) derivatives.col(0).head<3>() = columns.ned(numbers, Motion::kVx);
    if (given.acceleration) derivatives.col(1).head<3>() = columns.ned(numbers, Motion::kAx);
    samples.derivatives.push_back(derivatives);
  }
  return samples;
}

// Fills in derivatives that the file does not give by central differences over the neighbouring rows; they
// stay zero at both ends.
void difference(Samples& samples, const Given& given) {
  const std::size_t last = samples.places.size() - 1;
  for (std::size_t i = 1; i < last; ++i) {
    const double span_s = samples.time_s[i + 1] - samples.time_s[i - 1];
    PlaceDerivatives& here = samples.derivatives[i];
    if (!given.acceleration) {
      here.col(1).head<3>() =
          (samples.derivatives[i + 1].col(0) - samples.derivatives[i - 1].col(0)).head<3>() / span_s;
    }
    here(3, 0) = (samples.places[i + 1][3] - samples.places[i - 1][3]) / span_s;
  }
}

// Returns the rows at which segments begin or end: all rows, or evenly spaced ones if there are too many.
std::vector<std::size_t> knots_of(std::size_t rows) {
  const std::size_t most = control::kMaxTrajectorySegments;
  const std::size_t segments = std::min(rows - 1, most);
  std::vector<std::size_t> knots;
  for (std::size_t i = 0; i <= segments; ++i) knots.push_back(i * (rows - 1) / segments);
  return knots;
}

std::vector<control::PolynomialSegment> through(const Samples& samples, const std::vector<std::size_t>& knots,
                                                bool known_derivatives) {
  std::vector<PositionYaw> places;
  std::vector<double> durations;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    places.push_back(samples.places[knots[i]]);
    if (i > 0) durations.push_back(samples.time_s[knots[i]] - samples.time_s[knots[i - 1]]);
  }
  if (!known_derivatives) return control::spline(control::Smoothness::kMinimumSnap, places, durations);
  std::vector<control::PolynomialSegment> segments;
  for (std::size_t i = 0; i < durations.size(); ++i) {
    segments.push_back(control::spline(control::Smoothness::kMinimumJerk, {places[i], places[i + 1]},
                                       {durations[i]}, samples.derivatives[knots[i]],
                                       samples.derivatives[knots[i + 1]])
                           .front());
  }
  return segments;
}

double greatest_deviation(const Samples& samples, const std::vector<std::size_t>& knots,
                          const std::vector<control::PolynomialSegment>& segments) {
  double greatest = 0.0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (std::size_t row = knots[i]; row <= knots[i + 1]; ++row) {
      const double t_s = samples.time_s[row] - samples.time_s[knots[i]];
      const Eigen::Vector3d there = control::evaluate(segments[i], t_s).position_ned;
      greatest = std::max(greatest, (there - samples.places[row].head<3>()).norm());
    }
  }
  return greatest;
}

}  // namespace

TrajectoryFile read_sampled_csv(const std::string& text, const std::string& file_name,
                                const control::Limits& limits, std::optional<MissionFrame> frame) {
  std::vector<std::string> header = table_header(text, file_name);
  std::optional<runtime::CsvTable> recorded;
  if (runtime::is_flight_csv(header)) {
    recorded = reference_of_flight(text, file_name);
    header = recorded->columns();
  }
  const MotionColumns columns(header, file_name, frame);
  const Given given = given_in(columns, file_name);
  const runtime::CsvTable table =
      recorded ? *recorded : runtime::parse_csv(text, file_name, header, 2, {true, true});
  Samples samples = read(table, columns, given);
  std::vector<std::string> assumptions;
  if (recorded) assumptions.push_back(extent_of(table));
  if (const auto assumption = columns.assumption("a sampled trajectory")) assumptions.push_back(*assumption);
  if (!given.yaw) assumptions.emplace_back("the file has no yaw: the vehicle faces north");
  if (columns.has(Motion::kYawRate))
    assumptions.emplace_back("yaw_rate is not used: the rate follows from the yaw");
  if (columns.has(Motion::kAx) && !given.acceleration)
    assumptions.emplace_back("accelerations are not used, because the file has no velocities");
  Heights heights;
  for (const PositionYaw& place : samples.places) heights.add(place.z());
  const double raise_m = raise_by(heights, columns.frame(), file_name, assumptions);
  for (PositionYaw& place : samples.places) place.z() -= raise_m;

  if (given.velocity) difference(samples, given);
  const std::vector<std::size_t> knots = knots_of(table.row_count());
  std::vector<control::PolynomialSegment> segments = through(samples, knots, given.velocity);
  assumptions.push_back(fmt::format("{} samples became {} segments {}; the largest deviation is {:.1f} mm",
                                    table.row_count(), segments.size(),
                                    given.acceleration ? "with their velocities and accelerations"
                                    : given.velocity   ? "with their velocities"
                                                       : "of minimum snap, at rest at both ends",
                                    greatest_deviation(samples, knots, segments) * 1e3));
  return checked(
      {std::move(segments), std::move(assumptions)}, limits,
      [&](std::size_t segment, const std::string& fault) { table.fail(knots[segment], "", fault); });
}

}  // namespace swiftlet::ground
