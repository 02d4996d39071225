// Samples and setpoints to PX4's messages and back. Both sides are NED and FRD, so that no axis changes; fields that are not used are
// NaN, stamps of 0 mean "now" to PX4. Received samples are checked: a layout that has changed shows as nonsense.
#pragma once

#include <optional>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/px4/px4_topics.hpp"
#include "swiftlet/services/px4/thrust_scale.hpp"

namespace swiftlet::px4 {

// Which loops PX4 closes for a command of this level. It is PX4's proof of life.
msg::OffboardControlMode offboard_mode(const plant::VehicleCommand& command);

msg::VehicleRatesSetpoint to_px4(const plant::RatesSetpoint& setpoint, const ThrustScale& scale);
msg::VehicleAttitudeSetpoint to_px4(const plant::AttitudeSetpoint& setpoint, const ThrustScale& scale);
msg::TrajectorySetpoint to_px4(const plant::TrajectorySetpoint& setpoint);
// The thrust that the command asks for, N; nullopt at levels that name none.
std::optional<double> thrust_of(const plant::VehicleCommand& command);

struct PoseDeviation {
  double position_m = 0.002;
  double attitude_rad = 0.01;
};
// stamp_us: of the exposure on the clock of PX4's agent; 0: now. The quaternion has w >= 0.
msg::VehicleOdometry to_px4(const plant::PoseSample& pose, const PoseDeviation& deviation,
                            std::uint8_t reset_counter, std::uint64_t stamp_us);

// system: target, as PX4 reports it in its status.
msg::VehicleCommand set_offboard_mode(std::uint8_t system);
msg::VehicleCommand arm(std::uint8_t system);
msg::VehicleCommand disarm_at_once(std::uint8_t system);  // also in the air
msg::VehicleCommand land(std::uint8_t system);
// True for the answer to a command of this process.
bool is_for_us(const msg::VehicleCommandAck& ack);

// Fill all but stamp and sequence. Return a fault: the sample is not sensible.
messages::Fault from_px4(const msg::SensorCombined& message, plant::ImuSample& sample);
messages::Fault from_px4(const msg::BatteryStatus& message, plant::BatterySample& sample);
// PX4's own estimate, in its local frame. What it does not know is NaN there. Its variances of the orientation are about the body's
// axes (EKF2::PublishOdometry of PX4), those of the deviations here about north, east and down. Of its reset counter, which wraps
// at 256, odometry.resets counts the changes on from the value that it has. fuses_mocap is left to the caller.
messages::Fault from_px4(const msg::VehicleOdometry& message, plant::OdometrySample& odometry);
messages::Fault check(const msg::VehicleStatus& message);

}  // namespace swiftlet::px4
