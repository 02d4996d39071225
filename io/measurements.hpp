// Measured data as CSV. The header declares each column as `name [unit]` with common names and units, such as
// "omega [rpm]", "thrust [g]", "pwm [us]". Values are converted to SI units. An ambiguous column is refused;
// the message lists the choices.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace swiftlet::io {

// The quantity of a column, and the unit of its values after reading. Throttle and pulse width share column
// names; the unit distinguishes them.
enum class Quantity {
  kTime,           // s
  kSupplyVoltage,  // v_s, V
  kMotorVoltage,   // v_a, V
  kThrottle,       // delta, 1
  kPulseWidth,     // us
  kSpeed,          // rotor speed, rad/s
  kThrust,         // N
  kTorque,         // N*m
  kMass,           // kg
  kLength,         // m
  kSeparation,     // m
  kArm,            // m
  kPeriod,         // s

  // Quantities of a flight log. The ending of the column name states the axes of x, y, z: _frd, _flu, _ned or
  // _enu. The caller decides the axes of names without such an ending.
  kSpecificForceX,  // m/s^2
  kSpecificForceY,
  kSpecificForceZ,
  kBodyRateX,  // rad/s
  kBodyRateY,
  kBodyRateZ,
  kPositionX,  // m
  kPositionY,
  kPositionZ,
  kOrientationW,  // quaternion, 1
  kOrientationX,
  kOrientationY,
  kOrientationZ,
  kPoseTime,      // s
  kRunning,       // 1: the rotors run, 0: they are off
  kMotorCommand,  // 1, share of full command; kMotorCommand + i belongs to motor i + 1, up to 8 motors
  kMotorPulse = kMotorCommand + 8,  // us, one per motor
  kMotorSpeed = kMotorPulse + 8,    // rad/s, one per motor
};

constexpr Quantity operator+(Quantity first, int offset) {
  return static_cast<Quantity>(static_cast<int>(first) + offset);
}

// The column header that Swiftlet writes for a quantity, with its SI unit: "speed [rad/s]".
std::string header_of(Quantity quantity);

// The same without the unit: "speed".
const std::string& name_of(Quantity quantity);

class Measurements {
 public:
  bool has(Quantity quantity) const { return columns_.count(quantity) > 0; }
  // Both throw ConfigError if the file has no such column.
  const std::vector<double>& column(Quantity quantity) const;
  const std::string& header(Quantity quantity) const;  // as written in the file
  std::size_t row_count() const { return lines_.size(); }
  int line(std::size_t row) const { return lines_[row]; }  // from 1, which is the header
  const std::string& file() const { return file_; }

 private:
  friend Measurements parse_measurements(std::string_view text, const std::string& file_name,
                                         const std::vector<Quantity>& allowed);
  std::string file_;
  std::vector<int> lines_;
  std::map<Quantity, std::vector<double>> columns_;
  std::map<Quantity, std::string> headers_;
};

// Reads a table whose columns are any of these quantities, in any order, each at most once. Throws
// ConfigError for a column without a unit, with an unknown name or unit, or with the quantity of another
// column. file_name appears in messages only.
Measurements parse_measurements(std::string_view text, const std::string& file_name,
                                const std::vector<Quantity>& allowed);
Measurements load_measurements(const std::string& path, const std::vector<Quantity>& allowed);

}  // namespace swiftlet::io
