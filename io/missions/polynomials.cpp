#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::io {
namespace {

constexpr double kLongestSegment_s = 3600.0;

control::PolynomialSegment read(const Table& table, std::size_t row) {
  control::PolynomialSegment segment;
  segment.duration_s = table.number(row, 0, {0.0, kLongestSegment_s, true, false}, "s");
  std::size_t column = 1;
  for (control::Polynomial* const axis : {&segment.x, &segment.y, &segment.z, &segment.yaw}) {
    for (double& c : *axis) c = table.number(row, column++);
  }
  return segment;
}

}  // namespace

std::vector<std::string> polynomial_columns() {
  std::vector<std::string> names{"duration"};
  for (const char* axis : {"x", "y", "z", "yaw"}) {
    for (int power = 0; power < control::kPolynomialCoefficients; ++power)
      names.push_back(std::string(axis) + "^" + std::to_string(power));
  }
  return names;
}

TrajectoryFile read_polynomials(const Table& table, const control::Limits& limits,
                                const FileOptions& options) {
  table.require_rows(1);
  if (table.row_count() > control::kMaxTrajectorySegments) {
    table.fail(control::kMaxTrajectorySegments, "duration",
               "is segment " + std::to_string(control::kMaxTrajectorySegments + 1) + ", at most " +
                   std::to_string(control::kMaxTrajectorySegments) + " fit");
  }
  std::vector<control::PolynomialSegment> segments;
  const MissionFrame frame = options.frame.value_or(MissionFrame::kEnu);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    segments.push_back(control::stretched(ned_segment(frame, read(table, row)), options.time_scale));
  }
  std::vector<std::string> assumptions = {std::string("taken as a polynomial trajectory in ") +
                                          frame_title(frame) +
                                          ": m, rad and s, from the origin of motion capture"};
  const double raise_m = raise_by(heights_of(segments), {frame, !options.frame}, table.file(), assumptions);
  for (control::PolynomialSegment& segment : segments) {
    segment.z[0] -= raise_m;
    segment = options.placement.segment(segment);
  }
  return checked({std::move(segments), std::move(assumptions)}, frame, limits, options,
                 [&](const PathFault& fault) { table.fail(fault.segment, "", fault.sentence()); });
}

}  // namespace swiftlet::io
