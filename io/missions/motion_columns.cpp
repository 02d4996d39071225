#include "swiftlet/io/missions/motion_columns.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io {
namespace {

enum class Axes { kNone, kWorld, kBody };

// Names in tables of other programs, in lower case. * is the axis.
using Names = std::vector<std::string>;
const Names kTimes = {"t", "time", "times", "timestamp", "stamp", "time_s", "t_s", "sec", "secs", "seconds"};
const Names kPositions = {"*",          "p_*", "p*",       "pos_*",          "position_*",
                          "position.*", "t*",  "p_rs_r_*", "stateestimate.*"};
const Names kVelocities = {"v*", "v_*", "vel_*", "velocity_*", "v_rs_r_*", "stateestimate.v*"};
const Names kLinear = {"a*", "a_*", "a_lin_*", "acc_*", "acceleration_*"};
const Names kYaws = {"yaw", "heading", "psi"};
const Names kYawRates = {"yaw_rate", "yawrate", "yaw_dot"};
const Names kNoNames;

struct Known {
  const char* name;
  const Units* units;
  Axes axes;  // what the ending of the name may say
  const Names* foreign;
};
// Indexed by Motion.
const std::array<Known, 18> kKnownColumns = {{{"t", &kSeconds, Axes::kNone, &kTimes},
                                              {"x", &kMetres, Axes::kWorld, &kPositions},
                                              {"y", &kMetres, Axes::kWorld, &kPositions},
                                              {"z", &kMetres, Axes::kWorld, &kPositions},
                                              {"vx", &kMetresPerSecond, Axes::kWorld, &kVelocities},
                                              {"vy", &kMetresPerSecond, Axes::kWorld, &kVelocities},
                                              {"vz", &kMetresPerSecond, Axes::kWorld, &kVelocities},
                                              {"ax", &kAccelerations, Axes::kWorld, &kLinear},
                                              {"ay", &kAccelerations, Axes::kWorld, &kLinear},
                                              {"az", &kAccelerations, Axes::kWorld, &kLinear},
                                              {"yaw", &kRadians, Axes::kWorld, &kYaws},
                                              {"yaw_rate", &kRates, Axes::kWorld, &kYawRates},
                                              {"roll", &kRadians, Axes::kNone, &kNoNames},
                                              {"pitch", &kRadians, Axes::kNone, &kNoNames},
                                              {"p", &kRates, Axes::kBody, &kNoNames},
                                              {"q", &kRates, Axes::kBody, &kNoNames},
                                              {"r", &kRates, Axes::kBody, &kNoNames},
                                              {"thrust", &kAccelerations, Axes::kNone, &kNoNames}}};

const Known& known(Motion column) { return kKnownColumns[static_cast<std::size_t>(column)]; }

[[noreturn]] void refuse(const std::string& file, const std::string& message) {
  throw io::ConfigError(file, 1, "header", message);
}

bool may_end_in(const Known& column, const std::string& axes) {
  if (axes.empty()) return true;
  return axes == "_frd" ? column.axes == Axes::kBody : column.axes == Axes::kWorld;
}

// "x_ned [m]": the recommended header.
std::string full_header_of(const Known& column) {
  const char* const axes = column.axes == Axes::kWorld ? "_ned" : column.axes == Axes::kBody ? "_frd" : "";
  return std::string(column.name) + axes + " [" + column.units->front().name + "]";
}

std::string all_headers() {
  std::vector<std::string> headers;
  for (const Known& column : kKnownColumns) headers.push_back(full_header_of(column));
  return one_of(headers);
}

constexpr std::array<MissionFrame, 3> kFrames = {MissionFrame::kNed, MissionFrame::kEnu, MissionFrame::kNwu};

}  // namespace

MotionDeclaration motion_declaration_of(const std::string& header) {
  Declaration declared = declaration_of(header);
  MotionDeclaration out{std::move(declared.name), "", std::move(declared.unit)};
  const std::size_t ending = out.name.size() > 4 ? out.name.size() - 4 : 0;
  for (const char* const axes : {"_ned", "_enu", "_nwu", "_frd"}) {
    if (ending == 0 || out.name.compare(ending, 4, axes) != 0) continue;
    out.axes = axes;
    out.name.resize(ending);
    break;
  }
  return out;
}

bool is_motion(const std::string& header) {
  const std::string name = motion_declaration_of(header).name;
  return std::any_of(kKnownColumns.begin(), kKnownColumns.end(),
                     [&](const Known& candidate) { return name == candidate.name; });
}

std::optional<Motion> motion_of(const std::string& foreign_name) {
  for (std::size_t i = 0; i < kKnownColumns.size(); ++i) {
    for (std::string name : *kKnownColumns[i].foreign) {
      std::replace(name.begin(), name.end(), '*', std::string_view(kKnownColumns[i].name).back());
      if (name == foreign_name) return static_cast<Motion>(i);
    }
  }
  return std::nullopt;
}

std::string name_of(Motion column) { return known(column).name; }

const Units& units_of(Motion column) { return *known(column).units; }

std::string header_of(Motion column) {
  return std::string(known(column).name) + " [" + known(column).units->front().name + "]";
}

