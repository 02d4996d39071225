#include "swiftlet/io/missions/setpoint_rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/math/euler.hpp"

namespace swiftlet::ground {
namespace {

using control::Setpoint;
using control::SetpointKind;
using runtime::ConfigError;

constexpr double kRadPerDeg = M_PI / 180.0;
constexpr double kStandardGravity = 9.80665;  // m/s^2, one g

enum Slot : int {
  kT,
  kX,
  kY,
  kZ,
  kVx,
  kVy,
  kVz,
  kAx,
  kAy,
  kAz,
  kYaw,
  kYawRate,
  kRoll,
  kPitch,
  kP,
  kQ,
  kR,
  kThrust
};

struct Unit {
  const char* name;
  double factor;  // to SI
};
const std::vector<Unit> kSeconds = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}};
const std::vector<Unit> kMetres = {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}};
const std::vector<Unit> kSpeeds = {{"m/s", 1.0}, {"cm/s", 1e-2}};
const std::vector<Unit> kAccelerations = {{"m/s^2", 1.0}, {"m/s2", 1.0}, {"g", kStandardGravity}};
const std::vector<Unit> kAngles = {{"rad", 1.0}, {"deg", kRadPerDeg}};
const std::vector<Unit> kRates = {{"rad/s", 1.0}, {"deg/s", kRadPerDeg}};

struct Known {
  const char* name;
  const std::vector<Unit>* units;  // first the unit of the topics
};
// Indexed by Slot.
const std::array<Known, 18> kKnown = {{{"t", &kSeconds},
                                       {"x", &kMetres},
                                       {"y", &kMetres},
                                       {"z", &kMetres},
                                       {"vx", &kSpeeds},
                                       {"vy", &kSpeeds},
                                       {"vz", &kSpeeds},
                                       {"ax", &kAccelerations},
                                       {"ay", &kAccelerations},
                                       {"az", &kAccelerations},
                                       {"yaw", &kAngles},
                                       {"yaw_rate", &kRates},
                                       {"roll", &kAngles},
                                       {"pitch", &kAngles},
                                       {"p", &kRates},
                                       {"q", &kRates},
                                       {"r", &kRates},
                                       {"thrust", &kAccelerations}}};

// The columns of a kind of stream besides the time: the required ones, and optional groups, each complete or
// absent.
struct Form {
  SetpointKind kind;
  const char* name;
  std::vector<int> needed;
  std::vector<std::vector<int>> more;
};
const std::vector<int> kVelocity = {kVx, kVy, kVz};
const std::vector<int> kAcceleration = {kAx, kAy, kAz};
const std::vector<int> kBodyRates = {kP, kQ, kR};
// The first form whose first required column is present applies.
const std::vector<Form> kForms = {
    {SetpointKind::kPosition, "positions", {kX, kY, kZ}, {kVelocity, kAcceleration, {kYaw}, {kYawRate}}},
    {SetpointKind::kAttitude, "attitudes", {kRoll, kPitch, kYaw, kThrust}, {kBodyRates}},
    {SetpointKind::kBodyRates, "body rates", {kP, kQ, kR, kThrust}, {}},
    {SetpointKind::kVelocity, "velocities", kVelocity, {kAcceleration, {kYaw}, {kYawRate}}},
    {SetpointKind::kAcceleration, "accelerations", kAcceleration, {{kYaw}, {kYawRate}}}};

std::string header_of(int slot) {
  const Known& known = kKnown[static_cast<std::size_t>(slot)];
  return std::string(known.name) + " [" + known.units->front().name + "]";
}

std::string list_of(const std::vector<int>& slots) {
  std::string text;
  for (std::size_t i = 0; i < slots.size(); ++i)
    text += (i == 0 ? "" : i + 1 == slots.size() ? " and " : ", ") + header_of(slots[i]);
  return text;
}

int slot_named(const std::string& name) {
  const auto known = std::find_if(kKnown.begin(), kKnown.end(),
                                  [&](const Known& candidate) { return name == candidate.name; });
  return known == kKnown.end() ? -1 : static_cast<int>(known - kKnown.begin());
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

[[noreturn]] void refuse_header(const std::string& file, const std::string& message) {
  throw ConfigError(file, 1, "header", message);
}

const Form& form_of(const std::string& file, const std::vector<int>& slots) {
  const auto has = [&](int slot) { return std::find(slots.begin(), slots.end(), slot) != slots.end(); };
  const auto form = std::find_if(kForms.begin(), kForms.end(),
                                 [&](const Form& candidate) { return has(candidate.needed.front()); });
  if (form == kForms.end()) {
    refuse_header(file, "names no setpoint, must have " + list_of({kX, kY, kZ}) +
                            ", or velocities, accelerations, " + list_of({kRoll, kPitch, kYaw, kThrust}) +
                            ", or " + list_of({kP, kQ, kR, kThrust}));
  }
  std::vector<int> used = {kT};
  const auto require = [&](const std::vector<int>& group) {
    for (const int slot : group) {
      if (!has(slot))
        refuse_header(file, "has no column " + header_of(slot) + ", must have " + list_of(group));
    }
    used.insert(used.end(), group.begin(), group.end());
  };
  require({kT});
  require(form->needed);
  for (const std::vector<int>& group : form->more) {
    if (std::any_of(group.begin(), group.end(), has)) require(group);
  }
  for (const int slot : slots) {
    if (std::find(used.begin(), used.end(), slot) == used.end()) {
      refuse_header(
          file, "has the column " + header_of(slot) + ", which a stream of " + form->name + " does not use");
    }
  }
  return *form;
}

double number_of(const std::string& text, const std::string& file, int line, const std::string& column) {
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value))
    throw ConfigError(file, line, column, "is '" + text + "', must be a finite number");
  return value;
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

