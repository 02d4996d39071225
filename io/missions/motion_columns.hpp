// The columns of tables of positions, motions and setpoints. Every command that reads such a table reads it
// so:
//
//   t [s],x_ned [m],y_ned [m],z_ned [m]      name, frame and unit of each column, in any order
//   t [s],x [m],y [m],z [m]                  with --frame ned, enu or nwu; refused without
//   t,x,y,z                                  the form of other projects: ENU, m, rad and s; --frame if not
//
// Names: t; x, y, z; vx, vy, vz; ax, ay, az; yaw, yaw_rate; roll, pitch; p, q, r; thrust. In NED x is north, y
// east, z down, and yaw turns clockwise from north; in ENU x is east, y north, z up, and yaw turns
// counter-clockwise from east; in NWU x is north, y west, z up, and yaw turns counter-clockwise from north. roll, pitch and
// yaw of an attitude are those of Eq. (3), p, q, r are body rates (FRD), thrust is specific, in m/s^2: they have no frame.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/io/column.hpp"
#include "swiftlet/io/missions/mission_frame.hpp"

namespace swiftlet::io {

enum class Motion : int {
  kT,  // s
  kX,  // m
  kY,
  kZ,
  kVx,  // m/s
  kVy,
  kVz,
  kAx,  // m/s^2
  kAy,
  kAz,
  kYaw,      // rad
  kYawRate,  // rad/s
  kRoll,     // rad
  kPitch,
  kP,  // rad/s
  kQ,
  kR,
  kThrust,  // m/s^2
};

// "x_ned [m]" -> "x", "_ned" and "m".
struct MotionDeclaration {
  std::string name;
  std::string axes;  // "_ned", "_enu", "_nwu", "_frd" or none
  std::optional<std::string> unit;
};
MotionDeclaration motion_declaration_of(const std::string& header);

// True if the name is one of those above, with any frame and unit.
bool is_motion(const std::string& header);

// What a name in lower case means in tables of other programs: "tx" -> kX. Nothing if it is not known.
std::optional<Motion> motion_of(const std::string& foreign_name);

std::string name_of(Motion column);  // "x"
const Units& units_of(Motion column);

// "x [m]", with the unit to which values are converted.
std::string header_of(Motion column);

class MotionColumns {
 public:
  // header: the columns of the first line. frame: that of --frame, if given. Throws io::ConfigError for a
  // column with an unknown name or unit or given twice, for a mixture of frames, and for a missing frame.
  MotionColumns(const std::vector<std::string>& header, const std::string& file_name,
                std::optional<MissionFrame> frame);

  bool has(Motion column) const { return index(column).has_value(); }
  bool has_any(const std::vector<Motion>& columns) const;
  const std::vector<Motion>& all() const { return columns_; }
  // Position of the column in the file, and the factor from its unit to SI.
  std::optional<std::size_t> index(Motion column) const;
  double factor(std::size_t index) const { return factors_[index]; }
  bool declares_units() const { return declares_units_; }
  MissionFrame frame() const { return frame_; }
  bool frame_is_assumed() const { return assumed_; }
  // A sentence if frame and units were assumed. what: "waypoints"
  std::optional<std::string> assumption(const std::string& what) const;

  // Values of a row, which has one number per column as in the file: in SI units, 0 for a missing column.
  double value(const std::vector<double>& row, Motion column) const;
  Eigen::Vector3d ned(const std::vector<double>& row, Motion x) const;  // x: kX, kVx or kAx
  double yaw_ned(const std::vector<double>& row) const;
  double yaw_rate_ned(const std::vector<double>& row) const;

 private:
  void read(const std::string& header, const std::string& file_name);
  void settle_frame(const std::string& file_name, std::optional<MissionFrame> named,
                    std::optional<MissionFrame> option);

  std::vector<Motion> columns_;
  std::vector<double> factors_;
  bool declares_units_ = false;
  MissionFrame frame_ = MissionFrame::kNed;
  bool assumed_ = false;
};

// Throws io::ConfigError unless all columns of `needed` are there, of each group of `more` all or none, and
// no others. what: "a stream of positions".
void require_columns(const MotionColumns& columns, const std::string& file_name, const std::string& what,
                     const std::vector<Motion>& needed, const std::vector<std::vector<Motion>>& more);

// "x [m], y [m] and z [m]"
std::string list_of(const std::vector<Motion>& columns);

}  // namespace swiftlet::io
