#include "swiftlet/services/messages/vehicle_info.hpp"

#include <cmath>
#include <cstring>

#include <fmt/core.h>

#include "swiftlet/services/messages/wire_version.hpp"

namespace swiftlet::messages {
namespace {

constexpr std::size_t kMostText = 127;

bool differs(double reported, double expected, double tolerance) {
  return reported != 0.0 && !(std::abs(reported - expected) <= tolerance * expected);
}

}  // namespace

void describe(const plant::Vehicle& vehicle, msg::VehicleInfo& info) {
  info.wire_version(kWireVersion);
  info.name() = fmt::format("{:.64}", vehicle.name);
  info.rotor_count(static_cast<std::uint8_t>(vehicle.rotor_count()));
  info.mass_kg(vehicle.mass_kg);
  info.full_battery_v(vehicle.battery.open_circuit_voltage_v.back());
  info.empty_battery_v(vehicle.battery.open_circuit_voltage_v.front());
}

std::string difference(const msg::VehicleInfo& info, const plant::Vehicle& expected, double tolerance) {
  const plant::BatteryParameters& battery = expected.battery;
  const double full_v = battery.open_circuit_voltage_v.back();
  const double empty_v = battery.open_circuit_voltage_v.front();
  std::string text;
  const auto add = [&](const std::string& one) {
    const char* const joint = text.empty() ? "the vehicle is not control's: " : "; ";
    if (text.size() + std::strlen(joint) + one.size() <= kMostText) text += joint + one;
  };
  const std::string name = info.name().c_str();
  if (!name.empty() && name != expected.name) add(fmt::format("{:.24}, not {:.24}", name, expected.name));
  if (info.rotor_count() != 0 && info.rotor_count() != expected.rotor_count())
    add(fmt::format("{} rotors, not {}", info.rotor_count(), expected.rotor_count()));
  if (differs(info.mass_kg(), expected.mass_kg, tolerance))
    add(fmt::format("mass {:.3f} kg, not {:.3f} kg", info.mass_kg(), expected.mass_kg));
  if (differs(info.full_battery_v(), full_v, tolerance))
    add(fmt::format("full battery {:.2f} V, not {:.2f} V", info.full_battery_v(), full_v));
  if (differs(info.empty_battery_v(), empty_v, tolerance))
    add(fmt::format("empty battery {:.2f} V, not {:.2f} V", info.empty_battery_v(), empty_v));
  return text;
}

}  // namespace swiftlet::messages
