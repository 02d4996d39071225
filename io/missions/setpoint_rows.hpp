// Tables of setpoints over time, one per row, for `swiftlet stream`. Names, frames and units of the columns are
// those of motion_columns.hpp.
//
//   t, x, y, z; also vx, vy, vz; ax, ay, az      positions
//   t, vx, vy, vz; also ax, ay, az               velocities
//   t, ax, ay, az                                accelerations
//   t, roll, pitch, yaw, thrust; also p, q, r    attitudes
//   t, p, q, r, thrust                           body rates
//
// The first three kinds may have yaw and yaw_rate; without yaw the heading is kept. All but positions must
// have units.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/request.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/table.hpp"

namespace swiftlet::io {

struct TimedSetpoint {
  double time_s = 0.0;
  control::Setpoint setpoint;
};

// Reads rows one at a time, so that the input may be a live stream.
class SetpointRows {
 public:
  // header: the columns of the first line. frame: that of --frame, if given. Throws io::ConfigError with
  // the invalid column and the valid ones.
  SetpointRows(const std::vector<std::string>& header, const std::string& file_name,
               std::optional<MissionFrame> frame = std::nullopt);

  // Returns the setpoint of the next line; nothing for a blank line. Throws io::ConfigError for an
  // invalid row, or if its time is not later than that of the previous row.
  std::optional<TimedSetpoint> read(const std::string& line);
  // The same for a line of a table that is there as a whole.
  TimedSetpoint read(const CsvLine& line);
  // The same for the numbers of a row that was read already.
  TimedSetpoint setpoint(const std::vector<double>& row, int line);

  control::SetpointKind kind() const { return kind_; }
  // A sentence if frame and units were assumed.
  std::optional<std::string> assumption() const { return columns_.assumption("a sampled trajectory"); }

 private:
  control::Setpoint setpoint_of(const std::vector<double>& row) const;

  std::string file_;
  std::vector<std::string> names_;
  MotionColumns columns_;
  control::SetpointKind kind_ = control::SetpointKind::kPosition;
  int line_ = 1;
  std::optional<double> last_time_s_;
};

// The rows of a table whose columns name their frame. Throws io::ConfigError as SetpointRows does.
std::vector<TimedSetpoint> setpoints_of(const Table& table, std::optional<MissionFrame> frame);

// Returns the next row; nothing at the end.
using SetpointSource = std::function<std::optional<TimedSetpoint>()>;

// Resamples the rows at rate_hz by linear interpolation; headings and attitudes turn the shorter way.
SetpointSource resampled(SetpointSource source, double rate_hz);

}  // namespace swiftlet::io
