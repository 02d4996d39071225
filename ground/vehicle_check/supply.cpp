#include "swiftlet/ground/vehicle_check/supply.hpp"

#include <cmath>

#include <fmt/core.h>

namespace swiftlet::ground {
namespace {

// A cell is discharged to about 0.7 of its full voltage.
constexpr double kEmptiest = 0.7;
constexpr double kFullest = 1.05;
// Of a battery that is not known: a discharged cell, and twelve full ones.
constexpr double kLeast_v = 2.5;
constexpr double kMost_v = 52.0;

std::string any_voltage_finding(double voltage_v) {
  if (voltage_v >= kLeast_v && voltage_v <= kMost_v) return "";
  const std::string against = fmt::format("voltage_v is {:.4g}", voltage_v);
  if (voltage_v > kMost_v) return "battery in mV or another unit: " + against;
  return "the battery is empty, or its voltage is not measured: " + against;
}

std::string voltage_finding(double voltage_v, double full_v) {
  const double part = voltage_v / full_v;
  const auto is_voltage = [](double of_full) { return of_full >= kEmptiest && of_full <= kFullest; };
  if (is_voltage(part)) return "";
  const std::string against = fmt::format(
      "voltage_v is {:.4g}, the vehicle file's battery has {:.2f} V when full", voltage_v, full_v);
  if (is_voltage(1e-3 * part)) return "battery in mV: " + against;
  if (is_voltage(1e-2 * part)) return "battery in hundredths of a volt: " + against;
  if (voltage_v < 0.1) return "the battery's voltage is not measured: " + against;
  for (int cells = 2; cells <= 6; ++cells) {
    if (is_voltage(part * cells))
      return fmt::format("voltage of one cell of {}, or another battery: {}", cells, against);
    if (is_voltage(part / cells))
      return fmt::format("another battery, of {} times the cells: {}", cells, against);
  }
  return "the battery is empty, or its voltage is wrong: " + against;
}

}  // namespace

CheckResults check_supply(const VehicleRecording& recording, std::optional<double> full_battery_v) {
  if (recording.battery.samples.empty()) return {};
  double voltage_v = 0.0;
  for (const auto& received : recording.battery.samples)
    voltage_v += received.sample.voltage_v / static_cast<double>(recording.battery.samples.size());
  const double least_v = full_battery_v ? kEmptiest * *full_battery_v : kLeast_v;
  const double most_v = full_battery_v ? kFullest * *full_battery_v : kMost_v;
  const double charge = recording.battery.samples.back().sample.state_of_charge;
  return {
      judged("battery.voltage", figure(voltage_v, "V", 2, fmt::format(", {:.0f} % charged", 1e2 * charge)),
             fmt::format("{:.2f} to {:.2f} V", least_v, most_v),
             full_battery_v ? voltage_finding(voltage_v, *full_battery_v) : any_voltage_finding(voltage_v))};
}

}  // namespace swiftlet::ground