MotionColumns::MotionColumns(const std::vector<std::string>& header, const std::string& file_name,
                             std::optional<MissionFrame> frame) {
  declares_units_ = std::any_of(header.begin(), header.end(), [](const std::string& column) {
    return motion_declaration_of(column).unit.has_value();
  });
  std::optional<MissionFrame> named;
  for (const std::string& column : header) {
    read(column, file_name);
    const std::string axes = motion_declaration_of(column).axes;
    const auto its = std::find_if(kFrames.begin(), kFrames.end(), [&](MissionFrame candidate) {
      return axes == std::string("_") + frame_name(candidate);
    });
    if (its == kFrames.end()) continue;
    if (named && *named != *its)
      refuse(file_name,
             std::string("mixes _") + frame_name(*named) + " and " + axes + ", must name one frame");
    named = *its;
  }
  settle_frame(file_name, named, frame);
}

void MotionColumns::read(const std::string& header, const std::string& file_name) {
  const MotionDeclaration declared = motion_declaration_of(header);
  const auto found = std::find_if(kKnownColumns.begin(), kKnownColumns.end(), [&](const Known& candidate) {
    return declared.name == candidate.name && may_end_in(candidate, declared.axes);
  });
  if (found == kKnownColumns.end())
    refuse(file_name, "has the column " + header + ", must be " + all_headers());
  const auto column = static_cast<Motion>(found - kKnownColumns.begin());
  if (has(column)) refuse(file_name, "has the column " + declared.name + " twice, must have it once");
  const Units& units = *found->units;
  const Unit* const meant = unit_of(units, declared.unit.value_or(units.front().name));
  if (meant == nullptr || declared.unit.has_value() != declares_units_) {
    std::string choices;
    for (const Unit& choice : units)
      choices += (choices.empty() ? "" : " or ") + declared.name + declared.axes + " [" + choice.name + "]";
    refuse(file_name, "has the column " + header +
                          (declared.unit ? " with an unknown unit" : " without a unit") + ", must be " +
                          choices);
  }
  columns_.push_back(column);
  factors_.push_back(meant->factor);
}

void MotionColumns::settle_frame(const std::string& file_name, std::optional<MissionFrame> named,
                                 std::optional<MissionFrame> option) {
  if (named && option && *named != *option) {
    refuse(file_name, std::string("names the frame ") + frame_name(*named) + ", but --frame names " +
                          frame_name(*option));
  }
  const bool attitudes = has_any({Motion::kRoll, Motion::kPitch, Motion::kP, Motion::kQ, Motion::kR});
  if (attitudes) {
    const MissionFrame meant = named.value_or(option.value_or(MissionFrame::kNed));
    if (meant != MissionFrame::kNed)
      refuse(file_name, std::string("has attitudes or body rates in ") + frame_title(meant) +
                            ", must have them in NED and FRD");
    return;
  }
  const auto framed = std::find_if(columns_.begin(), columns_.end(),
                                   [](Motion column) { return known(column).axes == Axes::kWorld; });
  if (framed == columns_.end()) return;
  if (named || option) {
    frame_ = named ? *named : *option;
    return;
  }
  if (declares_units_) {
    const std::string name = known(*framed).name;
    const std::string unit = std::string(" [") + known(*framed).units->front().name + "]";
    refuse(file_name, "names no frame: write " + name + "_ned" + unit + " (north, east, down), " + name +
                          "_enu" + unit + " (east, north, up) or " + name + "_nwu" + unit +
                          " (north, west, up), or add --frame ned, --frame enu or --frame nwu");
  }
  frame_ = MissionFrame::kEnu;
  assumed_ = true;
}

std::optional<std::string> MotionColumns::assumption(const std::string& what) const {
  if (!assumed_) return std::nullopt;
  return "taken as " + what + " in ENU: m, rad and s, from the origin of motion capture";
}

bool MotionColumns::has_any(const std::vector<Motion>& columns) const {
  return std::any_of(columns.begin(), columns.end(), [this](Motion column) { return has(column); });
}

std::optional<std::size_t> MotionColumns::index(Motion column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

double MotionColumns::value(const std::vector<double>& row, Motion column) const {
  const auto at = index(column);
  return at ? factors_[*at] * row[*at] : 0.0;
}

Eigen::Vector3d MotionColumns::ned(const std::vector<double>& row, Motion x) const {
  const int first = static_cast<int>(x);
  const auto part = [&](int axis) { return value(row, static_cast<Motion>(first + axis)); };
  return ned_from(frame_, {part(0), part(1), part(2)});
}

double MotionColumns::yaw_ned(const std::vector<double>& row) const {
  return ned_yaw_from(frame_, value(row, Motion::kYaw));
}

double MotionColumns::yaw_rate_ned(const std::vector<double>& row) const {
  return ned_yaw_rate_from(frame_, value(row, Motion::kYawRate));
}

void require_columns(const MotionColumns& columns, const std::string& file_name, const std::string& what,
                     const std::vector<Motion>& needed, const std::vector<std::vector<Motion>>& more) {
  std::vector<Motion> used;
  const auto require = [&](const std::vector<Motion>& group) {
    for (const Motion column : group) {
      if (!columns.has(column))
        refuse(file_name, "has no column " + header_of(column) + ", must have " + list_of(group));
    }
    used.insert(used.end(), group.begin(), group.end());
  };
  require(needed);
  for (const std::vector<Motion>& group : more) {
    if (columns.has_any(group)) require(group);
  }
  for (const Motion column : columns.all()) {
    if (std::find(used.begin(), used.end(), column) == used.end())
      refuse(file_name, "has the column " + header_of(column) + ", which " + what + " does not use");
  }
}

std::string list_of(const std::vector<Motion>& columns) {
  std::vector<std::string> headers;
  for (const Motion column : columns) headers.push_back(header_of(column));
  return one_of(headers, " and ");
}

}  // namespace swiftlet::io
