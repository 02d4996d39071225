#include "swiftlet/ground/vehicle_check/standing_vehicle.hpp"

#include "swiftlet/ground/vehicle_check/description.hpp"
#include "swiftlet/ground/vehicle_check/odometry.hpp"
#include "swiftlet/ground/vehicle_check/rest.hpp"
#include "swiftlet/ground/vehicle_check/streams.hpp"
#include "swiftlet/ground/vehicle_check/supply.hpp"

namespace swiftlet::ground {

CheckResults check_standing_vehicle(const VehicleRecording& recording, const plant::Vehicle* vehicle,
                                    bool mocap_required) {
  if (runs_in_lockstep(recording))
    return {
        missing("imu.lockstep", "the simulated vehicle runs in lockstep: start it in real time to check it")};
  const bool odometry = brings_odometry(recording);
  CheckResults results = odometry ? check_odometry_stream(recording) : check_imu_stream(recording);
  const CheckResults imu = odometry ? check_odometry_at_rest(recording) : check_imu_at_rest(recording);
  append(results, imu);
  append(results, check_battery_stream(recording));
  append(results, check_supply(recording, vehicle != nullptr
                                              ? std::optional(vehicle->battery.open_circuit_voltage_v.back())
                                              : std::nullopt));
  append(results, check_rotor_speed_stream(recording));
  append(results, check_mocap_stream(recording, mocap_required));
  append(results, check_mocap_at_rest(recording, imu));
  if (vehicle != nullptr) append(results, check_description(recording, *vehicle));
  return results;
}

}  // namespace swiftlet::ground