SetpointRows::SetpointRows(const std::string& header, const std::string& file_name) : file_(file_name) {
  names_ = runtime::first_csv_line(header, file_);
  const bool declared = header.find('[') != std::string::npos;
  std::vector<int> slots;
  for (const std::string& text : names_) {
    const std::size_t open = text.find('[');
    const bool has_unit = open != std::string::npos && text.back() == ']';
    const std::string name = trimmed(text.substr(0, open));
    const int slot = slot_named(name);
    if (slot < 0) {
      std::string known;
      for (std::size_t i = 0; i < kKnown.size(); ++i)
        known += (i == 0 ? "" : i + 1 == kKnown.size() ? " or " : ", ") + header_of(static_cast<int>(i));
      refuse_header(file_, "has the column " + text + ", must be " + known);
    }
    if (std::find(slots.begin(), slots.end(), slot) != slots.end())
      refuse_header(file_, "has the column " + name + " twice, must have it once");
    slots.push_back(slot);
    const std::vector<Unit>& units = *kKnown[static_cast<std::size_t>(slot)].units;
    const std::string unit =
        has_unit ? trimmed(text.substr(open + 1, text.size() - open - 2)) : units.front().name;
    const auto meant = std::find_if(units.begin(), units.end(),
                                    [&](const Unit& candidate) { return unit == candidate.name; });
    if (meant == units.end() || has_unit != declared) {
      std::string choices;
      for (const Unit& choice : units)
        choices += (choices.empty() ? "" : " or ") + name + " [" + choice.name + "]";
      refuse_header(file_, "has the column " + text +
                               (has_unit ? " with an unknown unit" : " without a unit") + ", must be " +
                               choices);
    }
    columns_.push_back({slot, meant->factor});
  }
  kind_ = form_of(file_, slots).kind;
  if (declared) return;
  enu_ = true;
  if (kind_ != SetpointKind::kPosition)
    refuse_header(file_, "has no units, must have them: vx [m/s], thrust [m/s^2] ...");
  assumption_ = "taken as a sampled trajectory in ENU: m, rad and s, from the origin of motion capture";
}

double SetpointRows::value(const std::vector<double>& values, int slot) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].slot == slot) return columns_[i].factor * values[i];
  }
  return 0.0;
}

Setpoint SetpointRows::setpoint_of(const std::vector<double>& values) const {
  const auto number = [&](int slot) { return value(values, slot); };
  const auto vector = [&](int slot) {
    const Eigen::Vector3d read(number(slot), number(slot + 1), number(slot + 2));
    return enu_ ? ned_position(read) : read;
  };
  const auto has = [&](int slot) {
    return std::any_of(columns_.begin(), columns_.end(),
                       [&](const Column& column) { return column.slot == slot; });
  };
  Setpoint setpoint;
  setpoint.kind = kind_;
  setpoint.position_ned = vector(kX);
  setpoint.velocity_ned = vector(kVx);
  setpoint.acceleration_ned = vector(kAx);
  setpoint.yaw_free = !has(kYaw);
  setpoint.yaw_rad = enu_ ? ned_yaw(number(kYaw)) : number(kYaw);
  setpoint.yaw_rate = number(kYawRate);
  setpoint.q_ned_from_frd = control::quaternion_from_euler({number(kRoll), number(kPitch), number(kYaw)});
  setpoint.body_rates_frd = {number(kP), number(kQ), number(kR)};
  setpoint.specific_thrust = number(kThrust);
  return setpoint;
}

std::optional<TimedSetpoint> SetpointRows::read(const std::string& line) {
  ++line_;
  const std::vector<std::string> fields = runtime::first_csv_line(line, file_, line_);
  if (fields.empty()) return std::nullopt;
  if (fields.size() != columns_.size()) {
    throw ConfigError(
        file_, line_, "row",
        "has " + std::to_string(fields.size()) + " fields, must have " + std::to_string(columns_.size()));
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < fields.size(); ++i)
    values.push_back(number_of(fields[i], file_, line_, names_[i]));
  const double time_s = value(values, kT);
  if (last_time_s_ && time_s <= *last_time_s_) {
    throw ConfigError(file_, line_, "t",
                      "is " + runtime::exact(time_s) + " s, must be above that of the previous row, " +
                          runtime::exact(*last_time_s_) + " s");
  }
  last_time_s_ = time_s;
  const Setpoint setpoint = setpoint_of(values);
  if (kind_ == SetpointKind::kPosition) {
    const control::Outcome outcome = control::check_above_ground("in NED", setpoint.position_ned.z());
    if (!outcome.accepted) throw ConfigError(file_, line_, "z", outcome.reason);
  }
  return TimedSetpoint{time_s, setpoint};
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

}  // namespace swiftlet::ground
