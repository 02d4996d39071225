// Tables of setpoints over time, one per row, for `swiftlet stream`.
//
//   t [s],x [m],y [m],z [m][,vx [m/s],vy ..,vz ..][,ax [m/s^2],ay ..,az ..]     positions
//   t [s],vx [m/s],vy [m/s],vz [m/s][,ax ..,ay ..,az ..]                        velocities
//   t [s],ax [m/s^2],ay [m/s^2],az [m/s^2]                                      accelerations
//   t [s],roll [rad],pitch [rad],yaw [rad],thrust [m/s^2][,p [rad/s],q ..,r ..] attitudes
//   t [s],p [rad/s],q [rad/s],r [rad/s],thrust [m/s^2]                          body rates
//
// The columns may have any order. The first three kinds may have yaw [rad] and yaw_rate [rad/s]; without yaw
// the heading is kept. Other common units are accepted: deg, deg/s, cm, ms, thrust in g. Frames are those of
// the topics: x north, y east, z down; roll, pitch and yaw as in Eq. (3). A header without units,
// t,x,y,z[,vx,vy,vz[,ax,ay,az]][,yaw], is read as a sampled trajectory of another project, in ENU;
// assumption() says so.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/request.hpp"

namespace swiftlet::ground {

struct TimedSetpoint {
  double time_s = 0.0;
  control::Setpoint setpoint;
};

// Reads rows one at a time, so that the input may be a live stream.
class SetpointRows {
 public:
  // header is the first line. Throws runtime::ConfigError with the invalid column and the valid ones.
  SetpointRows(const std::string& header, const std::string& file_name);

  // Returns the setpoint of the next line; nothing for a blank line. Throws runtime::ConfigError for an
  // invalid row, or if its time is not later than that of the previous row.
  std::optional<TimedSetpoint> read(const std::string& line);

  control::SetpointKind kind() const { return kind_; }
  const std::optional<std::string>& assumption() const { return assumption_; }  // a sentence

 private:
  struct Column {
    int slot;
    double factor;
  };
  double value(const std::vector<double>& values, int slot) const;
  control::Setpoint setpoint_of(const std::vector<double>& values) const;

  std::string file_;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
  control::SetpointKind kind_ = control::SetpointKind::kPosition;
  std::optional<std::string> assumption_;
  bool enu_ = false;
  int line_ = 1;
  std::optional<double> last_time_s_;
};

// Returns the next row; nothing at the end.
using SetpointSource = std::function<std::optional<TimedSetpoint>()>;

// Resamples the rows at rate_hz by linear interpolation; headings and attitudes turn the shorter way.
SetpointSource resampled(SetpointSource source, double rate_hz);

}  // namespace swiftlet::ground
