#include "swiftlet/io/measurements.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/io/column.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

struct QuantityKind {
  Quantity quantity;
  std::vector<std::string> names;  // accepted names, first the written one
  Units units;                     // accepted units, first the SI one
};

const Units kVolts = {{"V", 1.0, {"volt"}}, {"mV", 1e-3, {}}};
const std::vector<std::string> kCommandNames = {"throttle", "delta",       "command",
                                                "pwm",      "pulse_width", "pulse"};

const Units kShares = {{"1", 1.0, {"-", "0..1"}},
                       {"%", 1e-2, {"percent"}},
                       {"0..65535", 1.0 / 65535.0, {"uint16", "16 bit"}},
                       {"0..255", 1.0 / 255.0, {"uint8", "8 bit"}}};
const Units kPulses = {{"us", 1.0, {"\xc2\xb5s", "\xce\xbcs"}}, {"ms", 1e3, {}}};
const Units kSpeeds = {{"rad/s", 1.0, {"rads/s", "rad s^-1"}},
                       {"rpm", 2.0 * M_PI / 60.0, {"RPM", "1/min", "rev/min"}},
                       {"rev/s", 2.0 * M_PI, {"Hz", "rps"}}};

// Combines each name with each ending: {"acc_x"}, {"_frd", ""} -> acc_x_frd, acc_x.
std::vector<std::string> with_endings(const std::vector<std::string>& names,
                                      const std::vector<std::string>& endings) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    for (const std::string& ending : endings) out.push_back(name + ending);
  }
  return out;
}

std::vector<std::string> numbered(const std::vector<std::string>& names, int number) {
  return with_endings(names, {std::to_string(number), "_" + std::to_string(number)});
}

// Adds the quantities of a flight log, per axis and per motor.
void add_flight(std::vector<QuantityKind>& all) {
  const std::vector<std::string> body = {"_frd", "", "_flu"};
  const std::vector<std::string> world = {"_ned", "", "_enu"};
  const std::vector<std::string> attitude = {"_ned_from_frd", "", "_enu_from_flu"};
  const char* const rates[] = {"p", "q", "r"};
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, static_cast<char>('x' + i));
    all.push_back({Quantity::kSpecificForceX + i,
                   with_endings({"specific_force_" + axis, "acc_" + axis, "accel_" + axis, "acc." + axis,
                                 "acc" + axis, "a" + axis, "accelerometer_" + axis},
                                body),
                   kAccelerations});
    all.push_back({Quantity::kBodyRateX + i,
                   with_endings({"body_rate_" + axis, "gyro_" + axis, "gyro." + axis, "gyro" + axis,
                                 "g" + axis, "rate_" + axis, "omega_" + axis, "w" + axis, rates[i]},
                                body),
                   kRates});
    all.push_back({Quantity::kPositionX + i,
                   with_endings({"position_" + axis, "pos_" + axis, "p" + axis, axis}, world), kMetres});
  }
  for (int i = 0; i < 4; ++i) {
    const std::string part(1, "wxyz"[i]);
    all.push_back({Quantity::kOrientationW + i,
                   with_endings({"orientation_" + part, "q" + part, "q_" + part}, attitude),
                   {{"1", 1.0, {"-"}}}});
  }
  all.push_back({Quantity::kPoseTime, {"pose_time", "t_pose"}, kSeconds});
  all.push_back({Quantity::kRunning, {"running", "armed"}, {{"1", 1.0, {"-"}}}});
  for (int i = 0; i < 8; ++i) {
    all.push_back({Quantity::kMotorCommand + i,
                   numbered({"throttle", "motor", "m", "delta", "command", "pwm", "duty"}, i + 1), kShares});
    all.push_back({Quantity::kMotorPulse + i,
                   numbered({"pulse_width", "motor", "m", "command", "pwm", "pulse"}, i + 1), kPulses});
    all.push_back({Quantity::kMotorSpeed + i,
                   numbered({"rotor_speed", "motor_speed", "om", "speed", "omega", "rpm"}, i + 1), kSpeeds});
  }
}

