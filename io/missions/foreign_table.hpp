// Tables of other programs in the dialect of ours: what their headers, separators and comments mean.
//
//   # a comment, also between the rows; blank lines; semicolons, tabs or blanks between the columns
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

namespace swiftlet::io {

struct ForeignTable {
  std::string text;    // with a header of motion_columns.hpp or of polynomials
  int first_line = 1;  // in the file, of the text: 0 if a header was put before the first row of the file
  std::vector<std::string> assumptions;
};

// Returns the table with the line numbers of the file, and with blank lines where it has none. A table whose header is known
// as it is keeps its columns. columns: the names of all columns in order, from --columns, in place of the header;
// empty: none.
// Throws io::ConfigError for an unknown column, a quaternion that is none, decimal commas, and for a table
// without a header whose columns could be two things, with both and with the option that says which.
ForeignTable read_foreign_table(const std::string& text, const std::string& file_name,
                                const std::string& columns);

}  // namespace swiftlet::io
