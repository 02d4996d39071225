// Tables of setpoints over time, one a row, for `swiftlet stream`.
//
//   t [s],x [m],y [m],z [m][,vx [m/s],vy ..,vz ..][,ax [m/s^2],ay ..,az ..]     positions
//   t [s],vx [m/s],vy [m/s],vz [m/s][,ax ..,ay ..,az ..]                        velocities
//   t [s],ax [m/s^2],ay [m/s^2],az [m/s^2]                                      accelerations
//   t [s],roll [rad],pitch [rad],yaw [rad],thrust [m/s^2][,p [rad/s],q ..,r ..] attitudes
//   t [s],p [rad/s],q [rad/s],r [rad/s],thrust [m/s^2]                          body rates
//
// The columns may stand in any order; the first three kinds may have yaw [rad] (else the heading is kept) and
// yaw_rate [rad/s]. Units that are usual are known too: deg, deg/s, cm, ms, thrust in g. Frames are those of
// the topics, x north, y east, z down, roll, pitch and yaw as Eq. (3) has them. A header without units,
// t,x,y,z[,vx,vy,vz[,ax,ay,az]][,yaw], is a sampled trajectory as of others, in ENU, and said to be taken for
// that.
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

// Reads rows one after another, so that they may still be coming.
class SetpointRows {
 public:
  // header: the first line. Throws runtime::ConfigError with what cannot be read and what could be.
  SetpointRows(const std::string& header, const std::string& file_name);

  // The next line's; nothing for a blank one. Throws runtime::ConfigError for a row that breaks the form, or
  // whose time is not above that of the row before.
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

// Where the next row comes from; nothing: there is none.
using SetpointSource = std::function<std::optional<TimedSetpoint>()>;

// The same motion at that rate, straight between the rows; headings and attitudes by the shorter way.
SetpointSource resampled(SetpointSource source, double rate_hz);

}  // namespace swiftlet::ground
