#include "swiftlet/io/missions/setpoint_rows.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "swiftlet/control/planning/checks_in_frame.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/math/euler.hpp"

namespace swiftlet::io {
namespace {

using control::Setpoint;
using control::SetpointKind;
using io::ConfigError;

// The columns of a kind of stream: the required ones, and optional groups, each complete or absent.
struct Form {
  SetpointKind kind;
  const char* name;
  std::vector<Motion> needed;
  std::vector<std::vector<Motion>> more;
};
const std::vector<Motion> kPosition = {Motion::kX, Motion::kY, Motion::kZ};
const std::vector<Motion> kVelocity = {Motion::kVx, Motion::kVy, Motion::kVz};
const std::vector<Motion> kAcceleration = {Motion::kAx, Motion::kAy, Motion::kAz};
const std::vector<Motion> kAttitude = {Motion::kRoll, Motion::kPitch, Motion::kYaw, Motion::kThrust};
const std::vector<Motion> kBodyRates = {Motion::kP, Motion::kQ, Motion::kR};
const std::vector<Motion> kRatesAndThrust = {Motion::kP, Motion::kQ, Motion::kR, Motion::kThrust};
// The first form whose first required column is present applies.
const std::vector<Form> kForms = {{SetpointKind::kPosition,
                                   "a stream of positions",
                                   kPosition,
                                   {kVelocity, kAcceleration, {Motion::kYaw}, {Motion::kYawRate}}},
                                  {SetpointKind::kAttitude, "a stream of attitudes", kAttitude, {kBodyRates}},
                                  {SetpointKind::kBodyRates, "a stream of body rates", kRatesAndThrust, {}},
                                  {SetpointKind::kVelocity,
                                   "a stream of velocities",
                                   kVelocity,
                                   {kAcceleration, {Motion::kYaw}, {Motion::kYawRate}}},
                                  {SetpointKind::kAcceleration,
                                   "a stream of accelerations",
                                   kAcceleration,
                                   {{Motion::kYaw}, {Motion::kYawRate}}}};

const Form& form_of(const std::string& file, const MotionColumns& columns) {
  const auto form = std::find_if(kForms.begin(), kForms.end(), [&](const Form& candidate) {
    return columns.has(candidate.needed.front());
  });
  if (form == kForms.end()) {
    throw ConfigError(file, 1, "header",
                      "names no setpoint, must have " + list_of(kPosition) +
                          ", or velocities, accelerations, " + list_of(kAttitude) + ", or " +
                          list_of(kRatesAndThrust));
  }
  if (!columns.has(Motion::kT))
    throw ConfigError(file, 1, "header",
                      "has no column " + header_of(Motion::kT) +
                          ", must have it; a list of waypoints is flown by `swiftlet fly`");
  std::vector<std::vector<Motion>> more = form->more;
  more.push_back({Motion::kT});
  require_columns(columns, file, form->name, form->needed, more);
  return *form;
}

double between(double a, double b, double part) { return a + part * (b - a); }
Eigen::Vector3d between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double part) {
  return a + part * (b - a);
}

Setpoint between(const TimedSetpoint& before, const TimedSetpoint& after, double time_s) {
  const Setpoint& a = before.setpoint;
  const Setpoint& b = after.setpoint;
  const double part = (time_s - before.time_s) / (after.time_s - before.time_s);
  Setpoint setpoint = a;
  setpoint.position_ned = between(a.position_ned, b.position_ned, part);
  setpoint.velocity_ned = between(a.velocity_ned, b.velocity_ned, part);
  setpoint.acceleration_ned = between(a.acceleration_ned, b.acceleration_ned, part);
  setpoint.yaw_rad = a.yaw_rad + part * std::remainder(b.yaw_rad - a.yaw_rad, 2.0 * M_PI);
  setpoint.yaw_rate = between(a.yaw_rate, b.yaw_rate, part);
  setpoint.q_ned_from_frd = a.q_ned_from_frd.slerp(part, b.q_ned_from_frd);
  setpoint.body_rates_frd = between(a.body_rates_frd, b.body_rates_frd, part);
  setpoint.specific_thrust = between(a.specific_thrust, b.specific_thrust, part);
  return setpoint;
}

}  // namespace

