// The levels at which a vehicle can be commanded, from the rotors outwards. docs/vehicle.md says what a vehicle
// does at each.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace swiftlet::plant {

// The order is that of the alternatives of VehicleCommand.
enum class ControlLevel : std::uint8_t {
  kActuators = 0,   // throttles
  kRates = 1,       // body rates and collective thrust
  kAttitude = 2,    // attitude and collective thrust
  kTrajectory = 3,  // position, velocity, acceleration and yaw
};
constexpr int kControlLevelCount = 4;
constexpr ControlLevel kControlLevels[kControlLevelCount] = {
    ControlLevel::kActuators, ControlLevel::kRates, ControlLevel::kAttitude, ControlLevel::kTrajectory};

const char* to_string(ControlLevel level);                              // "rates"
std::optional<ControlLevel> control_level_from(std::string_view name);  // nullopt: no level has this name

// The levels that a vehicle accepts. Bit 1 << level of control_levels in vehicle_info.
class ControlLevels {
 public:
  constexpr ControlLevels() = default;  // none
  constexpr ControlLevels(ControlLevel level) : bits_(bit(level)) {}
  // No bit set: actuators, the only level of a vehicle that does not report any. Unknown bits are ignored.
  static constexpr ControlLevels from_bits(std::uint8_t bits) {
    ControlLevels levels;
    levels.bits_ = static_cast<std::uint8_t>(bits & kAllBits);
    if (levels.bits_ == 0) levels.add(ControlLevel::kActuators);
    return levels;
  }

  constexpr void add(ControlLevel level) { bits_ = static_cast<std::uint8_t>(bits_ | bit(level)); }
  constexpr bool has(ControlLevel level) const { return (bits_ & bit(level)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr std::uint8_t bits() const { return bits_; }
  // The one closest to the rotors; actuators if there is none.
  ControlLevel lowest() const;
  // "rates, attitude", terminated by 0.
  using Names = std::array<char, 48>;
  Names names() const;

  constexpr bool operator==(const ControlLevels& other) const { return bits_ == other.bits_; }
  constexpr bool operator!=(const ControlLevels& other) const { return bits_ != other.bits_; }

 private:
  static constexpr std::uint8_t kAllBits = (1U << kControlLevelCount) - 1U;
  static constexpr std::uint8_t bit(ControlLevel level) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(level));
  }
  std::uint8_t bits_ = 0;
};

// The levels in a list such as "rates,attitude"; nullopt: it holds a name of no level, or none.
std::optional<ControlLevels> control_levels_from(std::string_view list);

}  // namespace swiftlet::plant