std::vector<QuantityKind> all_kinds() {
  std::vector<QuantityKind> all = {
      {Quantity::kTime, {"time", "t", "timestamp"}, kSeconds},
      {Quantity::kSupplyVoltage,
       {"supply_voltage", "v_s", "vs", "supply", "battery_voltage", "vbat"},
       kVolts},
      {Quantity::kMotorVoltage, {"motor_voltage", "v_a", "va", "esc_voltage"}, kVolts},
      {Quantity::kThrottle, kCommandNames, {{"1", 1.0, {"-"}}, {"%", 1e-2, {"percent"}}}},
      {Quantity::kPulseWidth, {"pulse_width", "pwm", "pulse", "throttle", "command"}, kPulses},
      {Quantity::kSpeed, {"speed", "omega", "rotor_speed", "motor_speed", "rpm"}, kSpeeds},
      {Quantity::kThrust,
       {"thrust", "force"},
       {{"N", 1.0, {}},
        {"mN", 1e-3, {}},
        {"g", 1e-3 * kStandardGravity, {"gf", "gram"}},
        {"kg", kStandardGravity, {"kgf"}}}},
      {Quantity::kTorque,
       {"torque", "moment"},
       {{"N*m", 1.0, {"Nm", "N m", "N\xc2\xb7m"}},
        {"mN*m", 1e-3, {"mNm", "mN m", "N*mm", "Nmm", "N mm"}},
        {"uN*m", 1e-6, {"uNm", "\xc2\xb5Nm"}},
        {"g*cm", 1e-5 * kStandardGravity, {"gcm", "gf*cm", "gf cm", "g cm"}}}},
      {Quantity::kMass, {"mass", "m", "weight"}, {{"kg", 1.0, {}}, {"g", 1e-3, {"gram"}}}},
      {Quantity::kLength, {"length", "string_length"}, kMetres},
      {Quantity::kSeparation, {"separation", "string_separation"}, kMetres},
      {Quantity::kArm, {"arm"}, kMetres},
      {Quantity::kPeriod, {"period"}, kSeconds},
  };
  add_flight(all);
  return all;
}

const std::vector<QuantityKind>& kinds() {
  static const std::vector<QuantityKind> all = all_kinds();
  return all;
}

const QuantityKind& kind_of(Quantity quantity) {
  return *std::find_if(kinds().begin(), kinds().end(),
                       [&](const QuantityKind& kind) { return kind.quantity == quantity; });
}

std::vector<std::string> choices_of(const std::string& name,
                                    const std::vector<const QuantityKind*>& candidates) {
  std::vector<std::string> choices;
  for (const QuantityKind* kind : candidates) {
    for (const Unit& unit : kind->units) choices.push_back(name + " [" + unit.name + "]");
  }
  return choices;
}

struct Column {
  Quantity quantity;
  double factor;
};

Column resolve(const std::string& header, const std::string& file, const std::vector<Quantity>& allowed) {
  Declaration declared = declaration_of(header);
  declared.name = lower(declared.name);
  std::vector<const QuantityKind*> candidates;
  for (const Quantity quantity : allowed) {
    const QuantityKind& kind = kind_of(quantity);
    if (std::find(kind.names.begin(), kind.names.end(), declared.name) != kind.names.end())
      candidates.push_back(&kind);
  }
  if (candidates.empty()) {
    std::vector<std::string> known;
    known.reserve(allowed.size());
    for (const Quantity quantity : allowed) known.push_back(header_of(quantity));
    throw ConfigError(file, 1, "header", "has the column " + header + ", must be one of " + one_of(known));
  }
  // A name that is itself a unit, such as rpm, declares its unit.
  const std::string unit = declared.unit.value_or(declared.name);
  std::vector<Column> meant;
  for (const QuantityKind* kind : candidates) {
    if (const Unit* const known = unit_of(kind->units, unit))
      meant.push_back({kind->quantity, known->factor});
  }
  if (meant.size() == 1) return meant.front();
  const std::string choices = one_of(choices_of(declared.name, candidates));
  throw ConfigError(file, 1, "header",
                    (declared.unit ? "has the column " + header + " with an unknown unit"
                                   : "has the column " + header + " without a unit") +
                        ", must be " + choices);
}

}  // namespace

std::string header_of(Quantity quantity) {
  const QuantityKind& kind = kind_of(quantity);
  return kind.names.front() + " [" + kind.units.front().name + "]";
}

const std::string& name_of(Quantity quantity) { return kind_of(quantity).names.front(); }

const std::vector<double>& Measurements::column(Quantity quantity) const {
  const auto found = columns_.find(quantity);
  if (found == columns_.end())
    throw ConfigError(file_, 1, "header", "has no column " + header_of(quantity) + ", must have one");
  return found->second;
}

const std::string& Measurements::header(Quantity quantity) const {
  (void)column(quantity);
  return headers_.at(quantity);
}

Measurements parse_measurements(std::string_view text, const std::string& file_name,
                                const std::vector<Quantity>& allowed) {
  const Table table = parse_csv_as_headed(text, file_name);
  Measurements out;
  out.file_ = file_name;
  for (std::size_t row = 0; row < table.row_count(); ++row) out.lines_.push_back(table.line(row));
  for (std::size_t i = 0; i < table.column_count(); ++i) {
    const Column column = resolve(table.column(i), file_name, allowed);
    if (const auto [other, is_new] = out.headers_.emplace(column.quantity, table.column(i)); !is_new) {
      throw ConfigError(file_name, 1, "header",
                        "has the columns " + other->second + " and " + table.column(i) +
                            ", must have one of them: both are " + name_of(column.quantity));
    }
    std::vector<double>& values = out.columns_[column.quantity];
    for (std::size_t row = 0; row < table.row_count(); ++row)
      values.push_back(column.factor * table.number(row, i));
  }
  return out;
}

Measurements load_measurements(const std::string& path, const std::vector<Quantity>& allowed) {
  return parse_measurements(read_text_file(path), path, allowed);
}

}  // namespace swiftlet::io
