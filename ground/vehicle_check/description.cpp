#include "swiftlet/ground/vehicle_check/description.hpp"

#include <cmath>

#include <fmt/core.h>

namespace swiftlet::ground {
namespace {

constexpr double kMassTolerance = 0.1;

}  // namespace

CheckResults check_description(const VehicleRecording& recording, const plant::Vehicle& vehicle) {
  if (!recording.description) return {skipped("vehicle_info.received", "optional, and none arrived")};
  const VehicleDescription& info = *recording.description;
  if (!info.foreign.empty())
    return {judged("vehicle_info.wire_version", {0.0, "", "another"}, "that of this program",
                   info.foreign + ": vehicle_info.wire_version must be WIRE_VERSION of VehicleInfo")};
  CheckResults results = {judged(
      "vehicle_info.rotors", figure(info.rotor_count, "rotors", 0), fmt::format("{}", vehicle.rotor_count()),
      info.rotor_count == vehicle.rotor_count()
          ? ""
          : fmt::format("another vehicle: {} has {} rotors, the vehicle file {} has {}", info.name,
                        info.rotor_count, vehicle.name, vehicle.rotor_count()))};
  if (closes_inner_loops(info.levels) && !recording.rotors_running.empty()) {
    const bool running = recording.rotors_running.back().sample;
    results.push_back(
        judged("vehicle_info.rotors_running", {running ? 1.0 : 0.0, "", running ? "true" : "false"}, "false",
               running ? "rotors_running is true while the rotors are off: control waits for it with a "
                         "take-off, and would not wait for the rotors"
                       : ""));
  }
  if (info.mass_kg <= 0.0) return results;
  results.push_back(
      judged("vehicle_info.mass", figure(info.mass_kg, "kg", 4),
             fmt::format("{:g} kg +- {:.0f} %", vehicle.mass_kg, 1e2 * kMassTolerance),
             std::abs(info.mass_kg / vehicle.mass_kg - 1.0) <= kMassTolerance
                 ? ""
                 : fmt::format("another mass than that of the vehicle file {}: wrong file, or mass in grams",
                               vehicle.name)));
  return results;
}

}  // namespace swiftlet::ground
