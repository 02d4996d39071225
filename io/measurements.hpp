// Measured data as people keep them: CSV whose header declares each column as `name [unit]`, in the names and
// units that are usual, "omega [rpm]", "thrust [g]", "pwm [us]". What comes out is in SI units. What could be
// read in two ways is refused, with the choices.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace swiftlet::runtime {

// What a column may hold, and the unit in which it is handed out. Throttle and pulse width share their names:
// the unit tells which it is.
enum class Quantity {
  kTime,           // s
  kSupplyVoltage,  // v_s, V
  kMotorVoltage,   // v_a, V
  kThrottle,       // delta, 1
  kPulseWidth,     // us
  kSpeed,          // of a rotor, rad/s
  kThrust,         // N
  kTorque,         // N*m
  kMass,           // kg
  kLength,         // m
  kSeparation,     // m
  kArm,            // m
  kPeriod,         // s

  // Of a flight. x, y, z by the axes that the name ends in, _frd, _flu, _ned or _enu; those of plain names
  // are for the reader to tell.
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
  kMotorCommand,  // 1, of full command: kMotorCommand + i is that of motor i + 1, eight in all
  kMotorPulse = kMotorCommand + 8,  // us, likewise
  kMotorSpeed = kMotorPulse + 8,    // rad/s, likewise
};

constexpr Quantity operator+(Quantity first, int offset) {
  return static_cast<Quantity>(static_cast<int>(first) + offset);
}

// The name under which a quantity is written, with its SI unit: "speed [rad/s]".
std::string header_of(Quantity quantity);

// A name without its unit: "speed".
const std::string& name_of(Quantity quantity);

class Measurements {
 public:
  bool has(Quantity quantity) const { return columns_.count(quantity) > 0; }
  // Throw ConfigError where the file has no such column.
  const std::vector<double>& column(Quantity quantity) const;
  const std::string& header(Quantity quantity) const;  // as it stands in the file
  std::size_t row_count() const { return lines_.size(); }
  int line(std::size_t row) const { return lines_[row]; }  // from 1, the header's
  const std::string& file() const { return file_; }

 private:
  friend Measurements parse_measurements(std::string_view text, const std::string& file_name,
                                         const std::vector<Quantity>& allowed);
  std::string file_;
  std::vector<int> lines_;
  std::map<Quantity, std::vector<double>> columns_;
  std::map<Quantity, std::string> headers_;
};

// A table in which these quantities may stand, in any order, each once. Throws ConfigError for a column
// without a unit, of a name or unit that is not known here, or that says again what another says. file_name
// is for the messages only.
Measurements parse_measurements(std::string_view text, const std::string& file_name,
                                const std::vector<Quantity>& allowed);
Measurements load_measurements(const std::string& path, const std::vector<Quantity>& allowed);

}  // namespace swiftlet::runtime
