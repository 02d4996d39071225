#include "swiftlet/io/missions/foreign_columns.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

using Fields = std::vector<std::string>;

const std::vector<std::pair<const char*, Fields>> kNames = {
    {"t", {"t", "time", "times", "timestamp", "stamp", "time_s", "t_s", "sec", "secs", "seconds"}},
    {"x", {"x", "p_x", "px", "pos_x", "position_x", "position.x", "tx", "p_rs_r_x", "stateestimate.x"}},
    {"y", {"y", "p_y", "py", "pos_y", "position_y", "position.y", "ty", "p_rs_r_y", "stateestimate.y"}},
    {"z", {"z", "p_z", "pz", "pos_z", "position_z", "position.z", "tz", "p_rs_r_z", "stateestimate.z"}},
    {"vx", {"vx", "v_x", "vel_x", "velocity_x", "v_rs_r_x", "stateestimate.vx"}},
    {"vy", {"vy", "v_y", "vel_y", "velocity_y", "v_rs_r_y", "stateestimate.vy"}},
    {"vz", {"vz", "v_z", "vel_z", "velocity_z", "v_rs_r_z", "stateestimate.vz"}},
    {"ax", {"ax", "a_x", "a_lin_x", "acc_x", "acceleration_x"}},
    {"ay", {"ay", "a_y", "a_lin_y", "acc_y", "acceleration_y"}},
    {"az", {"az", "a_z", "a_lin_z", "acc_z", "acceleration_z"}},
    {"yaw", {"yaw", "heading", "psi"}},
    {"yaw_rate", {"yaw_rate", "yawrate", "yaw_dot"}},
    {"qw", {"qw", "q_w", "q_rs_w", "orientation.w", "stateestimate.qw"}},
    {"qx", {"qx", "q_x", "q_rs_x", "orientation.x", "stateestimate.qx"}},
    {"qy", {"qy", "q_y", "q_rs_y", "orientation.y", "stateestimate.qy"}},
    {"qz", {"qz", "q_z", "q_rs_z", "orientation.z", "stateestimate.qz"}}};

// Beginnings of the names of quantities that a path does not need.
const Fields kLeftOut = {"w_",   "wx",   "wy",   "wz",   "omega", "a_rot", "u_",    "jerk",
                         "snap", "b_w_", "b_a_", "roll", "pitch", "rpm",   "motor", "gyro.",
                         "acc.", "pm.",  "rate", "tau",  "mot_",  "f_",    "thrust"};

std::string base_of(const std::string& header) {
  std::string name = without_blanks(header.substr(0, header.find('[')));
  for (const char* const frame : {"_ned", "_enu", "_nwu", "_frd"}) {
    if (name.size() > 4 && name.compare(name.size() - 4, 4, frame) == 0) name.resize(name.size() - 4);
  }
  return name;
}

}  // namespace

std::string without_blanks(const std::string& text) { return std::string(io::trimmed(text, " \t\r")); }

ForeignColumn column_of(const std::string& given, const std::string& file, int line) {
  ForeignColumn column;
  column.given = given;
  const std::size_t open = given.find('[');
  std::string name = lower(without_blanks(given.substr(0, open)));
  if (open != std::string::npos && given.back() == ']') {
    column.unit = without_blanks(given.substr(open + 1, given.size() - open - 2));
    for (const auto& [from, to] : {std::pair{"m s^-1", "m/s"}, {"m s^-2", "m/s^2"}, {"rad s^-1", "rad/s"}}) {
      if (column.unit == from) column.unit = to;
    }
  }
  std::string ending;  // names the frame
  for (const char* const frame : {"_ned", "_enu", "_nwu"}) {
    if (name.size() > 4 && name.compare(name.size() - 4, 4, frame) == 0) ending = frame;
  }
  name.resize(name.size() - ending.size());
  for (const auto& [meant, names] : kNames) {
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    column.name = meant + ending;
    return column;
  }
  const bool left_out = std::any_of(kLeftOut.begin(), kLeftOut.end(),
                                    [&](const std::string& begin) { return name.rfind(begin, 0) == 0; });
  if (!left_out)
    throw ConfigError(file, line, "header",
                      "has the column " + given +
                          ", which is not known; --columns names all columns in order, such as --columns "
                          "t,x,y,z,w_,w_ with w_ for what is not used");
  return column;
}

bool is_known_column(const std::string& header) {
  static const Fields kKnown = {"t",  "x",   "y",        "z",    "vx",    "vy", "vz", "ax", "ay",
                                "az", "yaw", "yaw_rate", "roll", "pitch", "p",  "q",  "r",  "thrust"};
  return std::find(kKnown.begin(), kKnown.end(), base_of(header)) != kKnown.end();
}

}  // namespace swiftlet::io
