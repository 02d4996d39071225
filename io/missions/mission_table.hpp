// Tables of paths, of this project and of others: what their headers, separators and comments mean.
//
//   # a comment, also between the rows; blank lines; semicolons, tabs or blanks between the columns
//   t [s],x_ned [m],...  or  t,x,y,z,...  or  x,y,z,...         motion_columns.hpp
//   t [s],mode,...,ref_x_ned [m],...                            `swiftlet log csv`: flight_table.hpp
//   Duration,x^0,...  or  # duration,x^0,...                    uav_trajectories
//   t,p_x,p_y,p_z,q_w,...,v_x,...,w_x,...,a_lin_x,...           Agilicious
//   #timestamp [ns],p_RS_R_x [m],...,q_RS_w [],...              EuRoC
//   time,pos_x,...   stamp,tx,ty,tz,qx,...                      and other names of the same
//   1403636580.838 0.1 0.2 1.0 0 0 0 1                          TUM: stamp, place and quaternion, without a header
//
// A quaternion becomes the yaw. Columns of other quantities (body rates, motor speeds, biases) are left out, and told.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/io/table.hpp"

namespace swiftlet::io {

enum class MissionFormat { kYaml, kPolynomialCsv, kSampledCsv, kWaypointCsv, kQGroundControlPlan };

// What a table with these columns holds; kYaml: no path.
MissionFormat format_of(const std::vector<std::string>& columns);

// duration, x^0 ... x^7, y^0 ... yaw^7
std::vector<std::string> polynomial_columns();

// A table in the columns of motion_columns.hpp or of polynomials, with the line numbers of the file.
struct MissionTable {
  Table table;
  std::vector<std::string> assumptions;
};

// A table whose header is known as it is keeps its columns. columns: the names of all columns in order, from --columns, in
// place of the header; empty: none. A text that is no table has no rows.
// Throws io::ConfigError for an unknown column, a quaternion that is none, decimal commas, and for a table
// without a header whose columns could be two things, with both and with the option that says which.
MissionTable read_mission_table(const std::string& text, const std::string& file_name,
                                const std::string& columns);

}  // namespace swiftlet::io
