#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/control/planning/spline.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::ground {
namespace {

using control::PlaceDerivatives;
using control::PositionYaw;

constexpr double kLeastStep_s = 1e-4;
constexpr double kLongestStep_s = 3600.0;

struct Columns {
  std::vector<std::string> names = {"t", "x", "y", "z"};
  bool velocity = false;
  bool acceleration = false;
  bool yaw = false;
};

// Returns the columns of the header. For an unsupported header, returns the nearest supported columns;
// parse_csv() then refuses the header.
Columns columns_of(const std::vector<std::string>& header) {
  const auto has = [&](const char* name) {
    return std::find(header.begin(), header.end(), name) != header.end();
  };
  Columns columns;
  const auto add = [&](std::initializer_list<const char*> names) {
    columns.names.insert(columns.names.end(), names.begin(), names.end());
  };
  columns.acceleration = has("ax");
  columns.velocity = has("vx") || columns.acceleration;
  columns.yaw = has("yaw");
  if (columns.velocity) add({"vx", "vy", "vz"});
  if (columns.acceleration) add({"ax", "ay", "az"});
  if (columns.yaw) add({"yaw"});
  return columns;
}

// In NED, one entry per row.
struct Samples {
  std::vector<double> time_s;
  std::vector<PositionYaw> places;
  std::vector<PlaceDerivatives> derivatives;  // velocity and acceleration, as far as they are known
};

Eigen::Vector3d ned_of(const runtime::CsvTable& table, std::size_t row, std::size_t column) {
  return ned_position(
      {table.number(row, column), table.number(row, column + 1), table.number(row, column + 2)});
}

Samples read(const runtime::CsvTable& table, const Columns& columns) {
  Samples samples;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double t = row == 0 ? table.number(row, 0)
                              : table.number(row, 0,
                                             runtime::between(samples.time_s.back() + kLeastStep_s,
                                                              samples.time_s.back() + kLongestStep_s),
                                             "s");
    samples.time_s.push_back(t);
    PositionYaw place;
    place.head<3>() = ned_of(table, row, 1);
    place[3] = columns.yaw ? ned_yaw(table.number(row, columns.names.size() - 1)) : 0.0;
    if (row > 0) {  // unwrapped: less than half a turn between rows
      const double before = samples.places.back()[3];
      place[3] = before + std::remainder(place[3] - before, 2.0 * M_PI);
    }
    samples.places.push_back(place);
    PlaceDerivatives derivatives = PlaceDerivatives::Zero();
    if (columns.velocity) derivatives.col(0).head<3>() = ned_of(table, row, 4);
    if (columns.acceleration) derivatives.col(1).head<3>() = ned_of(table, row, 7);
    samples.derivatives.push_back(derivatives);
  }
  return samples;
}

// Fills in derivatives that the file does not give by central differences over the neighbouring rows; they
// stay zero at both ends.
void difference(Samples& samples, const Columns& columns) {
  const std::size_t last = samples.places.size() - 1;
  for (std::size_t i = 1; i < last; ++i) {
    const double span_s = samples.time_s[i + 1] - samples.time_s[i - 1];
    PlaceDerivatives& here = samples.derivatives[i];
    if (!columns.acceleration) {
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
                                const control::Limits& limits) {
  const Columns columns = columns_of(runtime::first_csv_line(text, file_name));
  const runtime::CsvTable table = runtime::parse_csv(text, file_name, columns.names, 2, {true, true});
  Samples samples = read(table, columns);
  std::vector<std::string> assumptions = {
      "taken as a sampled trajectory in ENU: m, rad and s, from the origin of motion capture"};
  if (!columns.yaw) assumptions.emplace_back("the file has no yaw: the vehicle faces north");
  double least_m = -samples.places.front().z();
  for (const PositionYaw& place : samples.places) least_m = std::min(least_m, -place.z());
  const double raise_m = raise_by(least_m, assumptions);
  for (PositionYaw& place : samples.places) place.z() -= raise_m;

  if (columns.velocity) difference(samples, columns);
  const std::vector<std::size_t> knots = knots_of(table.row_count());
  std::vector<control::PolynomialSegment> segments = through(samples, knots, columns.velocity);
  assumptions.push_back(fmt::format("{} samples became {} segments {}; the largest deviation is {:.1f} mm",
                                    table.row_count(), segments.size(),
                                    columns.acceleration ? "with their velocities and accelerations"
                                    : columns.velocity   ? "with their velocities"
                                                         : "of minimum snap, at rest at both ends",
                                    greatest_deviation(samples, knots, segments) * 1e3));
  return checked(
      {std::move(segments), std::move(assumptions)}, limits,
      [&](std::size_t segment, const std::string& fault) { table.fail(knots[segment], "", fault); });
}

}  // namespace swiftlet::ground