SetpointRows::SetpointRows(const std::vector<std::string>& header, const std::string& file_name,
                           std::optional<MissionFrame> frame)
    : file_(file_name), names_(header), columns_(header, file_name, frame) {
  kind_ = form_of(file_, columns_).kind;
  if (!columns_.declares_units() && kind_ != SetpointKind::kPosition) {
    throw ConfigError(file_, 1, "header", "has no units, must have them: vx_ned [m/s], thrust [m/s^2] ...");
  }
}

Setpoint SetpointRows::setpoint_of(const std::vector<double>& row) const {
  const auto number = [&](Motion column) { return columns_.value(row, column); };
  Setpoint setpoint;
  setpoint.kind = kind_;
  setpoint.position_ned = columns_.ned(row, Motion::kX);
  setpoint.velocity_ned = columns_.ned(row, Motion::kVx);
  setpoint.acceleration_ned = columns_.ned(row, Motion::kAx);
  setpoint.yaw_free = !columns_.has(Motion::kYaw);
  setpoint.yaw_rad = columns_.yaw_ned(row);
  setpoint.yaw_rate = columns_.yaw_rate_ned(row);
  setpoint.q_ned_from_frd =
      math::quaternion_from_euler({number(Motion::kRoll), number(Motion::kPitch), number(Motion::kYaw)});
  setpoint.body_rates_frd = {number(Motion::kP), number(Motion::kQ), number(Motion::kR)};
  setpoint.specific_thrust = number(Motion::kThrust);
  return setpoint;
}

std::optional<TimedSetpoint> SetpointRows::read(const std::string& line) {
  const std::vector<CsvLine> lines = csv_lines(line, file_, ++line_);
  if (lines.empty()) return std::nullopt;
  return read(lines.front());
}

TimedSetpoint SetpointRows::read(const CsvLine& line) {
  return setpoint(csv_numbers(csv_fields(line.text, names_.size()), names_, file_, line.number), line.number);
}

TimedSetpoint SetpointRows::setpoint(const std::vector<double>& row, int line) {
  const double time_s = columns_.value(row, Motion::kT);
  if (last_time_s_ && time_s <= *last_time_s_) {
    throw ConfigError(file_, line, "t",
                      "is " + io::exact(time_s) + " s, must be above that of the previous row, " +
                          io::exact(*last_time_s_) + " s");
  }
  last_time_s_ = time_s;
  const Setpoint setpoint = setpoint_of(row);
  if (kind_ == SetpointKind::kPosition) {
    const std::string what = in_frame(columns_.frame());
    const control::Outcome outcome =
        control::check_above_ground({what.c_str(), columns_.frame()}, setpoint.position_ned.z());
    if (!outcome.accepted) throw ConfigError(file_, line, "z", outcome.reason);
  }
  return TimedSetpoint{time_s, setpoint};
}

std::vector<TimedSetpoint> setpoints_of(const Table& table, std::optional<MissionFrame> frame) {
  SetpointRows reader(table.columns(), table.file(), frame);
  std::vector<TimedSetpoint> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row)
    rows.push_back(reader.setpoint(table.row(row), table.line(row)));
  return rows;
}

SetpointSource resampled(SetpointSource source, double rate_hz) {
  struct Playback {
    SetpointSource source;
    double period_s;
    std::optional<TimedSetpoint> before, after;
    std::int64_t ticks = 0;
    double begin_s = 0.0;
  };
  auto playback = std::make_shared<Playback>();
  playback->source = std::move(source);
  playback->period_s = 1.0 / rate_hz;
  return [playback]() -> std::optional<TimedSetpoint> {
    Playback& p = *playback;
    if (p.ticks == 0) {
      p.before = p.source();
      p.after = p.source();
      if (!p.before) return std::nullopt;
      p.begin_s = p.before->time_s;
    }
    const double time_s = p.begin_s + static_cast<double>(p.ticks++) * p.period_s;
    while (p.after && p.after->time_s <= time_s) {
      p.before = std::exchange(p.after, std::nullopt);
      p.after = p.source();
    }
    if (p.after) return TimedSetpoint{time_s, between(*p.before, *p.after, time_s)};
    return std::exchange(p.before, std::nullopt);  // the last row unchanged
  };
}

}  // namespace swiftlet::io
